//! The fewest bytes: one polynomial for all `z`.
use contact_model::fixed_point::{Fraction, MantissaExponent, Ticks};

use super::coefficients::ONE_POLYNOMIAL;
use super::root::sqrt;

/// Degree 14 in `y = 1 / (1 + z / 2)`: a Horner chain of 32-bit high multiplications on a root and a reciprocal of
/// 32 bits, both found by the FPU to 24 bits and then improved by a step of Newton's in integers.
pub(super) fn one_polynomial(elapsed: Ticks, per_tick: MantissaExponent) -> Fraction {
    let product = u64::from(elapsed.get()) * (1 << 32 | u64::from(per_tick.fraction()));
    let zeros = product.leading_zeros();
    // u = square 2^exponent with an even exponent and square in 2^62..2^64, so z = root 2^(exponent / 2) with root
    // in 2^31..2^32.
    let exponent = per_tick.exponent() - 32 - zeros as i32;
    let odd = exponent & 1;
    let root = root(product << zeros >> odd);
    // 1 + z/2 = denominator 2^(scale - 31) with denominator in 2^31..2^32.
    let shift = (exponent + odd) / 2 + 30;
    let (denominator, scale) = match shift {
        ..=-32 => (1 << 31, 0),
        -31..0 => ((1 << 31) + (root >> -shift), 0),
        0..32 => {
            let sum = (1u64 << 31) + (u64::from(root) << shift);
            let scale = 32 - sum.leading_zeros();
            ((sum >> scale) as u32, scale)
        }
        _ => return Fraction::ZERO,
    };
    // y in units of 2^-32, then s = 2 y - 1 in units of 2^-31.
    let y = reciprocal(denominator) >> scale;
    let s = i64::from((y ^ 1 << 31) as i32);
    // The high word of a product with s is that with s / 2; the coefficients are doubled as often to match.
    let [first, rest @ ..] = &ONE_POLYNOMIAL;
    let sum = rest
        .iter()
        .rev()
        .fold(0i32, |sum, c| c.wrapping_add(((i64::from(sum) * s + (1 << 31)) >> 32) as i32));
    // From units of 2^-30 to those of 2^-32 in the last product.
    let value = 4 * i64::from(*first) + ((i64::from(sum) * s) >> 30);
    Fraction::from_bits(value.clamp(0, i64::from(u32::MAX)) as u32)
}

/// Square root of a number of 63 or 64 bits, in units of the last bit but one or two.
fn root(square: u64) -> u32 {
    let estimate = (sqrt((square >> 32) as u32 as f32) * 65536.0) as u32;
    let rest = square.wrapping_sub(u64::from(estimate) * u64::from(estimate)) as i64;
    // The rest is below 2^42.
    let step = (rest >> 16) as i32 as f32 / estimate as f32 * 32768.0;
    estimate.saturating_add_signed(step as i32)
}

/// `2^63 / x` for `x` in `2^31..2^32`, saturating.
fn reciprocal(x: u32) -> u32 {
    let estimate = (9.223_372e18 / x as f32) as u32;
    // How far the estimate's product with x is from 2^63, in units of 2^32: below 2^8 of 2^31.
    let rest = (1u64 << 63).wrapping_sub(u64::from(x) * u64::from(estimate)) as i64;
    let step = (rest >> 16) as i32 as f32 / x as f32 * 65536.0;
    estimate.saturating_add_signed(step as i32)
}
