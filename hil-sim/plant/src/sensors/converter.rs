//! A/D converter: offset, gain, integral non-linearity, noise and quantisation.

use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal, StandardUniform};

/// Number of codes of the 12-bit converter.
pub const CODES: f64 = 4096.0;

/// Errors of an A/D converter before calibration (STM32F446, 12 bit).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConverterParams {
    /// Offset, counts.
    pub offset_counts: f64,
    /// Gain error, fraction.
    pub gain_error: f64,
    /// Bound of the integral non-linearity (INL), counts. The largest INL of a simulated converter is between half the
    /// bound and the bound.
    pub inl_counts: f64,
    /// Standard deviation of one conversion, counts.
    pub noise_counts: f64,
}

impl ConverterParams {
    /// Typical values of the data sheet; offset and gain error differ from device to device.
    pub const NOMINAL: Self =
        Self { offset_counts: 0.0, gain_error: 0.0, inl_counts: 1.5, noise_counts: 0.7 };
}

/// Upper bits with independent weight errors; between their transitions the profile is smooth.
const BITS: u32 = 5;
const SEGMENTS: usize = 1 << BITS;
const SEGMENT_COUNTS: usize = CODES as usize / SEGMENTS;

/// Integral non-linearity of one converter: a bow, and steps at the transitions of the upper bits, caused by mismatch of
/// the binary-weighted capacitors of a successive-approximation converter. Both ends of the range are without error.
#[derive(Clone, Copy, Debug)]
struct Profile {
    /// Height of the bow at mid-scale, counts, times 4/CODES^2.
    bow: f64,
    /// Straight line of each segment: counts extrapolated to code zero, and slope in counts per code.
    base: [f64; SEGMENTS],
    slope: f64,
}

impl Profile {
    /// Draws a profile whose largest magnitude over all codes is between half the bound and the bound, counts.
    fn draw(bound_counts: f64, random: &mut Xoshiro256PlusPlus) -> Self {
        let mut unit = || -> f64 { StandardUniform.sample(random) };
        let peak_counts = bound_counts * (0.5 + 0.5 * unit());
        let mut even = || 2.0 * unit() - 1.0;
        let bow = even();
        // The mismatch of a sum of unit capacitors grows with the square root of their number.
        let weights: [f64; BITS as usize] =
            std::array::from_fn(|bit| even() * 2f64.powi(bit as i32).sqrt() * 0.25);
        let all: f64 = weights.iter().sum();
        let steps = |segment: usize| -> f64 {
            let set = |bit: &usize| segment >> bit & 1 == 1;
            (0..BITS as usize).filter(set).map(|bit| weights[bit]).sum()
        };
        let shape = Self {
            bow: bow * 4.0 / (CODES * CODES),
            base: std::array::from_fn(steps),
            // The sum of the weight errors is a gain error, which is subtracted.
            slope: -all / CODES,
        };
        let largest = (0..CODES as u32).map(|code| shape.at(f64::from(code)).abs());
        let scale = peak_counts / largest.fold(f64::MIN_POSITIVE, f64::max);
        Self {
            bow: scale * shape.bow,
            base: shape.base.map(|base| scale * base),
            slope: scale * shape.slope,
        }
    }

    /// Error at a level of 0 to 4095 counts.
    #[inline]
    fn at(&self, counts: f64) -> f64 {
        let segment = nearest(counts) as usize / SEGMENT_COUNTS % SEGMENTS;
        self.base[segment] + counts * (self.slope + self.bow * (CODES - counts))
    }
}

/// The nearest integer to a number of 0 to 2^32. A saturating cast after rounding takes several times as long, and there
/// are 128 conversions in a millisecond.
#[inline]
fn nearest(counts: f64) -> u32 {
    /// From this value on the last bit of an f64 has the weight 1.
    const ONES: f64 = (1u64 << 52) as f64;
    (counts + ONES).to_bits() as u32
}

/// One converter.
#[derive(Clone, Debug)]
pub struct Converter {
    params: ConverterParams,
    profile: Profile,
    random: Xoshiro256PlusPlus,
    /// Noise of the coming conversions, counts, from `next` on; drawing it in batches halves its cost.
    noise: [f64; BATCH],
    next: usize,
}

/// Noise values in a batch: one for each conversion of a tick.
const BATCH: usize = 128;

impl Converter {
    /// A converter that draws its non-linearity and its noise from `random`.
    pub fn new(params: ConverterParams, mut random: Xoshiro256PlusPlus) -> Self {
        Self {
            params,
            profile: Profile::draw(params.inl_counts, &mut random),
            random,
            noise: [0.0; BATCH],
            next: BATCH,
        }
    }

    /// Replaces the random source of the noise.
    pub fn reseed_noise(&mut self, random: Xoshiro256PlusPlus) {
        self.random = random;
        self.next = BATCH;
    }

    /// Level with offset and gain error for an ideal level, both in counts.
    pub fn with_offset_and_gain(&self, ideal_counts: f64) -> f64 {
        ideal_counts * (1.0 + self.params.gain_error) + self.params.offset_counts
    }

    /// Converts a level that includes [offset and gain](Self::with_offset_and_gain), counts: the nearest code, 0 to 4095.
    pub fn convert(&mut self, level_counts: f64) -> u16 {
        if self.next == BATCH {
            self.draw_noise();
        }
        let noise = self.noise[self.next];
        self.next += 1;
        let level = (level_counts + noise).clamp(0.0, CODES - 1.0);
        let level = level + self.profile.at(level);
        nearest(level.clamp(0.0, CODES - 1.0)) as u16
    }

    /// Converts several levels in order, with the codes that as many calls of [`convert`](Self::convert) have. The levels are
    /// independent of each other, so the compiler computes them side by side.
    pub fn convert_all<const N: usize>(&mut self, level_counts: &[f64; N]) -> [u16; N] {
        if self.next == BATCH {
            self.draw_noise();
        }
        let Some(noise) = self.noise[self.next..].first_chunk::<N>() else {
            return level_counts.map(|level| self.convert(level));
        };
        self.next += N;
        let levels: [f64; N] =
            std::array::from_fn(|i| (level_counts[i] + noise[i]).clamp(0.0, CODES - 1.0));
        let codes = levels.map(|level| level + self.profile.at(level));
        codes.map(|level| nearest(level.clamp(0.0, CODES - 1.0)) as u16)
    }

    #[inline(never)]
    fn draw_noise(&mut self) {
        let mut random = self.random.clone();
        for noise in &mut self.noise {
            let normal: f64 = StandardNormal.sample(&mut random);
            *noise = self.params.noise_counts * normal;
        }
        self.random = random;
        self.next = 0;
    }
}

#[cfg(test)]
mod tests;
