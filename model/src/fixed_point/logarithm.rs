//! Logarithm and power of two, for pressures and thermistors.

use super::log_table::{EXP2, LOG2};
use super::piecewise;

/// A logarithm to base 2: ±128 at a resolution of 2^-24.
pub type Log2 = fixed::types::I8F24;

/// `log2(x)` of an integer; error below 2^-23. Zero gives -1, as one half would.
#[must_use]
#[inline]
pub fn log2(x: u32) -> Log2 {
    if x == 0 {
        return Log2::NEG_ONE;
    }
    let zeros = x.leading_zeros();
    // Fraction of the mantissa in 1..2, 32 bits.
    let fraction = (x << zeros) << 1;
    let row = &LOG2[(fraction >> 27) as usize];
    let part = row[0].wrapping_add(piecewise::variable_part(&[row[1], row[2], row[3]], fraction << 5));
    // The table is in units of 2^-31.
    Log2::from_bits(((31 - zeros) as i32) << 24 | ((part + (1 << 6)) >> 7).min((1 << 24) - 1))
}

/// `2^(31 + f / 2^32)` for `f / 2^32` in `[0, 1)`: a mantissa in `2^31..2^32`; relative error below 2^-27.
#[must_use]
#[inline]
pub fn exp2(f: u32) -> u32 {
    let row = &EXP2[(f >> 28) as usize];
    // The table holds 2^30 (2^f - 1), so that it fits a signed number.
    let part = row[0].wrapping_add(piecewise::variable_part(&[row[1], row[2], row[3]], f << 4));
    (1 << 31) | (part.max(0) as u32) << 1
}
