//! Checks the kernel against the exact function: every input of an octave, and a proof for whole octaves.

pub mod proof;

use contact_model::fixed_point::{MantissaExponent, Ticks, erfcx};
use contact_model::reference;
use std::ops::Range;

/// Inputs of an octave.
pub const INPUTS: u64 = 1 << 32;
/// Octaves where scenes live.
pub const LIVED_IN: Range<i32> = -24..16;
/// What the reference and the interpolation between its values may be off, in units of 2^-32: the reference
/// has a relative error below 1e-14.
pub const TRUTH_ERROR: f64 = 5e-5;

/// Inputs between two values of the reference; the exact function is a parabola there to 1e-7 units.
const BLOCK: u64 = 1 << 14;
const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// What a stretch of inputs has shown. Errors in units of 2^-32.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    pub inputs: u64,
    pub worst: f64,
    pub correctly_rounded: u64,
    /// Inputs at which `E` is above that of the input before, and by how much at most.
    pub rises: u64,
    pub largest_rise: u32,
}

impl Tally {
    pub fn merge(&mut self, other: &Self) {
        self.inputs += other.inputs;
        self.worst = self.worst.max(other.worst);
        self.correctly_rounded += other.correctly_rounded;
        self.rises += other.rises;
        self.largest_rise = self.largest_rise.max(other.largest_rise);
    }
}

/// The exact `E` in units of 2^-32 at an input, which stands for the middle of what was cut off from it.
pub fn exact(octave: i32, bits: f64) -> f64 {
    let u = (1.0 + (bits + 0.5) * UNIT) * f64::from(octave).exp2();
    reference::erfcx(u.sqrt()) / UNIT
}

/// The kernel at an input.
pub fn kernel(octave: i32, bits: u32) -> u32 {
    erfcx(Ticks::ONE, MantissaExponent::new(octave as i16, bits)).to_bits()
}

/// Every input of `octave` in `bits`, whose ends are multiples of the block.
pub fn exhaustive(octave: i32, bits: Range<u64>) -> Tally {
    let mut tally = Tally {
        inputs: bits.end - bits.start,
        ..Tally::default()
    };
    let mut before = match bits.start {
        0 => u32::MAX,
        first => kernel(octave, first as u32 - 1),
    };
    for start in bits.step_by(BLOCK as usize) {
        // The parabola through both ends and the middle.
        let half = BLOCK as f64 / 2.0;
        let [a, b, c] = [0.0, half, 2.0 * half].map(|offset| exact(octave, start as f64 + offset));
        let (slope, curve) = (
            (4.0 * b - 3.0 * a - c) / (2.0 * half),
            (a - 2.0 * b + c) / (2.0 * half * half),
        );
        for i in 0..BLOCK {
            let value = kernel(octave, (start + i) as u32);
            let x = i as f64;
            let error = (f64::from(value) - (a + x * (slope + x * curve))).abs();
            // `max` would pass over what is no number.
            assert!(error.is_finite(), "2^{octave}, {:#x}", start + i);
            tally.worst = tally.worst.max(error);
            tally.correctly_rounded += u64::from(error <= 0.5);
            let rise = value.saturating_sub(before);
            tally.rises += u64::from(rise > 0);
            tally.largest_rise = tally.largest_rise.max(rise);
            before = value;
        }
    }
    tally
}
