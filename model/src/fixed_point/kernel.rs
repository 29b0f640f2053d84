//! `erfcx(sqrt(n K))`, the one transcendental function of the model.
//!
//! ```text
//! n K  --exact product-->  octave, 32 bits after the leading one
//! octave  --descriptor-->  rows m of this octave, index of the first
//! m * bits  --high word, low word-->  row, place t in -1/2..1/2 of it
//! row, t  --Horner, degree 7-->  E
//! ```
//!
//! Three things make the last bits right. The two lowest powers are added in 64 bits, and all above them
//! in units of 2^-40. The constant and the slope of a row have 8 bits more than their words hold: those are
//! the low bits of the two highest coefficients, which the fit sets to what is wanted there. And the bits of
//! the product that are left out count as one half.

use super::kernel_table::TABLE;
use super::{Fraction, MantissaExponent, Ticks};

/// Fraction bits of what is above the linear term, in units of 2^-32.
pub const GUARD_BITS: u32 = 8;
/// Octaves of `u` that have a descriptor, by the exponent of their lower end. In the first and the last of
/// them, and beyond, `E` saturates.
pub const OCTAVES: core::ops::Range<i32> = -64..64;
/// Rows of all octaves together; a power of two, so that an index of 8 bits is always a row.
pub const ROWS: usize = 256;
/// Bits of a descriptor below the number of rows of its octave.
pub const COUNT_SHIFT: u32 = 12;

/// `E = erfcx(sqrt(u))` for `u = elapsed * rate_per_tick`: `elapsed` ticks since contact, `rate_per_tick = b² dt`.
///
/// The input is the leading 33 bits of the exact product, so time does not drift; what is cut off moves `E`
/// by at most 0.07 units of 2^-32. From that input on, the error is at most 0.51 units for `u` from 2^-24 to
/// 2^16, checked for every input, and at most 0.54 from 2^-63 to 2^63, proven
/// (`cargo run --release -p contact-model --example verify`). Outside it saturates and never wraps, for every
/// `elapsed` and `rate_per_tick`: below at 1 - 2^-32, the largest fraction, off by at most 0.6; above at 0, by 0.8.
/// Later times never give more than one unit above an earlier one.
///
/// Constant time: no square root, no division, no branch. On a Cortex-M4 34 instructions where it is inlined,
/// 40 with call and return (emulated, `cargo xtask bench`); 8.25 KiB of table.
#[must_use]
#[inline]
pub fn erfcx(elapsed: Ticks, rate_per_tick: MantissaExponent) -> Fraction {
    // elapsed * (1 + fraction / 2^32), never below one.
    let product = u64::from(elapsed.get()) * u64::from(rate_per_tick.fraction());
    let (whole, part) = (
        ((product >> 32) as u32).wrapping_add(elapsed.get()),
        product as u32,
    );
    // Zeros before the leading one, which is there; places after it.
    let shift = whole.leading_zeros() & 31;
    let places = 31 - shift;
    let bits = whole << shift << 1 | part >> places;

    let octave = (rate_per_tick.exponent() + places as i32).clamp(OCTAVES.start, OCTAVES.end - 1);
    let descriptor = TABLE.octaves[(octave - OCTAVES.start) as usize];
    let split = u64::from(bits) * u64::from(descriptor >> COUNT_SHIFT);
    let row =
        &TABLE.rows[usize::from(((split >> 32) as u32).wrapping_add(u32::from(descriptor)) as u8)];
    // Centred on the row: the low word counts from its start.
    let t = (split as u32 ^ 1 << 31) as i32;

    let tail = row
        .inner
        .iter()
        .rev()
        .fold(step(row.seventh, t, row.sixth), |sum, &c| step(sum, t, c));
    let bent = step(step(tail, t, row.sixth), t, row.seventh);
    // The low word begins with the seventh coefficient because it is at hand there; the fit knows.
    let constant = u64::from(row.constant) << 32 | u64::from(row.seventh as u32);
    let straight = constant.wrapping_add_signed(i64::from(row.slope) * i64::from(t));
    let sum = straight.wrapping_add_signed(i64::from(bent) << (32 - GUARD_BITS));
    Fraction::from_bits((sum >> 32) as u32)
}

/// `sum * t + next`, with `t` in units of 2^-32, rounded: one instruction.
#[inline]
const fn step(sum: i32, t: i32, next: i32) -> i32 {
    ((sum as i64 * t as i64 + ((next as i64) << 32) + (1 << 31)) >> 32) as i32
}

/// Where each octave's rows are, and the rows.
#[repr(C)] // The octaves first: their offset then fits the load instruction.
pub(super) struct Table {
    /// Rows in the octave (above [`COUNT_SHIFT`]) and index of the first.
    pub(super) octaves: [u16; (OCTAVES.end - OCTAVES.start) as usize],
    pub(super) rows: [Row; ROWS],
}

/// A polynomial of degree 7 in `t`, -1/2 to 1/2, centred on its row.
#[derive(Clone, Copy)]
pub(super) struct Row {
    /// Units of 2^-32, less one half for rounding; its guard bits are the lowest of `seventh`.
    pub(super) constant: u32,
    /// Units of 2^-32; its guard bits are the lowest of `sixth`.
    pub(super) slope: i32,
    /// From here on in units of 2^-40.
    pub(super) seventh: i32,
    pub(super) sixth: i32,
    /// Second to fifth.
    pub(super) inner: [i32; 4],
}
