//! Scaled complementary error function.

use super::Real;

/// Smallest `z` for the continued fraction. Below it `exp(z²)` does not overflow, even in `f32`.
const CONTINUED_FRACTION_FROM: f64 = 6.0;
/// Levels of the continued fraction; enough for `f64` from [`CONTINUED_FRACTION_FROM`] on.
const LEVELS: u32 = 40;

/// `erfcx(z) = exp(z²) erfc(z)` for `z >= 0`; relative error below 2e-15 (`f64`) and 5e-7 (`f32`) for
/// every finite `z`, 0 at infinity.
///
/// Rounding `z²` would cause an error of `z²` ulp. A fused multiply-add gives the exact remainder, which is applied
/// as a factor. Large `z` use Laplace's continued fraction
/// `sqrt(pi) erfcx(z) = 1/(z + (1/2)/(z + 1/(z + (3/2)/(z + ...))))`, evaluated from the innermost level outwards.
pub fn erfcx<F: Real>(z: F) -> F {
    if z < F::from_f64(CONTINUED_FRACTION_FROM) {
        let square = z * z;
        let remainder = z.mul_add(z, -square);
        let head = square.exp() * z.erfc();
        return head + head * remainder;
    }
    let half = F::from_f64(0.5);
    let mut tail = z;
    for level in (1..=LEVELS).rev() {
        tail = z + half * F::from_f64(f64::from(level)) / tail;
    }
    F::from_f64(1.0 / 1.772_453_850_905_516) / tail
}
