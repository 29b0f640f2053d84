//! Sensors of one finger: thermistors in dividers, force sensor, current and supply of the bridge, and the A/D converter.
//!
//! These are the true characteristics of the simulated parts; those that the device assumes are in its settings.

mod converter;
mod defects;
mod flux;
mod force_cell;
mod lag;
mod params;
mod thermistor;

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

pub use converter::ConverterParams;
pub use defects::{Circuit, ForceDefect, SensorDefects, ThermistorDefect};
pub(crate) use flux::FluxSensor;
pub use flux::{FluxCircuit, FluxDefect, FluxParams};
pub use force_cell::ForceCellParams;
pub(crate) use params::BONDED;
pub use params::{ForceParams, MirrorParams, ReferenceParams, SensorParams};
pub use thermistor::ThermistorParams;

use converter::{CODES, Converter};
use force_cell::ForceCell;
pub(crate) use lag::Delay;
use lag::FirstOrderLag;
use thermistor::{Site, Thermistor};

use crate::bridge::InductorRipple;

/// Number of signals of one finger that the converter scans.
pub const CHANNELS: usize = 8;
/// Number of scans of all channels in one step of the plant, [`STEP_S`](crate::STEP_S).
pub const SCANS_PER_STEP: usize = 16;
/// Number of thermistors of one finger; they are the first channels.
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
    /// Current of the bridge.
    Current,
    /// Supply of the bridge.
    Supply,
}

impl Channel {
    /// All channels in scan order.
    pub const ALL: [Self; CHANNELS] = [
        Self::Display,
        Self::DisplayCheck,
        Self::Sink,
        Self::Skin,
        Self::Room,
        Self::Force,
        Self::Current,
        Self::Supply,
    ];
}

/// Physical quantities that the sensors measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorInputs {
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
    /// Magnitude of the current that the sense resistors see, A.
    pub mirror_a: f64,
    /// Ripple of that current behind the filters.
    pub mirror_ripple: InductorRipple,
    /// Sensed supply of the bridge, counts at a nominal reference.
    pub supply_counts: f64,
}

/// Readings of the sensors before divider and converter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorReadings {
    /// Thermistors in the order of [`Channel::ALL`], deg C; none for one that is open or shorted.
    pub thermistors_c: [Option<f64>; THERMISTORS],
    /// Measured current, A, at the nominal gain.
    pub mirror_a: f64,
}

/// The sensors of one finger and the converter that reads them.
#[derive(Clone, Debug)]
pub struct Sensors {
    params: SensorParams,
    thermistors: [Thermistor; THERMISTORS],
    force_cell: ForceCell,
    force_delay: Delay,
    force_lag: FirstOrderLag,
    /// Output of the force sensor behind its lag, N.
    force_n: f64,
    /// Divider ratios behind the filters, and those in front at the end of the last step.
    divider_lag: FirstOrderLag,
    filtered_ratios: [f64; THERMISTORS],
    ratios: [f64; THERMISTORS],
    /// Output of the current measurement's filters, A, and the ripple on it.
    mirror_lag: FirstOrderLag,
    mirror_a: f64,
    mirror_ripple: InductorRipple,
    supply_counts: f64,
    defects: SensorDefects,
    /// Noise-free level of each channel at the end of the last step, counts.
    counts: [f64; CHANNELS],
    /// Level of the last conversion and its change from one conversion to the next, counts.
    level: [f64; CHANNELS],
    increment: [f64; CHANNELS],
    /// Conversions until the level has reached that of the end of the step.
    remaining: [u8; CHANNELS],
    converter: Converter,
}

impl Sensors {
    /// Sensors in steady state; the seed determines non-linearity and noise of the converter.
    pub fn new(params: SensorParams, state: &SensorInputs, seed: u64) -> Self {
        let excitation_v = params.reference.volt * params.reference.excitation_duty.sqrt();
        let sites = sites(&params, state, false);
        let mut sensors = Self {
            params,
            thermistors: std::array::from_fn(|i| {
                Thermistor::new(params.thermistors[i], &sites[i], excitation_v)
            }),
            force_cell: ForceCell::new(params.force.cell, state.force_n),
            force_delay: Delay::new(params.force.delay_s, state.force_n),
            force_lag: FirstOrderLag::new(params.force.lag_s),
            force_n: state.force_n,
            divider_lag: FirstOrderLag::new(params.divider_lag_s),
            filtered_ratios: [0.0; THERMISTORS],
            ratios: [0.0; THERMISTORS],
            mirror_lag: FirstOrderLag::new(params.mirror.lag_s),
            mirror_a: state.mirror_a,
            mirror_ripple: state.mirror_ripple,
            supply_counts: state.supply_counts,
            defects: SensorDefects::NONE,
            counts: [0.0; CHANNELS],
            level: [0.0; CHANNELS],
            increment: [0.0; CHANNELS],
            remaining: [0; CHANNELS],
            converter: Converter::new(params.converter, Xoshiro256PlusPlus::seed_from_u64(seed)),
        };
        sensors.skip_divider_filters();
        sensors.update_counts();
        sensors.level = sensors.counts;
        sensors
    }

    /// Reseeds the noise of the converter.
    pub fn reseed_noise(&mut self, seed: u64) {
        self.converter.reseed_noise(Xoshiro256PlusPlus::seed_from_u64(seed));
    }

    /// Advances by a step, s, to the inputs `state` at its end: temperatures moved linearly, the force was constant. The
    /// following conversions interpolate the levels between start and end of the step.
    pub fn step(&mut self, step_s: f64, state: &SensorInputs) {
        let sites = sites(&self.params, state, self.defects.skin_on_plate);
        for (thermistor, site) in self.thermistors.iter_mut().zip(&sites) {
            thermistor.step(step_s, site);
        }
        let delayed_n = self.force_delay.push(self.force_cell.step(step_s, state.force_n));
        if !self.defects.force.stuck {
            self.force_n = self.force_lag.step_response(step_s, self.force_n, delayed_n);
        }
        for index in 0..THERMISTORS {
            let ratio = self.pin_ratio(index);
            self.filtered_ratios[index] = self.divider_lag.ramp_response(
                step_s,
                self.filtered_ratios[index],
                self.ratios[index],
                ratio,
            );
            self.ratios[index] = ratio;
        }
        self.mirror_a = self.mirror_lag.step_response(step_s, self.mirror_a, state.mirror_a);
        self.mirror_ripple = state.mirror_ripple;
        self.supply_counts = state.supply_counts;
        self.level = self.counts;
        self.update_counts();
        // The 16 scans of a tick are spread over the step.
        self.remaining = [SCANS_PER_STEP as u8; CHANNELS];
        self.increment =
            std::array::from_fn(|i| (self.counts[i] - self.level[i]) / SCANS_PER_STEP as f64);
    }

    /// Sets the defects. Levels change at once, and the conversions of the coming step start from the new ones.
    pub fn set_defects(&mut self, defects: &SensorDefects) {
        if self.defects == *defects {
            return;
        }
        self.defects = *defects;
        for (thermistor, defect) in self.thermistors.iter_mut().zip(defects.thermistors) {
            thermistor.set_defect(defect);
        }
        self.skip_divider_filters();
        self.update_counts();
    }

    /// Sets the outputs of the dividers' filters to their inputs.
    fn skip_divider_filters(&mut self) {
        self.ratios = std::array::from_fn(|index| self.pin_ratio(index));
        self.filtered_ratios = self.ratios;
    }

    /// Divider ratio at a thermistor channel, from 0 (shorted) to 1 (open).
    ///
    /// # Panics
    /// `index` is not below [`THERMISTORS`].
    pub fn pin_ratio(&self, index: usize) -> f64 {
        self.thermistors[self.defects.connected[index]].ratio()
    }

    /// Readings of the sensors.
    pub fn sensor_readings(&self) -> SensorReadings {
        let connected = self.defects.connected;
        SensorReadings {
            thermistors_c: connected.map(|connected| self.thermistors[connected].reading_c()),
            mirror_a: self.mirror_counts() / SensorParams::NOMINAL.mirror.counts_per_a,
        }
    }

    /// Output of the current measurement, counts.
    fn mirror_counts(&self) -> f64 {
        let current_a = self.defects.mirror_stuck_a.unwrap_or(self.mirror_a);
        self.params.mirror.counts(current_a) * self.reference_scale()
    }

    /// Scale of force, current and supply due to the error of the reference; the ratiometric dividers are unaffected.
    fn reference_scale(&self) -> f64 {
        1.0 / (1.0 + self.params.reference.error)
    }

    /// Moves the level of a channel to the time of its next conversion.
    fn advance_level(&mut self, index: usize) {
        if self.remaining[index] > 0 {
            self.remaining[index] -= 1;
            self.level[index] += self.increment[index];
        }
    }

    /// Converts one channel to a code of 0 to 4095. All channels share one noise sequence, so results depend on the order
    /// of calls.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        let i = channel as usize;
        self.advance_level(i);
        let level = match channel {
            Channel::Current if self.ripple_is_seen() => self.rippled_level(self.remaining[i]),
            _ => self.level[i],
        };
        self.converter.convert(level)
    }

    /// Converts all channels in scan order, with the codes of one call of [`convert`](Self::convert) for each.
    pub fn convert_scan(&mut self) -> [u16; CHANNELS] {
        if self.remaining.contains(&0) {
            (0..CHANNELS).for_each(|i| self.advance_level(i));
        } else {
            // Without a condition for each channel the compiler adds several side by side.
            for i in 0..CHANNELS {
                self.remaining[i] -= 1;
                self.level[i] += self.increment[i];
            }
        }
        let mut levels = self.level;
        if self.ripple_is_seen() {
            let current = Channel::Current as usize;
            levels[current] = self.rippled_level(self.remaining[current]);
        }
        self.converter.convert_all(&levels)
    }

    /// Whether the ripple of the current measurement is more than a hundredth of a count.
    fn ripple_is_seen(&self) -> bool {
        let counts = self.params.mirror.counts_per_a * self.mirror_ripple.half_a;
        counts > 0.01 && self.defects.mirror_stuck_a.is_none()
    }

    /// Level of the current measurement with its ripple, counts, `remaining` scans before the end of the step.
    fn rippled_level(&self, remaining: u8) -> f64 {
        let mirror = &self.params.mirror;
        let scan = (SCANS_PER_STEP - 1).saturating_sub(remaining.into());
        let phase = (mirror.sampling_phase + scan as f64 * mirror.phase_step).fract();
        let current_a = (self.mirror_a + self.mirror_ripple.at_phase(phase)).abs();
        self.converter.with_offset_and_gain(mirror.counts(current_a) * self.reference_scale())
    }

    fn update_counts(&mut self) {
        let (p, force) = (&self.params, &self.defects.force);
        let mut ideal = [0.0; CHANNELS];
        for (index, counts) in ideal.iter_mut().enumerate().take(THERMISTORS) {
            *counts = self.filtered_ratios[index] * CODES;
        }
        if !force.open {
            ideal[Channel::Force as usize] =
                p.force.counts(self.force_n + force.offset_n) * self.reference_scale();
        }
        ideal[Channel::Current as usize] = self.mirror_counts();
        ideal[Channel::Supply as usize] = self.supply_counts * self.reference_scale();
        self.counts = ideal.map(|counts| self.converter.with_offset_and_gain(counts));
    }
}

/// Surroundings of each thermistor.
fn sites(params: &SensorParams, state: &SensorInputs, skin_on_plate: bool) -> [Site; THERMISTORS] {
    let edge_c = if skin_on_plate {
        state.display_c
    } else {
        state.skin_before_c + params.skin_sees_contact * (state.skin_c - state.skin_before_c)
    };
    let surfaces_c = [state.display_c, state.display_c, state.sink_c, edge_c, state.room_c];
    surfaces_c.map(|surface_c| Site { surface_c, room_c: state.room_c })
}

#[cfg(test)]
mod tests;
