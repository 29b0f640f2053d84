//! Proof of a bound of the kernel's error over whole octaves, without evaluating every input.
//!
//! On a row the kernel is `floor(P(t) + 1/2 + r)`, with a polynomial `P` of known coefficients and the rounding error
//! `r` of its evaluation. `r` is below one unit of 2^-40, because each step of Horner's scheme halves the error so far
//! and adds at most half a unit. The error is therefore at most one half, plus that unit, plus the largest `|P - E|`.
//! `|P - E|` is computed on a grid. Between grid points a step `h` apart a function differs from its chord by at most
//! `h²/8` times its largest second derivative. For `P` this follows from the coefficients, for `E` from
//! `u² d²E/du² <= min(sqrt(u) / (2 sqrt(pi)), 3 / (4 sqrt(pi u)))`, the first terms of enclosing alternating series.

use contact_model::reference;

use super::{REFERENCE_ERROR, UNIT};

/// The committed table, read as data.
mod kernel {
    pub struct Table {
        pub octaves: [u16; 128],
        pub rows: [Row; 256],
    }

    #[derive(Clone, Copy)]
    pub struct Row {
        pub constant: u32,
        pub slope: i32,
        pub seventh: i32,
        pub sixth: i32,
        pub inner: [i32; 4],
    }
}
#[path = "../../src/fixed_point/kernel_table.rs"]
mod kernel_table;

const GUARD: f64 = 256.0;
/// Contribution to the bound that is allowed from the curvature between grid points.
const CURVATURE: f64 = 1e-3;

/// Upper bound of the kernel's error for every input of `octave`, in units of 2^-32. Infinite if a sum could overflow
/// 32 bits.
pub fn bound(octave: i32) -> f64 {
    let descriptor = kernel_table::TABLE.octaves[(octave + 64) as usize];
    let (count, first) = (descriptor >> 12, descriptor & 0xfff);
    (0..count)
        .map(|index| {
            row_bound(octave, index, count, &kernel_table::TABLE.rows[usize::from(first + index)])
        })
        .fold(0.0, worse)
}

/// The larger of two errors; infinite if one is NaN.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

fn row_bound(octave: i32, index: u16, count: u16, row: &kernel::Row) -> f64 {
    let powers = powers(row);
    // Second derivatives with respect to t, over whose unit u increases by 2^octave / count.
    let count = f64::from(count);
    let curvature = |powers: [f64; 8]| {
        let terms = powers.iter().enumerate().skip(2);
        terms.map(|(k, c)| (k * (k - 1)) as f64 * c.abs() * 0.5f64.powi(k as i32 - 2)).sum::<f64>()
    };
    let u = f64::from(octave).exp2();
    let pi_root = std::f64::consts::PI.sqrt();
    let rising = (2.0 * u).sqrt() / (2.0 * pi_root);
    let falling = 0.75 / (pi_root * u.sqrt());
    let exact_curvature = rising.min(falling) / UNIT / (count * count);
    let steps =
        ((curvature(powers) + exact_curvature) / (8.0 * CURVATURE)).sqrt().ceil().max(1.0) as u32;

    let at_grid = (0..=steps).map(|i| {
        let t = f64::from(i) / f64::from(steps) - 0.5;
        let polynomial = powers.iter().rev().fold(0.0, |sum, c| sum * t + c);
        let place = (f64::from(index) + 0.5 + t) / count + 0.5 * UNIT;
        (polynomial - exact((1.0 + place) * u)).abs()
    });
    let deviation = 1.0 / GUARD + CURVATURE + REFERENCE_ERROR + at_grid.fold(0.0, worse);
    // `E` decreases. With its deviation and the half for rounding it stays within the 32 bits of the result.
    let place = |index: u16| exact((1.0 + f64::from(index) / count) * u);
    let within =
        place(index) + deviation + 0.5 < 1.0 / UNIT && place(index + 1) - deviation + 0.5 >= 0.0;
    if !within || !fits(row) {
        return f64::INFINITY;
    }
    0.5 + deviation
}

/// Whether every sum of the evaluation fits in 32 bits for any `t`.
fn fits(row: &kernel::Row) -> bool {
    let [second, third, fourth, fifth] = row.inner;
    let order = [row.seventh, row.sixth, fifth, fourth, third, second, row.sixth, row.seventh];
    let mut sum = 0.0;
    order.into_iter().all(|next| {
        sum = sum / 2.0 + f64::from(next).abs() + 1.0;
        sum < 2f64.powi(31)
    })
}

/// `P` of a row, in units of 2^-32.
fn powers(row: &kernel::Row) -> [f64; 8] {
    let [second, third, fourth, fifth] = row.inner.map(|c| f64::from(c) / GUARD);
    let (sixth, seventh) = (f64::from(row.sixth) / GUARD, f64::from(row.seventh) / GUARD);
    // The low word starts at the bits of the seventh coefficient; one half was subtracted for rounding.
    let low_word = f64::from(row.seventh as u32) * UNIT;
    let constant = f64::from(row.constant) + low_word + seventh - 0.5;
    let slope = f64::from(row.slope) + sixth;
    [constant, slope, second, third, fourth, fifth, sixth, seventh]
}

/// `E` in units of 2^-32. For small `z = sqrt(u)` it is the power series with terms `(-z)^k / gamma(k/2 + 1)`, for large
/// `z` the asymptotic series. Both alternate with decreasing terms, so the error is below the first omitted term,
/// here 1e-8 units.
fn exact(u: f64) -> f64 {
    let z = u.sqrt();
    let pi_root = std::f64::consts::PI.sqrt();
    let e = if z < 1e-3 {
        let half = 2.0 / pi_root;
        1.0 - z * (half - z * (1.0 - z * (half * 2.0 / 3.0 - z * (0.5 - z * half * 4.0 / 15.0))))
    } else if z > 1e3 {
        let s = 0.5 / u;
        (1.0 - s * (1.0 - 3.0 * s * (1.0 - 5.0 * s))) / (pi_root * z)
    } else {
        reference::erfcx(z)
    };
    e / UNIT
}
