//! The fewest bytes: one polynomial for all `z`.
use contact_model::fixed_point::{Fraction, Rate, Ticks};

use super::coefficients::ONE_POLYNOMIAL;

/// Degree 14 in `y = 1 / (1 + z / 2)`, in integers: an integer square root, a division, a Horner chain of 32-bit
/// high multiplications.
pub(super) fn one_polynomial(elapsed: Ticks, per_tick: Rate) -> Fraction {
    let product = u64::from(elapsed.get()) * (1 << 32 | u64::from(per_tick.fraction()));
    let zeros = product.leading_zeros();
    // u = leading 2^exponent with an even exponent and leading in 2^62..2^64, so z = root 2^half with root in
    // 2^31..2^32.
    let exponent = i32::from(per_tick.exponent()) - 32 - zeros as i32;
    let leading = product << zeros >> (exponent & 1);
    let half = (exponent + (exponent & 1)) / 2;
    let root = leading.isqrt();
    // In units of 2^-31: 1 + z/2 needs at most 64 bits as long as z is below 2^32.
    let shift = half + 30;
    let denominator = (1u64 << 31)
        + match shift {
            0..32 => root << shift,
            -63..0 => root >> -shift,
            ..-63 => 0,
            _ => return Fraction::ZERO,
        };
    // y in units of 2^-32, then s = 2 y - 1 in units of 2^-31.
    let y = ((1u64 << 63) / denominator).min(u64::from(u32::MAX)) as u32;
    let s = i64::from((y ^ 1 << 31) as i32);
    let sum = ONE_POLYNOMIAL
        .iter()
        .rev()
        .fold(0i64, |sum, c| i64::from(*c) + ((sum * s) >> 31));
    Fraction::from_bits((2 * sum).clamp(0, i64::from(u32::MAX)) as u32)
}
