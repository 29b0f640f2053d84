//! Error function, for temperatures below the surface (Eq. 3-2).

use super::Fraction;
use super::erf_table::ERF;
use super::piecewise::Row;

/// Argument of [`erf`], dimensionless: 0 to 8, resolution 2^-29.
pub type ErfArgument = fixed::types::U3F29;

/// log2 of the number of rows per unit of the argument.
const ROW_BITS: u32 = 3;
/// Binary places of the table's coefficients, but for the constant ones.
const SLOPE_BITS: u32 = 33;

/// One row of the table.
pub(super) type ErfRow = Row<5, SLOPE_BITS>;

/// `erf(x)`; error below 3 * 2^-32 for every argument. From 4.5 on it is 1 - 2^-32, the largest fraction.
#[must_use]
pub fn erf(x: ErfArgument) -> Fraction {
    let bits = x.to_bits();
    ERF.get((bits >> (ErfArgument::FRAC_NBITS - ROW_BITS)) as usize)
        .map_or(Fraction::MAX, |row| {
            Fraction::from_bits(row.at(bits << (ErfArgument::INT_NBITS + ROW_BITS)))
        })
}
