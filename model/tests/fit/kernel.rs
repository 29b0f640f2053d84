//! Fits the kernel's table: divides each octave into rows, and fits a polynomial to each row.

use contact_model::fixed_point::kernel::{
    COUNT_SHIFT, GUARD_BITS, OCTAVES, PRACTICAL_OCTAVES, ROWS,
};
use contact_model::reference;
use std::f64::consts::PI;
use std::fmt::Write;
use std::ops::RangeInclusive;

/// Degree of the polynomials.
const DEGREE: usize = 7;
/// Chebyshev points on which a row is fitted.
const POINTS: usize = 24;
/// Weight of an error in the octaves that contacts reach in practice; 1 in the others.
const PRACTICAL_WEIGHT: f64 = 4.0;
/// Octaves that are fitted; the first and the last saturate.
const FITTED: RangeInclusive<i32> = OCTAVES.start + 1..=OCTAVES.end - 2;

/// One unit of 2^-32, in units of the higher terms.
const UNIT: f64 = (1u64 << GUARD_BITS) as f64;

/// Integer coefficients of a row, and the largest error of their polynomial in units of 2^-32, without that of
/// rounding in its evaluation.
#[derive(Clone, Copy)]
struct Fit {
    constant: u32,
    slope: i32,
    powers: [i32; DEGREE + 1],
    error: f64,
}

/// Chebyshev points from -1 to 1, and the Chebyshev polynomials at these points.
struct Basis {
    points: [f64; POINTS],
    polynomials: [[f64; POINTS]; DEGREE + 1],
}

impl Basis {
    fn new() -> Self {
        let angles: [f64; POINTS] =
            std::array::from_fn(|i| PI * (2 * i + 1) as f64 / (2 * POINTS) as f64);
        Self {
            points: angles.map(f64::cos),
            polynomials: std::array::from_fn(|k| angles.map(|angle| (k as f64 * angle).cos())),
        }
    }

    /// Coefficient of `t^k` (`t` from -1/2 to 1/2) in the Chebyshev series of `values`, truncated after degree `k`.
    fn leading(&self, k: usize, values: &[f64; POINTS]) -> f64 {
        let sum: f64 = values.iter().zip(&self.polynomials[k]).map(|(v, p)| v * p).sum();
        let mean = sum / POINTS as f64;
        // The leading coefficient of the k-th polynomial is 2^(k-1) in 2t.
        if k == 0 { mean } else { mean * 4f64.powi(k as i32) }
    }

    fn subtract(&self, k: usize, coefficient: f64, values: &mut [f64; POINTS]) {
        for (value, x) in values.iter_mut().zip(self.points) {
            *value -= coefficient * (x / 2.0).powi(k as i32);
        }
    }
}

/// Whether every sum of the evaluation fits in 32 bits: powers from 7 down to 2, then 6 and 7 again for the low bits of
/// slope and constant.
fn fits(powers: &[i64; DEGREE + 1]) -> bool {
    let mut sum = 0.0;
    let order = (2..=DEGREE).rev().chain([DEGREE - 1, DEGREE]);
    for power in order.map(|k| powers[k]) {
        sum = sum / 2.0 + (power as f64).abs() + 1.0;
        if sum >= f64::from(i32::MAX) {
            return false;
        }
    }
    true
}

/// Fits row `index` of `count` in an octave; `None` if a sum of its evaluation could overflow 32 bits.
///
/// From the highest power down, each coefficient is rounded, and the residual is fitted by the lower ones. The low bits
/// of the two highest are further bits of constant and slope, which are known last: the fit is repeated, and the best
/// of eight is kept.
fn fit(basis: &Basis, octave: i32, index: u32, count: u32) -> Option<Fit> {
    // The kernel's input stands for the middle of the bits cut off the product.
    let half_bit = 0.5 / 4_294_967_296.0;
    let exact = basis.points.map(|x| {
        let place = (f64::from(index) + 0.5 + x / 2.0) / f64::from(count);
        let u = (1.0 + place + half_bit) * f64::from(octave).exp2();
        reference::erfcx(u.sqrt()) * 4_294_967_296.0
    });
    let mut best: Option<Fit> = None;
    let (mut constant_guard, mut slope_guard) = (0, 0);
    for _ in 0..8 {
        let mut residual = exact;
        let mut powers = [0i64; DEGREE + 1];
        for k in (0..=DEGREE).rev() {
            let leading = basis.leading(k, &residual) * UNIT;
            let with_low_bits =
                |guard: i64| ((leading - guard as f64) / UNIT).round() as i64 * UNIT as i64 + guard;
            powers[k] = match k {
                DEGREE => with_low_bits(constant_guard),
                k if k == DEGREE - 1 => with_low_bits(slope_guard),
                _ => leading.round() as i64,
            };
            basis.subtract(k, powers[k] as f64 / UNIT, &mut residual);
        }
        // The evaluation also adds the seventh coefficient as the low word, and one half is subtracted for rounding.
        let low_word = f64::from(powers[DEGREE] as i32 as u32) / 4_294_967_296.0;
        let constant = powers[0] as f64 / UNIT + 0.5 - low_word;
        let constant_word = (constant - powers[DEGREE] as f64 / UNIT).round();
        let slope_word = ((powers[1] - powers[DEGREE - 1]) as f64 / UNIT).round();
        let rounding = [
            constant - powers[DEGREE] as f64 / UNIT - constant_word,
            (powers[1] - powers[DEGREE - 1]) as f64 / UNIT - slope_word,
        ];
        for (k, error) in rounding.into_iter().enumerate() {
            basis.subtract(k, -error, &mut residual);
        }
        let error = residual.iter().fold(0.0, |worst: f64, e| worst.max(e.abs()));
        if best.is_none_or(|best| error < best.error) {
            if !fits(&powers) {
                return None;
            }
            best = Some(Fit {
                constant: constant_word.clamp(0.0, f64::from(u32::MAX)) as u32,
                slope: slope_word as i32,
                powers: powers.map(|power| power as i32),
                error,
            });
        }
        let guard = |value: f64| (value * UNIT).round().rem_euclid(UNIT) as i64;
        (constant_guard, slope_guard) = (guard(constant), guard(powers[1] as f64 / UNIT));
    }
    best
}

/// Fits an octave that is divided into `count` equal rows.
fn fit_octave(basis: &Basis, octave: i32, count: u32) -> Option<Vec<Fit>> {
    (0..count).map(|index| fit(basis, octave, index, count)).collect()
}

/// Weighted largest error of an octave.
fn weighted_error(octave: i32, rows: &[Fit]) -> f64 {
    let weight = if PRACTICAL_OCTAVES.contains(&octave) { PRACTICAL_WEIGHT } else { 1.0 };
    rows.iter().fold(0.0, |worst: f64, row| worst.max(row.error)) * weight
}

/// Rows of every fitted octave: one each, then one more where the error is largest, until the table is full.
fn octaves(basis: &Basis) -> Vec<Vec<Fit>> {
    let smallest = |octave: i32, from: u32| {
        (from..).find_map(|count| fit_octave(basis, octave, count)).unwrap()
    };
    let mut octaves: Vec<_> = FITTED.map(|octave| smallest(octave, 1)).collect();
    loop {
        let used: usize = octaves.iter().map(Vec::len).sum();
        let (octave, rows) = FITTED
            .zip(&mut octaves)
            .max_by(|(a, x), (b, y)| weighted_error(*a, x).total_cmp(&weighted_error(*b, y)))
            .unwrap();
        let finer = smallest(octave, rows.len() as u32 + 1);
        // Two rows are for the saturating octaves.
        if used + finer.len() - rows.len() > ROWS - 2 {
            return octaves;
        }
        *rows = finer;
    }
}

/// Text of `kernel_table.rs`.
pub fn table() -> String {
    let octaves = octaves(&Basis::new());
    let saturated = |constant| Fit { constant, slope: 0, powers: [0; DEGREE + 1], error: 0.0 };
    let mut all = vec![vec![saturated(u32::MAX)]];
    all.extend(octaves);
    all.push(vec![saturated(0)]);

    let mut first = 0;
    let descriptors: Vec<_> = all
        .iter()
        .map(|rows| {
            let descriptor = (rows.len() << COUNT_SHIFT) | first;
            first += rows.len();
            descriptor
        })
        .collect();
    let mut rows: Vec<_> = all.into_iter().flatten().collect();
    rows.resize(ROWS, saturated(0));

    let mut text = String::from(
        "//! Written by `cargo run --release -p contact-model --example tables`; do not edit.\n\n\
         use super::kernel::{Row, Table};\n\n\
         const fn row(constant: u32, slope: i32, seventh: i32, sixth: i32, inner: [i32; 4]) -> Row {\n    \
             Row { constant, slope, seventh, sixth, inner }\n}\n\n\
         #[rustfmt::skip]\n\
         pub(super) static TABLE: Table = Table {\n    octaves: [",
    );
    for line in descriptors.chunks(16) {
        let words: Vec<_> = line.iter().map(|d| format!("{d:#06x}")).collect();
        write!(text, "\n        {},", words.join(", ")).unwrap();
    }
    text.push_str("\n    ],\n    rows: [\n");
    for Fit { constant, slope, powers: [_, _, inner @ .., sixth, seventh], .. } in rows {
        writeln!(text, "        row({constant}, {slope}, {seventh}, {sixth}, {inner:?}),").unwrap();
    }
    text.push_str("    ],\n};\n");
    text
}
