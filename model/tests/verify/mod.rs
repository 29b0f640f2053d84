//! Error of the kernel: over every input of an octave, and as a proven bound for whole octaves.

pub mod proof;

use contact_model::fixed_point::{MantissaExponent, Ticks, erfcx};
use contact_model::reference;
use std::ops::Range;

/// Inputs of an octave.
pub const INPUTS: u64 = 1 << 32;
/// Error of the reference and of the interpolation between its values, in units of 2^-32. The reference has a
/// relative error below 1e-14.
pub const REFERENCE_ERROR: f64 = 5e-5;

/// Inputs between two evaluations of the reference; there a parabola approximates it to 1e-7 units.
const BLOCK: u64 = 1 << 14;
/// One unit of the kernel's result.
pub const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// Errors of the kernel over a run of inputs, in units of 2^-32.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    pub inputs: u64,
    pub worst: f64,
    pub correctly_rounded: u64,
    /// Inputs at which `E` is larger than at the previous one.
    pub increases: u64,
    /// Largest such increase.
    pub largest_increase: u32,
}

impl Statistics {
    pub fn merge(&mut self, other: &Self) {
        self.inputs += other.inputs;
        self.worst = self.worst.max(other.worst);
        self.correctly_rounded += other.correctly_rounded;
        self.increases += other.increases;
        self.largest_increase = self.largest_increase.max(other.largest_increase);
    }
}

/// The exact `E` at an input, in units of 2^-32. An input stands for the middle of the bits cut off the product.
pub fn exact(octave: i32, bits: f64) -> f64 {
    let u = (1.0 + (bits + 0.5) * UNIT) * f64::from(octave).exp2();
    reference::erfcx(u.sqrt()) / UNIT
}

/// The kernel's result at an input.
pub fn kernel(octave: i32, bits: u32) -> u32 {
    erfcx(Ticks::ONE, MantissaExponent::new(octave as i16, bits)).to_bits()
}

/// Checks every input of `octave` in `bits`, whose ends are multiples of [`BLOCK`].
pub fn exhaustive(octave: i32, bits: Range<u64>) -> Statistics {
    let mut statistics = Statistics { inputs: bits.end - bits.start, ..Statistics::default() };
    let mut previous = match bits.start {
        0 => u32::MAX,
        first => kernel(octave, first as u32 - 1),
    };
    for start in bits.step_by(BLOCK as usize) {
        // The parabola through both ends and the middle.
        let half = BLOCK as f64 / 2.0;
        let [a, b, c] = [0.0, half, 2.0 * half].map(|offset| exact(octave, start as f64 + offset));
        let (slope, curvature) =
            ((4.0 * b - 3.0 * a - c) / (2.0 * half), (a - 2.0 * b + c) / (2.0 * half * half));
        for i in 0..BLOCK {
            let value = kernel(octave, (start + i) as u32);
            let x = i as f64;
            let error = (f64::from(value) - (a + x * (slope + x * curvature))).abs();
            // `f64::max` ignores NaN.
            assert!(error.is_finite(), "2^{octave}, {:#x}", start + i);
            statistics.worst = statistics.worst.max(error);
            statistics.correctly_rounded += u64::from(error <= 0.5);
            let increase = value.saturating_sub(previous);
            statistics.increases += u64::from(increase > 0);
            statistics.largest_increase = statistics.largest_increase.max(increase);
            previous = value;
        }
    }
    statistics
}
