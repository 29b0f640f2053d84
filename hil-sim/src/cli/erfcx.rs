//! `hil-sim erfcx`: the firmware's kernel, one value a line.

use std::io::{self, BufWriter, Write};

use anyhow::{Context, anyhow};
use contact_model::fixed_point::{Fraction, MantissaExponent, Ticks, erfcx};
use thermal_client::text;

use super::Failure;

/// Reads z, a decimal or C hexadecimal float, and prints `z,E_bits`.
pub fn run() -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    writeln!(out, "z,E_bits").map_err(Failure::run)?;
    for (index, line) in text::lines(io::stdin().lock()).enumerate() {
        let line = line.context("standard input").map_err(Failure::run)?;
        let word = line.trim();
        if word.is_empty() {
            continue;
        }
        let z = parse(word)
            .filter(|z| *z >= 0.0 && z.is_finite())
            .ok_or_else(|| {
                Failure::input(anyhow!(
                    "standard input:{}: z = {word:?}; allowed is a finite number from 0 on, decimal or C hex",
                    index + 1
                ))
            })?;
        writeln!(out, "{word},{}", bits(z)).map_err(Failure::run)?;
    }
    out.flush().map_err(Failure::run)
}

/// `E` at z, in units of 2^-32: one tick of `u = z²`, cut to 33 bits as the kernel cuts every product.
fn bits(z: f64) -> u32 {
    let u = z * z;
    if u.is_normal() {
        let (exponent, fraction) = ((u.to_bits() >> 52) as i16 - 1023, (u.to_bits() >> 20) as u32);
        erfcx(Ticks::ONE, MantissaExponent::new(exponent, fraction)).to_bits()
    } else if z < 1.0 {
        Fraction::MAX.to_bits()
    } else {
        0
    }
}

fn parse(word: &str) -> Option<f64> {
    let unsigned = word.trim_start_matches(['+', '-']);
    if unsigned.starts_with("0x") || unsigned.starts_with("0X") {
        hexf_parse::parse_hexf64(&word.to_ascii_lowercase(), false).ok()
    } else {
        word.parse().ok()
    }
}
