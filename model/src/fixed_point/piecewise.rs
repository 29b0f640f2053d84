//! Piecewise polynomials with integer coefficients.

/// Evaluates one piece: `c[0] + c[1] t + ... + c[N-1] t^(N-1)` for `t / 2^32` in `[0, 1)`, coefficients and
/// result in the same unit. The constant term is returned apart, because it may need the sign bit.
///
/// Each product is rounded down, so the result is at most `N - 1` units low.
#[inline]
pub(super) fn variable_part<const N: usize>(coefficients: &[i32; N], t: u32) -> i32 {
    let mut sum = 0i32;
    for &c in coefficients.iter().rev() {
        sum = sum.wrapping_add(c);
        sum = ((i64::from(sum) * i64::from(t)) >> 32) as i32;
    }
    sum
}
