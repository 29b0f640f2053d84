//! Fits the tables of the fixed-point path to the reference, and formats them as source text.

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

/// Rows of a table of `f` on 32 intervals of `[0, 1)`: constants in units of 2^-32, higher coefficients in units of
/// 2^-35.
fn table_rows(f: impl Fn(f64) -> f64) -> String {
    let mut text = String::new();
    for row in 0..32 {
        let powers = fit::<5>(|t| f((f64::from(row) + t) / 32.0));
        let constant = (powers[0] * 2f64.powi(32)).round().max(0.0) as u64;
        let slopes: Vec<i64> =
            powers[1..].iter().map(|c| (c * 2f64.powi(35)).round() as i64).collect();
        writeln!(text, "    row({constant}, {slopes:?}),").unwrap();
    }
    text + "];\n"
}

/// Text of `log_table.rs`.
pub fn log_table() -> String {
    format!(
        "//! Written by `cargo run --release -p contact-model --example tables`; do not edit.\n\n\
         use super::logarithm::LogRow;\n\n\
         const fn row(constant: u32, slopes: [i32; 4]) -> LogRow {{\n    LogRow {{ constant, slopes }}\n}}\n\n\
         /// `log2(1 + f)` on 32 equal intervals of `f` in `[0, 1)`.\n\
         #[rustfmt::skip]\npub(super) static LOG2: [LogRow; 32] = [\n{}\n\
         /// `2^f - 1` on 32 equal intervals of `f` in `[0, 1)`.\n\
         #[rustfmt::skip]\npub(super) static EXP2: [LogRow; 32] = [\n{}",
        table_rows(|f| libm::log1p(f) / std::f64::consts::LN_2),
        table_rows(|f| libm::expm1(f * std::f64::consts::LN_2)),
    )
}
