//! Binary logarithm and power of 2, for pressures and times.

use super::log_table::{EXP2, LOG2};

/// A logarithm to base 2 with 32 fraction bits.
pub type Log2 = fixed::types::I32F32;

/// log2 of the number of rows in each table.
const ROW_BITS: u32 = 5;
/// Binary places of the coefficients beyond those of the constant, so that their rounding errors matter less.
const SPARE_BITS: u32 = 3;

/// Polynomial for one interval of a function with values in `[0, 1)`: the constant in units of 2^-32, the coefficients
/// of `t` to `t⁴` in units of 2^-35.
pub(super) struct LogRow {
    pub(super) constant: u32,
    pub(super) slopes: [i32; 4],
}

impl LogRow {
    /// Value at `t`, in units of 2^-32 of the interval; result in units of 2^-32; saturates.
    #[inline]
    fn at(&self, t: u32) -> u32 {
        let mut sum = 0i32;
        for &c in self.slopes.iter().rev() {
            sum = sum.wrapping_add(c);
            sum = ((i64::from(sum) * i64::from(t)) >> 32) as i32;
        }
        // Half a unit rounds the result; 2 centres the error of the four products, which are rounded down.
        let variable = sum.wrapping_add((1 << SPARE_BITS >> 1) + 2) >> SPARE_BITS;
        self.constant.saturating_add_signed(variable)
    }
}

/// `log2(x)` of an integer; error below 1.4 * 2^-32. Zero gives -1, the logarithm of one half.
#[inline]
pub fn log2(x: u32) -> Log2 {
    if x == 0 {
        return Log2::NEG_ONE;
    }
    let zeros = x.leading_zeros();
    // The bits after the leading one.
    let fraction = (x << zeros) << 1;
    let part = LOG2[(fraction >> (32 - ROW_BITS)) as usize].at(fraction << ROW_BITS);
    Log2::from_bits(i64::from(31 - zeros) << 32 | i64::from(part))
}

/// `2^(f / 2^32) - 1` in units of 2^-32, for `f / 2^32` in `[0, 1)`; error below 1.4 units.
#[inline]
pub fn exp2(f: u32) -> u32 {
    EXP2[(f >> (32 - ROW_BITS)) as usize].at(f << ROW_BITS)
}

/// Logarithm of `x^0.95` from that of `x`, for Eq. 6-8; error below 1.5 * 2^-32 for logarithms within ±64,
/// relative error below 2^-36 beyond.
pub(super) fn power_0_95(log2: Log2) -> Log2 {
    /// 0.05, with 36 binary places. `x - 0.05 x` has a smaller rounding error than `0.95 x`.
    const TWENTIETH: u32 = (((1 << 36) + 10) / 20u64) as u32;
    let high = (log2.to_bits() >> 32) * i64::from(TWENTIETH);
    let low = u64::from(log2.to_bits() as u32) * u64::from(TWENTIETH);
    let twentieth = (high + (low >> 32) as i64 + (1 << 3)) >> 4;
    log2.saturating_sub(Log2::from_bits(twentieth))
}
