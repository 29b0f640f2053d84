//! Fits the tables of the fixed-point path to the reference and writes them as source text.

use std::fmt::Write;

pub mod kernel;

/// Coefficients, lowest power first, of the polynomial of degree `N - 1` through `f` at the Chebyshev points
/// of `[0, 1]`.
fn fit<const N: usize>(f: impl Fn(f64) -> f64) -> [f64; N] {
    let nodes: [f64; N] = std::array::from_fn(|i| {
        let angle = std::f64::consts::PI * (2 * i + 1) as f64 / (2 * N) as f64;
        0.5 - 0.5 * angle.cos()
    });
    // Newton's divided differences, then Horner on polynomials.
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

/// Text of `log_table.rs`.
pub fn log_table() -> String {
    let mut text = String::from(
        "//! Written by `cargo run -p contact-model --example tables`; do not edit.\n\n\
         /// `2^31 log2(1 + f)`: cubics on 32 equal parts of `f` in `[0, 1)`.\n\
         #[rustfmt::skip]\npub(super) static LOG2: [[i32; 4]; 32] = [\n",
    );
    for part in 0..32 {
        let powers = fit::<4>(|t| (1.0 + (f64::from(part) + t) / 32.0).log2() * 2f64.powi(31));
        writeln!(text, "    {:?},", powers.map(|c| c.round() as i64)).unwrap();
    }
    text.push_str(
        "];\n\n/// `2^30 (2^f - 1)`: cubics on 16 equal parts of `f` in `[0, 1)`.\n\
         #[rustfmt::skip]\npub(super) static EXP2: [[i32; 4]; 16] = [\n",
    );
    for part in 0..16 {
        let powers = fit::<4>(|t| (((f64::from(part) + t) / 16.0).exp2() - 1.0) * 2f64.powi(30));
        writeln!(text, "    {:?},", powers.map(|c| c.round() as i64)).unwrap();
    }
    text.push_str("];\n");
    text
}
