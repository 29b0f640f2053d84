//! Inputs of the kernels, the same on the host and on the microcontroller.
use contact_model::fixed_point::{MantissaExponent, Ticks};

/// Octaves of the product of the leading powers of two of `n` and `K`; with both mantissas below 2, `u = n K` lies
/// from 2^-24 to 2^16, the range that occurs in scenes.
const OCTAVES: core::ops::Range<i32> = -24..15;
/// Largest number of bits of `n`: 4.6 hours at 1 kHz.
const TICK_BITS: u32 = 24;
/// 2^32 over the golden ratio: steps of this size modulo 2^32 fill the range evenly, whatever their number.
const GOLDEN: u32 = 0x9e37_79b9;

/// One input, with `K` rounded to the type of each kernel.
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
    pub fn new(elapsed: Ticks, per_tick: f64) -> Option<Self> {
        let rate = MantissaExponent::from_f64(per_tick)?;
        let double = rate.to_f64();
        Some(Self { elapsed, rate, double, single: double as f32 })
    }

    /// The input with this index: uniform over octaves, and uniform over mantissas within an octave.
    pub fn nth(index: u32) -> Option<Self> {
        let place = index.wrapping_mul(GOLDEN);
        let octave = OCTAVES.start + below(place, OCTAVES.len() as u32) as i32;
        let bits = scramble(place);
        let tick_octave = below(bits, TICK_BITS);
        let elapsed = Ticks::new(1 << tick_octave | below(scramble(bits), 1 << tick_octave))?;
        let exponent = octave - tick_octave as i32;
        let fraction = u64::from(scramble(bits ^ GOLDEN));
        Self::new(elapsed, f64::from_bits(((1023 + exponent) as u64) << 52 | fraction << 20))
    }
}

/// `count * place / 2^32`, rounded down.
fn below(place: u32, count: u32) -> u32 {
    ((u64::from(place) * u64::from(count)) >> 32) as u32
}

/// A bijective hash.
fn scramble(x: u32) -> u32 {
    let x = (x ^ x >> 16).wrapping_mul(0x045d_9f3b);
    let x = (x ^ x >> 16).wrapping_mul(0x045d_9f3b);
    x ^ x >> 16
}
