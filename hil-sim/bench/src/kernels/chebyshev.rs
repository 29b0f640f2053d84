//! Floating-point fits after a change of variable that makes the half-line finite.
use super::coefficients::{FADDEEVA, SHEPHERD_LAFRAMBOISE};
use super::root::sqrt;

/// After M. M. Shepherd and J. G. Laframboise, *Chebyshev approximation of (1 + 2x) exp(x²) erfc x in 0 <= x < inf*,
/// Mathematics of Computation 36 (1981): a polynomial in `(z - k) / (z + k)`, here with 12 terms in `f32`.
pub(crate) fn shepherd_laframboise(elapsed: u32, per_tick: f32) -> f32 {
    let z = sqrt(elapsed as f32 * per_tick);
    let s = (z - 3.75) / (z + 3.75);
    SHEPHERD_LAFRAMBOISE.iter().rev().fold(0.0, |sum, c| sum * s + c) / (1.0 + 2.0 * z)
}

/// The structure of S. G. Johnson's Faddeeva package in `f64`: a hundred parts of `4 / (4 + z)` with a polynomial of
/// degree 6 each.
pub(super) fn faddeeva(elapsed: u32, per_tick: f64) -> f64 {
    let z = libm::sqrt(f64::from(elapsed) * per_tick);
    let y = 400.0 / (4.0 + z);
    let part = (y as usize).min(FADDEEVA.len() - 1);
    let s = 2.0 * (y - part as f64) - 1.0;
    let [c0, c1, c2, c3, c4, c5, c6] = FADDEEVA[part];
    c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * (c5 + s * c6)))))
}
