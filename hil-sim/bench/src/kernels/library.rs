//! The product `exp(u) erfc(z)` from libraries, and the polynomial that remains if the `exp` cancels.
use micromath::F32Ext;

use super::root::sqrt;

/// libm in double precision.
pub(crate) fn libm_f64(elapsed: u32, per_tick: f64) -> f64 {
    let u = f64::from(elapsed) * per_tick;
    libm::exp(u) * libm::erfc(libm::sqrt(u))
}

/// libm in single precision.
pub(crate) fn libm_f32(elapsed: u32, per_tick: f32) -> f32 {
    let u = elapsed as f32 * per_tick;
    libm::expf(u) * libm::erfcf(sqrt(u))
}

/// micromath's `exp`; the error of its square root would hide everything else.
pub(super) fn micromath_erfc(elapsed: u32, per_tick: f32) -> f32 {
    let u = elapsed as f32 * per_tick;
    F32Ext::exp(u) * libm::erfcf(sqrt(u))
}

/// micromath's `exp`, twice, around Abramowitz and Stegun's polynomial.
pub(super) fn micromath_as(elapsed: u32, per_tick: f32) -> f32 {
    let u = elapsed as f32 * per_tick;
    F32Ext::exp(u) * (polynomial(sqrt(u)) * F32Ext::exp(-u))
}

/// Abramowitz and Stegun's polynomial by itself: the `exp` that they multiply by is cancelled by erfcx's own.
pub(super) fn abramowitz_stegun(elapsed: u32, per_tick: f32) -> f32 {
    polynomial(sqrt(elapsed as f32 * per_tick))
}

/// Abramowitz and Stegun's coefficients, lowest power first.
const A: [f32; 5] = [
    0.254_829_592_f64 as f32,
    -0.284_496_736_f64 as f32,
    1.421_413_741_f64 as f32,
    -1.453_152_027_f64 as f32,
    1.061_405_429_f64 as f32,
];

/// `erfc(z) exp(z²)` after M. Abramowitz and I. A. Stegun, *Handbook of Mathematical Functions*, 7.1.26: its error
/// of 1.5e-7 is that of `erfc`, so here it grows as `exp(z²)`.
#[inline]
fn polynomial(z: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.327_591_1 * z);
    t * (A[0] + t * (A[1] + t * (A[2] + t * (A[3] + t * A[4]))))
}
