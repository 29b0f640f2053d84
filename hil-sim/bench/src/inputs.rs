//! The inputs of the kernels: the same numbers everywhere.
use contact_model::fixed_point::{MantissaExponent, Ticks};

/// Octaves of the product of the leading powers of two of `n` and `K`; with both mantissas below 2, `u = n K` lies
/// from 2^-24 to 2^16, where scenes live.
const OCTAVES: core::ops::Range<i32> = -24..15;
/// Most bits of `n`: 4.6 hours at 1 kHz.
const TICK_BITS: u32 = 24;
/// 2^32 over the golden ratio: steps of this size modulo 2^32 fill the range evenly, however many are taken.
const GOLDEN: u32 = 0x9e37_79b9;

/// One input in the natural type of every kernel; `K` is rounded to each.
#[derive(Clone, Copy, Debug)]
pub struct Input {
    /// Ticks since contact.
    pub elapsed: Ticks,
    /// `K`, exactly.
    pub rate: MantissaExponent,
    /// `K`, exactly.
    pub double: f64,
    /// `K`, rounded.
    pub single: f32,
}

impl Input {
    /// `elapsed` ticks at a `K` that is rounded to 33 bits; `None` if that is no positive, normal number.
    #[must_use]
    pub fn new(elapsed: Ticks, per_tick: f64) -> Option<Self> {
        let rate = MantissaExponent::from_f64(per_tick)?;
        let double = rate.to_f64();
        Some(Self {
            elapsed,
            rate,
            double,
            single: double as f32,
        })
    }

    /// The input number `index`: octaves evenly, mantissas evenly within them.
    #[must_use]
    pub fn nth(index: u32) -> Option<Self> {
        let place = index.wrapping_mul(GOLDEN);
        let octave = OCTAVES.start + below(place, OCTAVES.len() as u32) as i32;
        let bits = scramble(place);
        let tick_octave = below(bits, TICK_BITS);
        let elapsed = Ticks::new(1 << tick_octave | below(scramble(bits), 1 << tick_octave))?;
        let exponent = octave - tick_octave as i32;
        let fraction = u64::from(scramble(bits ^ GOLDEN));
        Self::new(
            elapsed,
            f64::from_bits(((1023 + exponent) as u64) << 52 | fraction << 20),
        )
    }
}

/// `place / 2^32` of `count`, rounded down.
fn below(place: u32, count: u32) -> u32 {
    ((u64::from(place) * u64::from(count)) >> 32) as u32
}

/// Another number for each number, without visible order.
fn scramble(x: u32) -> u32 {
    let x = (x ^ x >> 16).wrapping_mul(0x045d_9f3b);
    let x = (x ^ x >> 16).wrapping_mul(0x045d_9f3b);
    x ^ x >> 16
}
