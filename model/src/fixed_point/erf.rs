//! The error function, for depths in Eq. 3-2.

use super::Fraction;
use super::erf_table::ERF;
use super::piecewise::Row;

/// Argument of [`erf`]: 0 to 8 at a resolution of 2^-29.
pub type ErfArgument = fixed::types::U3F29;

/// Rows per unit of the argument, as a power of two.
const ROW_BITS: u32 = 3;
/// Fraction bits of the table's sloped part.
const SLOPE_BITS: u32 = 33;

/// One piece of the table.
pub(super) type ErfRow = Row<5, SLOPE_BITS>;

/// `erf(x)`; error below 3 units of 2^-32 for every argument. From 4.5 on, one.
#[must_use]
pub fn erf(x: ErfArgument) -> Fraction {
    let bits = x.to_bits();
    ERF.get((bits >> (ErfArgument::FRAC_NBITS - ROW_BITS)) as usize)
        .map_or(Fraction::MAX, |row| {
            Fraction::from_bits(row.at(bits << (ErfArgument::INT_NBITS + ROW_BITS)))
        })
}
