//! Derives the coefficients and tables of the peers.

#[path = "src/host/precise.rs"]
mod precise;

use precise::{erfcx_of_root, exact_product};
use std::f64::consts::PI;
use std::fmt::{Debug, Write};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/host/precise.rs");
    let out = std::env::var("OUT_DIR")?;
    std::fs::write(format!("{out}/coefficients.rs"), coefficients()?)?;
    Ok(())
}

/// The source text of all constants.
fn coefficients() -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    shepherd_laframboise(&mut text)?;
    faddeeva(&mut text)?;
    one_polynomial(&mut text)?;
    for nodes in [1024, 4096, 16384] {
        uniform(&mut text, nodes)?;
    }
    Ok(text)
}

/// `(1 + 2 z) erfcx(z)` in powers of `s = (z - 3.75) / (z + 3.75)`, twelve coefficients in `f32`.
fn shepherd_laframboise(text: &mut String) -> std::fmt::Result {
    let powers = fit(12, |s| {
        let z = 3.75 * (1.0 + s) / (1.0 - s);
        (1.0 + 2.0 * z) * erfcx(z)
    });
    let powers: Vec<f32> = powers.iter().map(|c| *c as f32).collect();
    constant(text, "SHEPHERD_LAFRAMBOISE", "[f32; 12]", &powers)
}

/// `erfcx` on a hundred equal parts of `y = 4 / (4 + z)`, seven coefficients each in powers of the place in the
/// part, -1 to 1.
fn faddeeva(text: &mut String) -> std::fmt::Result {
    let parts: Vec<_> = (0..100)
        .map(|part| {
            fit(7, |s| {
                let y = (f64::from(part) + 0.5 + 0.5 * s) / 100.0;
                erfcx(4.0 / y - 4.0)
            })
        })
        .collect();
    constant(text, "FADDEEVA", "[[f64; 7]; 100]", &parts)
}

/// `erfcx` in powers of `s = 2 y - 1` with `y = 1 / (1 + z / 2)`, in units of 2^-30; that of the power `k` times
/// `2^k`.
fn one_polynomial(text: &mut String) -> std::fmt::Result {
    let powers = fit(15, |s| {
        let y = 0.5 + 0.5 * s;
        2f64.powi(30) * erfcx(2.0 / y - 2.0)
    });
    let doubled = powers.iter().zip(0..).map(|(c, k)| (c * 2f64.powi(k)).round() as i32);
    let powers: Vec<i32> = doubled.collect();
    constant(text, "ONE_POLYNOMIAL", "[i32; 15]", &powers)
}

/// `erfcx` at `nodes` equal steps of `z` from 0 to just below 16.
fn uniform(text: &mut String, nodes: u32) -> std::fmt::Result {
    let values: Vec<f32> =
        (0..nodes).map(|i| erfcx(16.0 * f64::from(i) / f64::from(nodes)) as f32).collect();
    constant(text, &format!("UNIFORM_{nodes}"), &format!("[f32; {nodes}]"), &values)
}

fn constant(text: &mut String, name: &str, kind: &str, value: &impl Debug) -> std::fmt::Result {
    writeln!(text, "pub(super) static {name}: {kind} = {value:?};")
}

/// `erfcx(z)` for `z >= 0`, rounded.
fn erfcx(z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { erfcx_of_root(exact_product(z, z)).high }
}

/// Coefficients, lowest power first, of the polynomial of `count` terms that meets `f` at the Chebyshev points of
/// -1 to 1; within a few per cent of the best one for functions as smooth as these.
fn fit(count: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let angles: Vec<f64> = (0..count).map(|i| PI * (i as f64 + 0.5) / count as f64).collect();
    let values: Vec<f64> = angles.iter().map(|angle| f(angle.cos())).collect();
    let mut powers = vec![0.0; count];
    // T_k in powers, from T_(k-1) and the one before it.
    let (mut before, mut this) = (vec![0.0; count], vec![0.0; count]);
    this[0] = 1.0;
    for k in 0..count {
        let samples = angles.iter().zip(&values);
        let sum: f64 = samples.map(|(angle, value)| value * (k as f64 * angle).cos()).sum();
        let weight = if k == 0 { 1.0 } else { 2.0 } * sum / count as f64;
        for (power, t) in powers.iter_mut().zip(&this) {
            *power += weight * t;
        }
        let factor = if k == 0 { 1.0 } else { 2.0 };
        let next = (0..count)
            .map(|i| factor * (if i == 0 { 0.0 } else { this[i - 1] }) - before[i])
            .collect();
        before = std::mem::replace(&mut this, next);
    }
    powers
}
