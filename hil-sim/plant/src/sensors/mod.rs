//! What the converter sees: thermistors behind dividers, force sensor, current mirror, and the converter itself.
//!
//! The constants are the simulated parts' own. What the device believes of its sensors is in its settings.

mod converter;
mod defects;
mod follow;
mod params;
mod thermistor;

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

pub use converter::ConverterParams;
pub use defects::{Circuit, ForceDefect, SensorDefects, ThermistorDefect};
pub(crate) use params::BONDED;
pub use params::{ForceParams, MirrorParams, ReferenceParams, SensorParams};
pub use thermistor::ThermistorParams;

use converter::{CODES, Converter};
pub(crate) use follow::Delay;
use follow::Lag;
use thermistor::{Site, Thermistor};

/// Signals of one finger that the converter scans.
pub const CHANNELS: usize = 7;
/// Scans of all channels in one step of the plant, [`STEP_S`](crate::STEP_S).
pub const SCANS_PER_STEP: usize = 16;
/// Thermistors of one finger: the first of the channels.
pub const THERMISTORS: usize = 5;

/// A signal of one finger, in the converter's scan order.
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

/// What the sensors show, before divider and converter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taken {
    /// The thermistors at the five pins, in the order of [`Channel::ALL`], deg C; none where a wire is broken.
    pub thermistors_c: [Option<f64>; THERMISTORS],
    /// Current mirror, A by the nominal gain.
    pub mirror_a: f64,
}

/// The sensors of one finger and the converter that reads them.
#[derive(Clone, Debug)]
pub struct Sensors {
    params: SensorParams,
    thermistors: [Thermistor; THERMISTORS],
    force_delay: Delay,
    force_lag: Lag,
    /// What the force sensor has reached, N.
    force_n: f64,
    /// What the current mirror last saw, A.
    mirror_a: f64,
    defects: SensorDefects,
    /// Noiseless level of each channel at the end of the last step, counts.
    counts: [f64; CHANNELS],
    /// What its last conversion saw, and how far it moves from one conversion to the next.
    seen: [f64; CHANNELS],
    rise: [f64; CHANNELS],
    /// Conversions until it has arrived.
    left: [usize; CHANNELS],
    converter: Converter,
}

impl Sensors {
    /// Sensors at rest in a state; the seed fixes the converter's profile and every later draw of noise.
    #[must_use]
    pub fn new(params: SensorParams, state: &Sensed, seed: u64) -> Self {
        let excitation_v = params.reference.volt * params.reference.excitation_duty.sqrt();
        let sites = sites(&params, state);
        let mut sensors = Self {
            params,
            thermistors: std::array::from_fn(|i| {
                Thermistor::new(params.thermistors[i], &sites[i], excitation_v)
            }),
            force_delay: Delay::new(params.force.delay_s, state.force_n),
            force_lag: Lag::new(params.force.lag_s),
            force_n: state.force_n,
            mirror_a: state.mirror_a,
            defects: SensorDefects::NONE,
            counts: [0.0; CHANNELS],
            seen: [0.0; CHANNELS],
            rise: [0.0; CHANNELS],
            left: [0; CHANNELS],
            converter: Converter::new(params.converter, Xoshiro256PlusPlus::seed_from_u64(seed)),
        };
        sensors.read();
        sensors.seen = sensors.counts;
        sensors
    }

    /// Draws the converter's noise of another seed from now on.
    pub fn reseed_noise(&mut self, seed: u64) {
        self.converter
            .reseed_noise(Xoshiro256PlusPlus::seed_from_u64(seed));
    }

    /// Follows the state over a step, s, at whose end it is `state`: temperatures have moved there evenly, the force
    /// was what it is for the whole step. The conversions of a tick that follow see them on their way there.
    pub fn step(&mut self, step_s: f64, state: &Sensed) {
        let sites = sites(&self.params, state);
        for (thermistor, site) in self.thermistors.iter_mut().zip(&sites) {
            thermistor.step(step_s, site);
        }
        let arrived_n = self.force_delay.push(state.force_n);
        if !self.defects.force.stuck {
            self.force_n = self.force_lag.towards(step_s, self.force_n, arrived_n);
        }
        self.mirror_a = state.mirror_a;
        self.seen = self.counts;
        self.read();
        // The 16 scans of a tick, spread over the step.
        self.left = [SCANS_PER_STEP; CHANNELS];
        self.rise =
            std::array::from_fn(|i| (self.counts[i] - self.seen[i]) / SCANS_PER_STEP as f64);
    }

    /// Breaks or mends the sensors. Levels jump: the conversions of the coming step begin where they are then.
    pub fn set_defects(&mut self, defects: &SensorDefects) {
        if self.defects == *defects {
            return;
        }
        self.defects = *defects;
        for (thermistor, defect) in self.thermistors.iter_mut().zip(defects.thermistors) {
            thermistor.set_defect(defect);
        }
        self.read();
    }

    /// Voltage at a thermistor's pin in fractions of the reference: between none, shorted, and all of it, open.
    ///
    /// # Panics
    /// `index` is not below [`THERMISTORS`].
    #[must_use]
    pub fn pin_ratio(&self, index: usize) -> f64 {
        self.thermistors[self.defects.plugged[index]].ratio()
    }

    /// What they show.
    #[must_use]
    pub fn taken(&self) -> Taken {
        let plugged = self.defects.plugged;
        Taken {
            thermistors_c: plugged.map(|plugged| self.thermistors[plugged].reads_c()),
            mirror_a: self.mirror_counts() / SensorParams::NOMINAL.mirror.counts_per_a,
        }
    }

    /// Level of the current mirror.
    fn mirror_counts(&self) -> f64 {
        let current_a = self.defects.mirror_stuck_a.unwrap_or(self.mirror_a);
        self.params.mirror.counts(current_a) * self.per_volt()
    }

    /// The reference carries the dividers with it, but not what has a scale of its own.
    fn per_volt(&self) -> f64 {
        1.0 / (1.0 + self.params.reference.error)
    }

    /// Converts one channel: the nearest code, within 0 to 4095. Each conversion draws noise: the order of calls is
    /// part of the experiment.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        let i = channel as usize;
        if self.left[i] > 0 {
            self.left[i] -= 1;
            self.seen[i] += self.rise[i];
        }
        self.converter.convert(self.seen[i])
    }

    fn read(&mut self) {
        let (p, force) = (&self.params, &self.defects.force);
        let mut ideal = [0.0; CHANNELS];
        for (index, counts) in ideal.iter_mut().enumerate().take(THERMISTORS) {
            *counts = self.pin_ratio(index) * CODES;
        }
        if !force.open {
            ideal[Channel::Force as usize] =
                p.force.counts(self.force_n + force.offset_n) * self.per_volt();
        }
        ideal[Channel::Current as usize] = self.mirror_counts();
        self.counts = ideal.map(|counts| self.converter.seen(counts));
    }
}

/// What each thermistor has around it.
fn sites(params: &SensorParams, state: &Sensed) -> [Site; THERMISTORS] {
    let edge_c =
        state.skin_before_c + params.skin_sees_contact * (state.skin_c - state.skin_before_c);
    let surfaces_c = [
        state.display_c,
        state.display_c,
        state.sink_c,
        edge_c,
        state.room_c,
    ];
    surfaces_c.map(|surface_c| Site {
        surface_c,
        room_c: state.room_c,
    })
}

#[cfg(test)]
mod tests;
