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

/// One piece of a function in `[0, 1)`: the constant in units of 2^-32, the rest, of `N` powers, in units of
/// `2^-SLOPE_BITS`, which spares the rounding of the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Row<const N: usize, const SLOPE_BITS: u32> {
    pub(super) constant: u32,
    pub(super) rest: [i32; N],
}

impl<const N: usize, const SLOPE_BITS: u32> Row<N, SLOPE_BITS> {
    /// The piece at `t / 2^32` of its length, in units of 2^-32; saturates.
    #[inline]
    pub(super) fn at(&self, t: u32) -> u32 {
        let spare = SLOPE_BITS - 32;
        // Half a unit of the result rounds it; half of the `N` units lost at most centres their error.
        let rounding = (1 << spare >> 1) + N as i32 / 2;
        let rest = variable_part(&self.rest, t).wrapping_add(rounding) >> spare;
        self.constant.saturating_add_signed(rest)
    }
}
