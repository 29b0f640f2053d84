//! Logarithm and power of two, for pressures and times.

use super::log_table::{EXP2, LOG2};
use super::piecewise::Row;

/// A logarithm to base 2 with 32 fraction bits.
pub type Log2 = fixed::types::I32F32;

/// Rows of either table, as a power of two.
const ROW_BITS: u32 = 5;
/// Fraction bits of the tables' sloped parts.
const SLOPE_BITS: u32 = 35;

/// One piece of either table.
pub(super) type LogRow = Row<4, SLOPE_BITS>;

/// `log2(x)` of an integer; error below 1.4 * 2^-32. Zero gives -1, as one half would.
#[must_use]
#[inline]
pub fn log2(x: u32) -> Log2 {
    if x == 0 {
        return Log2::NEG_ONE;
    }
    let zeros = x.leading_zeros();
    // The mantissa in 1..2 without its one.
    let fraction = (x << zeros) << 1;
    let part = LOG2[(fraction >> (32 - ROW_BITS)) as usize].at(fraction << ROW_BITS);
    Log2::from_bits(i64::from(31 - zeros) << 32 | i64::from(part))
}

/// `2^(f / 2^32) - 1` in units of 2^-32, for `f / 2^32` in `[0, 1)`; error below 1.4 units.
#[must_use]
#[inline]
pub fn exp2(f: u32) -> u32 {
    EXP2[(f >> (32 - ROW_BITS)) as usize].at(f << ROW_BITS)
}

/// 0.95 of a logarithm, the exponent of pressure in Eq. 6-8; error below 1.5 * 2^-32 for logarithms within
/// ±64, and below 2^-36 of them beyond.
pub(super) fn power_0_95(log2: Log2) -> Log2 {
    /// 0.05, with 36 fraction bits: the small part is multiplied, so that its rounding matters less.
    const TWENTIETH: u32 = (((1 << 36) + 10) / 20u64) as u32;
    let high = (log2.to_bits() >> 32) * i64::from(TWENTIETH);
    let low = u64::from(log2.to_bits() as u32) * u64::from(TWENTIETH);
    let twentieth = (high + (low >> 32) as i64 + (1 << 3)) >> 4;
    log2.saturating_sub(Log2::from_bits(twentieth))
}
