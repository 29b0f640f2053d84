//! A thermistor under a pull-up: what it follows, how it warms itself, and what the divider makes of it.

use super::defects::{Circuit, ThermistorDefect};
use super::follow::Lag;

const ZERO_C_K: f64 = 273.15;
/// What beta counts from, 25 deg C, K.
const REFERENCE_K: f64 = 25.0 + ZERO_C_K;

/// A thermistor from the converter's pin to ground, with a resistor from the pin to the converter's reference.
///
/// Tolerances are of parts as they are bought; the device has not been calibrated for any of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermistorParams {
    /// Resistance at 25 deg C, ohm.
    pub at_25c_ohm: f64,
    /// Beta, K.
    pub beta_k: f64,
    /// Resistor to the reference, ohm.
    pub pull_up_ohm: f64,
    /// First-order lag behind what it sits on, s.
    pub lag_s: f64,
    /// Heat that it gives to what it sits on, per kelvin above it, W/K. Bonded to metal or glued to skin: estimated
    /// for a rod of 0.46 mm x 3.2 mm, the thesis's, half in glue; in air recalled of the class.
    pub dissipation_w_k: f64,
    /// Share of the room that its leads let in, 0 to 1; little with leads that run along the surface (estimated).
    pub lead_share: f64,
}

impl ThermistorParams {
    /// Voltage at the pin in fractions of the reference, at a temperature, deg C. Falls as it warms.
    #[must_use]
    pub fn ratio(&self, temperature_c: f64) -> f64 {
        let exponent = self.beta_k * ((temperature_c + ZERO_C_K).recip() - REFERENCE_K.recip());
        let ohm = self.at_25c_ohm * exponent.exp();
        ohm / (ohm + self.pull_up_ohm)
    }

    /// Power in the thermistor, W, with a root mean square of the voltage on the divider, V, is this times the
    /// divider's ratio times what the ratio leaves of one.
    #[must_use]
    pub fn heat_scale_w(&self, excitation_v: f64) -> f64 {
        excitation_v * excitation_v / self.pull_up_ohm
    }
}

/// What a thermistor has around it at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// What it sits on, deg C.
    pub surface_c: f64,
    /// The room, deg C.
    pub room_c: f64,
}

/// A thermistor at work.
#[derive(Clone, Copy, Debug)]
pub struct Thermistor {
    params: ThermistorParams,
    /// Self-heating over the product of both parts of the divider, K.
    heat_k: f64,
    lag: Lag,
    /// What it moves towards, and where it is, deg C.
    target_c: f64,
    reached_c: f64,
    ratio: f64,
    defect: ThermistorDefect,
}

/// Rounds in which a thermistor at rest finds its own temperature: each round leaves less than a hundredth.
const ROUNDS: usize = 8;

impl Thermistor {
    /// At rest, with a root mean square of the voltage on its divider, V.
    pub fn new(params: ThermistorParams, site: &Site, excitation_v: f64) -> Self {
        let mut thermistor = Self {
            params,
            heat_k: params.heat_scale_w(excitation_v) / params.dissipation_w_k,
            lag: Lag::new(params.lag_s),
            target_c: site.surface_c,
            reached_c: site.surface_c,
            ratio: params.ratio(site.surface_c),
            defect: ThermistorDefect::NONE,
        };
        for _ in 0..ROUNDS {
            thermistor.target_c = thermistor.target_c(site);
            thermistor.reached_c = thermistor.target_c;
            thermistor.ratio = params.ratio(thermistor.reached_c);
        }
        thermistor
    }

    /// Follows over a step, s, in which what is around it has moved evenly.
    pub fn step(&mut self, step_s: f64, site: &Site) {
        let target_c = self.target_c(site);
        self.reached_c = self
            .lag
            .along_ramp(step_s, self.reached_c, self.target_c, target_c);
        self.target_c = target_c;
        self.read();
    }

    /// Breaks or mends it; the pin moves at once.
    pub fn set_defect(&mut self, defect: ThermistorDefect) {
        if defect.loose != self.defect.loose {
            self.lag = Lag::new(self.params.lag_s * defect.loose);
        }
        self.defect = defect;
        self.read();
    }

    fn read(&mut self) {
        self.ratio = match self.defect.circuit {
            Circuit::Closed => self.params.ratio(self.reached_c + self.defect.offset_k),
            Circuit::Open => 1.0,
            Circuit::Short => 0.0,
        };
    }

    /// Voltage at the pin in fractions of the reference.
    pub const fn ratio(&self) -> f64 {
        self.ratio
    }

    /// What it reads, deg C; none if its wires are broken.
    pub fn reads_c(&self) -> Option<f64> {
        (self.defect.circuit == Circuit::Closed).then_some(self.reached_c + self.defect.offset_k)
    }

    /// Where it would come to rest; it heats itself as it did at the end of the step before.
    fn target_c(&self, site: &Site) -> f64 {
        let loose = self.defect.loose;
        let heat_k = self.heat_k * loose * self.ratio * (1.0 - self.ratio);
        let lead_share = (self.params.lead_share * loose).min(1.0);
        site.surface_c + lead_share * (site.room_c - site.surface_c) + heat_k
    }
}

#[cfg(test)]
mod tests;
