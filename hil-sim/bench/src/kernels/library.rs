//! The product `exp(u) erfc(z)` from libraries, and what is left of it without the `exp`.
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

/// micromath's `exp`; its square root, good to 5 %, would hide everything else.
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

/// `erfc(z) exp(z²)` after M. Abramowitz and I. A. Stegun, *Handbook of Mathematical Functions*, 7.1.26: its error
/// of 1.5e-7 is that of `erfc`, so here it grows as `exp(z²)`.
#[inline]
fn polynomial(z: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.327_591_1 * z);
    t * (0.254_829_592
        + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))))
}
