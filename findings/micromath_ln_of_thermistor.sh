#!/bin/sh
# Guess: micromath's logarithm is as good below 1 as above, so that a thermistor's temperature may be computed from ln(R/R25).
#
# Seen, with micromath 2.1.0 and rustc 1.95.0: above 1 the logarithm is right to 1e-4, below 1 it is that of an approximate reciprocal,
# off by up to 0.12, and its documentation gives neither figure. With B = 3950 K a thermistor that is at 49.1 C, whose resistance is
# 0.37 of that at 25 C, reads 3.1 K too high; below 25 C it reads right to 1 mK. `ln(R) - ln(R25)`, with both in ohms, is right to 2 mK
# on both sides.
#
# Fails if one of the three errors changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cat > "$folder/Cargo.toml" <<'TOML'
[package]
name = "thermistor"
version = "0.0.0"
edition = "2024"

[dependencies]
micromath = "=2.1.0"
TOML
cat > "$folder/src/main.rs" <<'RUST'
use micromath::F32Ext;

const B_K: f64 = 3950.0;
const R25_OHM: f64 = 10e3;
const T25_K: f64 = 298.15;

/// Error of largest magnitude, K, and its temperature, °C, of a thermistor whose ln(R/R25) is computed by `logarithm` from R in ohms.
fn worst(tenths: std::ops::Range<i32>, logarithm: impl Fn(f64) -> f64) -> (f64, f64) {
    tenths
        .map(|tenth| {
            let celsius = f64::from(tenth) / 10.0;
            let ohms = R25_OHM * f64::exp(B_K * (1.0 / (celsius + 273.15) - 1.0 / T25_K));
            (1.0 / (1.0 / T25_K + logarithm(ohms) / B_K) - 273.15 - celsius, celsius)
        })
        .max_by(|(left, _), (right, _)| left.abs().total_cmp(&right.abs()))
        .expect("the range is not empty")
}

fn main() {
    let of_ratio = |ohms: f64| f64::from(F32Ext::ln((ohms / R25_OHM) as f32));
    let of_both = |ohms: f64| f64::from(F32Ext::ln(ohms as f32) - F32Ext::ln(R25_OHM as f32));
    let cold = worst(-100..250, of_ratio);
    let warm = worst(250..600, of_ratio);
    let difference = worst(-100..600, of_both);
    println!("ln(R/R25), -10 to 25 C: {:+.4} K at {} C", cold.0, cold.1);
    println!("ln(R/R25), 25 to 60 C: {:+.4} K at {} C", warm.0, warm.1);
    println!("ln(R) - ln(R25), -10 to 60 C: {:+.4} K at {} C", difference.0, difference.1);
    let as_stated = cold.0.abs() < 0.0015 && (3.1..3.2).contains(&warm.0) && warm.1 == 49.1 && difference.0.abs() < 0.003;
    std::process::exit(i32::from(!as_stated));
}
RUST
cd "$folder"
cargo run --quiet
