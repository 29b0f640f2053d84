//! What the converter sees: thermistors behind dividers, force sensor, current mirror, and the converter itself.
//!
//! The constants are the simulated parts' own. What the device believes of its sensors is in its settings.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal, StandardUniform};
use thermal_display::sense::CHANNELS;

/// Codes of the 12-bit converter.
const CODES: f64 = 4096.0;
const ZERO_C_K: f64 = 273.15;

/// A signal of one finger, in the converter's scan order (that of `thermal_display::sense::Samples`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Display thermistor, in the contact patch.
    Display,
    /// Second display thermistor.
    DisplayCheck,
    /// Thermistor on the sink.
    Sink,
    /// Thermistor on the skin, at the edge of the contact.
    Skin,
    /// Thermistor in the room.
    Room,
    /// Force sensor.
    Force,
    /// Current mirror of the bridge.
    Current,
}

impl Channel {
    /// All of them in scan order.
    pub const ALL: [Self; CHANNELS] = [
        Self::Display,
        Self::DisplayCheck,
        Self::Sink,
        Self::Skin,
        Self::Room,
        Self::Force,
        Self::Current,
    ];
}

/// A thermistor from the converter's pin to ground, with a resistor from the pin to the converter's reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermistor {
    /// Resistance at 25 deg C, ohm.
    pub at_25c_ohm: f64,
    /// Beta, K.
    pub beta_k: f64,
    /// Resistor to the reference, ohm.
    pub pull_up_ohm: f64,
}

impl Thermistor {
    /// Voltage at the pin in fractions of the reference, at a temperature, deg C. Falls as it warms.
    #[must_use]
    pub fn ratio(&self, temperature_c: f64) -> f64 {
        let exponent = self.beta_k * ((temperature_c + ZERO_C_K).recip() - (25.0 + ZERO_C_K).recip());
        let ohm = self.at_25c_ohm * exponent.exp();
        ohm / (ohm + self.pull_up_ohm)
    }
}

/// What the sensors are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorParams {
    /// Every thermistor.
    pub thermistor: Thermistor,
    /// First-order lag of each thermistor, s: display, second display, sink, skin, room.
    pub lag_s: [f64; 5],
    /// Share of the contact's skin surface in what the skin thermistor at its edge sees; the rest is the skin as
    /// it was before contact.
    pub skin_sees_contact: f64,
    /// Force sensor without force, counts.
    pub force_zero: f64,
    /// Force sensor, counts/N.
    pub force_per_n: f64,
    /// Current mirror, counts/A of either sign.
    pub current_per_a: f64,
    /// Standard deviation of one conversion, counts.
    pub noise: f64,
    /// Integral non-linearity: a bow of at most this height at mid-scale, counts; how much and which way is drawn
    /// from the seed.
    pub bow: f64,
}

impl SensorParams {
    /// The reference design's.
    pub const NOMINAL: Self = Self {
        thermistor: Thermistor {
            at_25c_ohm: 10e3,
            beta_k: 3950.0,
            pull_up_ohm: 10e3,
        },
        lag_s: [0.1, 0.1, 1.0, 0.3, 2.0],
        skin_sees_contact: 0.05,
        force_zero: 410.0,
        force_per_n: 300.0,
        current_per_a: 400.0,
        noise: 0.7,
        bow: 1.5,
    };
}

/// The physical state that the sensors follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensed {
    /// Display surface, deg C.
    pub display_c: f64,
    /// Sink, deg C.
    pub sink_c: f64,
    /// Skin before contact, deg C.
    pub skin_before_c: f64,
    /// Skin surface in the contact, deg C.
    pub skin_c: f64,
    /// Room, deg C.
    pub room_c: f64,
    /// Force of the finger, N.
    pub force_n: f64,
    /// What the driver's current mirror sees, A.
    pub mirror_a: f64,
}

/// The sensors of one finger and the converter that reads them.
#[derive(Clone, Debug)]
pub struct Sensors {
    params: SensorParams,
    /// Height of this converter's bow, counts.
    bow: f64,
    /// What each thermistor follows and what it has reached, deg C.
    target_c: [f64; 5],
    reached_c: [f64; 5],
    /// Noiseless reading of each channel, counts.
    counts: [f64; CHANNELS],
    noise: ChaCha8Rng,
}

impl Sensors {
    /// Sensors at rest in a state; the seed fixes the converter's bow and every later draw of noise.
    #[must_use]
    pub fn new(params: SensorParams, state: &Sensed, seed: u64) -> Self {
        let mut noise = ChaCha8Rng::seed_from_u64(seed);
        let unit: f64 = StandardUniform.sample(&mut noise);
        let target_c = seen_c(&params, state);
        let mut sensors = Self {
            params,
            bow: params.bow * (2.0 * unit - 1.0),
            target_c,
            reached_c: target_c,
            counts: [0.0; CHANNELS],
            noise,
        };
        sensors.read(state);
        sensors
    }

    /// Follows the state over a step, s, at whose end it is `state`.
    pub fn step(&mut self, step_s: f64, state: &Sensed) {
        let target_c = seen_c(&self.params, state);
        for (i, &lag_s) in self.params.lag_s.iter().enumerate() {
            // Exact for a target that moves evenly over the step: a lag trails a ramp by its own time.
            let trail_c = lag_s * (target_c[i] - self.target_c[i]) / step_s;
            let off_ramp_c = self.reached_c[i] - self.target_c[i] + trail_c;
            self.reached_c[i] = target_c[i] - trail_c + off_ramp_c * (-step_s / lag_s).exp();
        }
        self.target_c = target_c;
        self.read(state);
    }

    /// Converts one channel: the nearest code, within 0 to 4095. Each conversion draws noise: the order of calls is part of the experiment.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        let normal: f64 = StandardNormal.sample(&mut self.noise);
        let counts = self.counts[channel as usize] + self.params.noise * normal;
        // The cast rounds down, and a library call for each conversion would show in the run time.
        (counts.clamp(0.0, CODES - 1.0) + 0.5) as u16
    }

    fn read(&mut self, state: &Sensed) {
        let p = &self.params;
        let temperature = self.reached_c.map(|t| p.thermistor.ratio(t) * CODES);
        self.counts[..5].copy_from_slice(&temperature);
        self.counts[Channel::Force as usize] = p.force_zero + p.force_per_n * state.force_n;
        self.counts[Channel::Current as usize] = p.current_per_a * state.mirror_a;
        for counts in &mut self.counts {
            let x = (*counts / CODES).clamp(0.0, 1.0);
            *counts += self.bow * 4.0 * x * (1.0 - x);
        }
    }
}

/// What each thermistor sits on, deg C.
fn seen_c(params: &SensorParams, state: &Sensed) -> [f64; 5] {
    let edge_c = state.skin_before_c + params.skin_sees_contact * (state.skin_c - state.skin_before_c);
    [
        state.display_c,
        state.display_c,
        state.sink_c,
        edge_c,
        state.room_c,
    ]
}

#[cfg(test)]
mod tests;
