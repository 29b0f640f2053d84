//! Piecewise polynomials with integer coefficients, for the tables of logarithm, power and error function.

/// `c[0] t + c[1] t² + ... + c[N-1] t^N`, with `t` in units of 2^-32 from 0 to 1; coefficients and result have
/// the same unit.
///
/// Each product is rounded down, so the result is at most `N` units low.
#[inline]
pub(super) fn variable_part<const N: usize>(coefficients: &[i32; N], t: u32) -> i32 {
    let mut sum = 0i32;
    for &c in coefficients.iter().rev() {
        sum = sum.wrapping_add(c);
        sum = ((i64::from(sum) * i64::from(t)) >> 32) as i32;
    }
    sum
}

/// Polynomial of degree `N` for one interval of a function with values in `[0, 1)`: the constant in units of
/// 2^-32, the other coefficients in units of `2^-SLOPE_BITS`, so that their rounding errors matter less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Row<const N: usize, const SLOPE_BITS: u32> {
    pub(super) constant: u32,
    pub(super) rest: [i32; N],
}

impl<const N: usize, const SLOPE_BITS: u32> Row<N, SLOPE_BITS> {
    /// Value at `t`, in units of 2^-32 of the interval; result in units of 2^-32; saturates.
    #[inline]
    pub(super) fn at(&self, t: u32) -> u32 {
        let spare = SLOPE_BITS - 32;
        // Half a unit rounds the result; `N / 2` centres the error of at most `N` units from rounding down.
        let rounding = (1 << spare >> 1) + N as i32 / 2;
        let rest = variable_part(&self.rest, t).wrapping_add(rounding) >> spare;
        self.constant.saturating_add_signed(rest)
    }
}
