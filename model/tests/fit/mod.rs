//! Fits the tables of the fixed-point path to the reference and writes them as source text.

use contact_model::fixed_point::{KERNEL_DEGREE, OCTAVES, ROWS_PER_OCTAVE};
use contact_model::reference;
use std::fmt::Write;

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

/// Text of `kernel_table.rs`.
pub fn kernel_table() -> String {
    let mut text = String::from(
        "//! Written by `cargo run -p contact-model --example tables`; do not edit.\n\n\
         use super::kernel::{DEGREE, OCTAVES, ROWS_PER_OCTAVE, Row};\n\n\
         const fn row(constant: u32, rest: [i32; DEGREE]) -> Row {\n    Row { constant, rest }\n}\n\n\
         #[rustfmt::skip]\n\
         pub(super) static TABLE: [Row; (OCTAVES.end - OCTAVES.start) as usize * ROWS_PER_OCTAVE] = [\n",
    );
    for octave in OCTAVES {
        for part in 0..ROWS_PER_OCTAVE {
            let e = |t: f64| {
                let u = (1.0 + (part as f64 + t) / ROWS_PER_OCTAVE as f64) * f64::from(octave).exp2();
                reference::erfcx(u.sqrt()) * 2f64.powi(32)
            };
            let powers = fit::<{ KERNEL_DEGREE + 1 }>(e);
            let rounded = powers.map(|c| c.round() as i64);
            let constant = rounded[0].clamp(0, i64::from(u32::MAX));
            writeln!(text, "    row({constant}, {:?}),", &rounded[1..]).unwrap();
        }
    }
    text.push_str("];\n");
    text
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
