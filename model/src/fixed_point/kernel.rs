//! Kernel of the contact model: `E = erfcx(sqrt(n K))` at tick `n`, with `K = b² dt`.
//!
//! ```text
//! n K  --exact product-->  octave, and the 32 bits after the leading one
//! octave  --descriptor-->  number m of table rows in this octave, index of the first
//! m * bits  --high word, low word-->  row, and position t from -1/2 to 1/2 within it
//! row, t  --Horner's scheme, degree 7-->  E
//! ```
//!
//! Three measures keep the error near half a unit of 2^-32. The constant and linear terms are added in 64 bits,
//! and the higher ones in units of 2^-40. The constant and the slope of a row have 8 more bits than their words:
//! the fit chooses the two highest coefficients so that their low bits are these bits. The bits of the product
//! that are cut off are taken as half of their range.

use super::kernel_table::TABLE;
use super::{Fraction, MantissaExponent, Ticks};

/// Additional binary places of the terms above the linear one.
pub const GUARD_BITS: u32 = 8;
/// Octaves of `u` that have a descriptor, as the exponent of their lower end. In the first and the last octave,
/// and beyond them, `E` saturates.
pub const OCTAVES: core::ops::Range<i32> = -64..64;
/// Octaves of `u` that contacts reach in practice, milliseconds to hours; the table is fitted for the smallest error there.
pub const PRACTICAL_OCTAVES: core::ops::Range<i32> = -24..16;
/// Rows in the table; 256, so that every 8-bit index is valid.
pub const ROWS: usize = 256;
/// Position in a descriptor of the number of rows in the octave; the index of the first is below it.
pub const COUNT_SHIFT: u32 = 12;

/// `E = erfcx(sqrt(u))` for `u = elapsed * rate_per_tick`: `elapsed` ticks since landing, `rate_per_tick = b² dt`.
///
/// Error, in units of 2^-32, against the leading 33 bits of the exact product: at most 0.51 for `u` from 2^-24 to
/// 2^16 (every input checked), at most 0.54 from 2^-63 to 2^63 (proven; `cargo run --release -p contact-model
/// --example verify`). The bits cut off add at most 0.07. The product is exact, so time does not drift. Outside
/// that range the result saturates: below at 1 - 2^-32, error at most 0.6; above at 0, error at most 0.8. A later
/// time gives a result that is at most one unit above that of an earlier one.
///
/// Constant time: no square root, no division, no branch. On a Cortex-M4 34 instructions inlined, 40 with call
/// and return (emulated, `cargo xtask bench`); 8.25 KiB of table.
#[inline]
pub fn erfcx(elapsed: Ticks, rate_per_tick: MantissaExponent) -> Fraction {
    // elapsed * (1 + fraction / 2^32), at least 1.
    let product = u64::from(elapsed.get()) * u64::from(rate_per_tick.fraction());
    let (whole, part) = (((product >> 32) as u32).wrapping_add(elapsed.get()), product as u32);
    // Zeros before the leading one, and bits of `whole` after it.
    let shift = whole.leading_zeros() & 31;
    let places = 31 - shift;
    let bits = whole << shift << 1 | part >> places;

    let octave = (rate_per_tick.exponent() + places as i32).clamp(OCTAVES.start, OCTAVES.end - 1);
    let descriptor = TABLE.octaves[(octave - OCTAVES.start) as usize];
    let split = u64::from(bits) * u64::from(descriptor >> COUNT_SHIFT);
    let row =
        &TABLE.rows[usize::from(((split >> 32) as u32).wrapping_add(u32::from(descriptor)) as u8)];
    // The low word counts from the start of the row, `t` from its middle.
    let t = (split as u32 ^ 1 << 31) as i32;

    let higher =
        row.inner.iter().rev().fold(step(row.seventh, t, row.sixth), |sum, &c| step(sum, t, c));
    let curved = step(step(higher, t, row.sixth), t, row.seventh);
    // The seventh coefficient is the low word, because it is in a register; the fit takes account of it.
    let constant = u64::from(row.constant) << 32 | u64::from(row.seventh as u32);
    let linear = constant.wrapping_add_signed(i64::from(row.slope) * i64::from(t));
    let sum = linear.wrapping_add_signed(i64::from(curved) << (32 - GUARD_BITS));
    Fraction::from_bits((sum >> 32) as u32)
}

/// `sum * t + next`, with `t` in units of 2^-32, rounded: one instruction.
#[inline]
const fn step(sum: i32, t: i32, next: i32) -> i32 {
    ((sum as i64 * t as i64 + ((next as i64) << 32) + (1 << 31)) >> 32) as i32
}

/// Descriptors of the octaves, and the rows they refer to.
#[repr(C)] // The octaves first, so that their offset fits the load instruction.
pub(super) struct Table {
    /// Number of rows in the octave (from bit [`COUNT_SHIFT`] on) and index of the first.
    pub(super) octaves: [u16; (OCTAVES.end - OCTAVES.start) as usize],
    pub(super) rows: [Row; ROWS],
}

/// Polynomial of degree 7 in `t`, from -1/2 at the start of the row to 1/2 at its end.
#[derive(Clone, Copy)]
pub(super) struct Row {
    /// Units of 2^-32, with one half subtracted for rounding; the low bits of `seventh` are its further bits.
    pub(super) constant: u32,
    /// Units of 2^-32; the low bits of `sixth` are its further bits.
    pub(super) slope: i32,
    /// Units of 2^-40, as all that follow.
    pub(super) seventh: i32,
    pub(super) sixth: i32,
    /// Second to fifth coefficient.
    pub(super) inner: [i32; 4],
}
