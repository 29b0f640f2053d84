//! `erfcx(sqrt(n K))`, the one transcendental function of the model.

use super::kernel_table::TABLE;
use super::{Fraction, Rate, Ticks, piecewise};

/// Degree of the polynomials in the table.
pub const DEGREE: usize = 5;
/// Rows into which an octave of `u` is cut; a power of two.
pub const ROWS_PER_OCTAVE: usize = 1 << ROW_BITS;
/// Octaves of `u` that the table covers, by the exponent of their lower end. Below, `E` rounds to
/// `1 - 2^-32`; above, to 0.
pub const OCTAVES: core::ops::Range<i16> = -64..64;

const ROW_BITS: u32 = 2;

/// `E = erfcx(sqrt(u))` for `u = elapsed * per_tick`: `elapsed` ticks since contact, `per_tick = b² dt`.
///
/// The product is exact, so time does not drift; its leading 32 bits are used. There is no
/// square root and no division: the octave of `u` and its leading bits pick a row, and a polynomial in the
/// bits after them gives `E`.
///
/// Error at most 9 units of 2^-32 in every octave, sampled (`cargo test -p contact-model kernel`);
/// saturates for every `per_tick` and `elapsed`, never wraps. 12 KiB of table.
#[must_use]
#[inline]
pub fn erfcx(elapsed: Ticks, per_tick: Rate) -> Fraction {
    let product = u64::from(elapsed.get()) * (1 << 32 | u64::from(per_tick.fraction()));
    let shift = product.leading_zeros() as i16;
    let leading = ((product << shift) >> 32) as u32;
    let octave = per_tick.exponent() + 31 - shift;
    if octave < OCTAVES.start {
        return Fraction::MAX;
    }
    let row = ((octave - OCTAVES.start) as usize) << ROW_BITS | (leading << 1 >> (32 - ROW_BITS)) as usize;
    let Some(row) = TABLE.get(row) else {
        return Fraction::ZERO;
    };
    let t = leading << (1 + ROW_BITS);
    let change = piecewise::variable_part(&row.rest, t);
    Fraction::from_bits(row.constant.saturating_add_signed(change))
}

/// One piece of the table, in units of 2^-32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) constant: u32,
    pub(super) rest: [i32; DEGREE],
}
