//! Fits the tables of the fixed-point path to the reference, and formats them as source text.

use contact_model::reference::Real;
use std::fmt::Write;

pub mod kernel;

/// Coefficients, lowest power first, of the polynomial of degree `N - 1` through `f` at the Chebyshev points
/// of `[0, 1]`.
fn fit<const N: usize>(f: impl Fn(f64) -> f64) -> [f64; N] {
    let nodes: [f64; N] = std::array::from_fn(|i| {
        let angle = std::f64::consts::PI * (2 * i + 1) as f64 / (2 * N) as f64;
        0.5 - 0.5 * angle.cos()
    });
    // Newton's divided differences, then expanded into powers by Horner's scheme.
    let mut differences = nodes.map(f);
    for level in 1..N {
        for i in (level..N).rev() {
            differences[i] = (differences[i] - differences[i - 1]) / (nodes[i] - nodes[i - level]);
        }
    }
    let mut powers = [0.0; N];
    for i in (0..N).rev() {
        for k in (1..N).rev() {
            powers[k] = powers[k - 1] - nodes[i] * powers[k];
        }
        powers[0] = differences[i] - nodes[i] * powers[0];
    }
    powers
}

/// Rows of a table of `f`, each over an interval of `1 / per_unit`: constants in units of 2^-32, the `N - 1` higher
/// coefficients in units of `2^-slope_bits`.
fn table_rows<const N: usize>(
    rows: u32,
    per_unit: u32,
    slope_bits: i32,
    f: impl Fn(f64) -> f64,
) -> String {
    let mut text = String::new();
    for row in 0..rows {
        let powers = fit::<N>(|t| f((f64::from(row) + t) / f64::from(per_unit)));
        let constant = (powers[0] * 2f64.powi(32)).round().max(0.0) as u64;
        let rest: Vec<i64> = powers[1..]
            .iter()
            .map(|c| (c * 2f64.powi(slope_bits)).round() as i64)
            .collect();
        writeln!(text, "    row({constant}, {rest:?}),").unwrap();
    }
    text + "];\n"
}

/// Text of `log_table.rs`.
pub fn log_table() -> String {
    format!(
        "//! Written by `cargo run --release -p contact-model --example tables`; do not edit.\n\n\
         use super::logarithm::LogRow;\n\n\
         const fn row(constant: u32, rest: [i32; 4]) -> LogRow {{\n    LogRow {{ constant, rest }}\n}}\n\n\
         /// `log2(1 + f)` on 32 equal intervals of `f` in `[0, 1)`.\n\
         #[rustfmt::skip]\npub(super) static LOG2: [LogRow; 32] = [\n{}\n\
         /// `2^f - 1` on 32 equal intervals of `f` in `[0, 1)`.\n\
         #[rustfmt::skip]\npub(super) static EXP2: [LogRow; 32] = [\n{}",
        table_rows::<5>(32, 32, 35, |f| libm::log1p(f) / std::f64::consts::LN_2),
        table_rows::<5>(32, 32, 35, |f| libm::expm1(f * std::f64::consts::LN_2)),
    )
}

/// Text of `erf_table.rs`.
pub fn erf_table() -> String {
    format!(
        "//! Written by `cargo run --release -p contact-model --example tables`; do not edit.\n\n\
         use super::erf::ErfRow;\n\n\
         const fn row(constant: u32, rest: [i32; 5]) -> ErfRow {{\n    ErfRow {{ constant, rest }}\n}}\n\n\
         /// `erf(x)` on 36 equal intervals of `x` in `[0, 4.5)`.\n\
         #[rustfmt::skip]\npub(super) static ERF: [ErfRow; 36] = [\n{}",
        table_rows::<6>(36, 8, 33, Real::erf),
    )
}
