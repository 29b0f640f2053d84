//! Thermistor in a divider: time constant, self-heating, lead error and divider ratio.

use super::defects::{Circuit, ThermistorDefect};
use super::lag::FirstOrderLag;

const ZERO_C_K: f64 = 273.15;
/// Reference temperature of the beta equation, 25 deg C, K.
const REFERENCE_K: f64 = 25.0 + ZERO_C_K;

/// A thermistor from the converter pin to ground, with a pull-up resistor from the pin to the reference.
///
/// Values are those of uncalibrated parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermistorParams {
    /// Resistance at 25 deg C, ohm.
    pub at_25c_ohm: f64,
    /// Beta, K.
    pub beta_k: f64,
    /// Pull-up resistor to the reference, ohm.
    pub pull_up_ohm: f64,
    /// Time constant to the surface it is mounted on, s.
    pub lag_s: f64,
    /// Dissipation constant to the surface it is mounted on, W/K. Bonded to metal or glued to skin: estimated for the
    /// thesis's rod of 0.46 mm x 3.2 mm, half embedded in glue; in air: typical of the class, not looked up.
    pub dissipation_w_k: f64,
    /// Weight of the room temperature due to conduction in the leads, 0 to 1; small if they run along the surface (estimated).
    pub lead_share: f64,
}

impl ThermistorParams {
    /// Divider ratio, pin voltage over reference, at a temperature, deg C; falls with temperature.
    pub fn ratio(&self, temperature_c: f64) -> f64 {
        let exponent = self.beta_k * ((temperature_c + ZERO_C_K).recip() - REFERENCE_K.recip());
        let ohm = self.at_25c_ohm * exponent.exp();
        ohm / (ohm + self.pull_up_ohm)
    }

    /// Power scale, W, for an RMS voltage on the divider, V: the thermistor dissipates this times `ratio (1 - ratio)`.
    pub fn heat_scale_w(&self, excitation_v: f64) -> f64 {
        excitation_v * excitation_v / self.pull_up_ohm
    }
}

/// Surroundings of a thermistor at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// Surface that it is mounted on, deg C.
    pub surface_c: f64,
    /// Room, deg C.
    pub room_c: f64,
}

/// State of a thermistor.
#[derive(Clone, Copy, Debug)]
pub struct Thermistor {
    params: ThermistorParams,
    /// Self-heating divided by `ratio (1 - ratio)`, K.
    heat_k: f64,
    lag: FirstOrderLag,
    /// Steady-state temperature for the present surroundings, and present temperature, deg C.
    target_c: f64,
    reached_c: f64,
    ratio: f64,
    defect: ThermistorDefect,
}

/// Iterations for the initial steady state with self-heating; each reduces the error by more than 100.
const ITERATIONS: usize = 8;

impl Thermistor {
    /// A thermistor in steady state with an RMS voltage on its divider, V.
    pub fn new(params: ThermistorParams, site: &Site, excitation_v: f64) -> Self {
        let mut thermistor = Self {
            params,
            heat_k: params.heat_scale_w(excitation_v) / params.dissipation_w_k,
            lag: FirstOrderLag::new(params.lag_s),
            target_c: site.surface_c,
            reached_c: site.surface_c,
            ratio: params.ratio(site.surface_c),
            defect: ThermistorDefect::NONE,
        };
        for _ in 0..ITERATIONS {
            thermistor.target_c = thermistor.target_c(site);
            thermistor.reached_c = thermistor.target_c;
            thermistor.ratio = params.ratio(thermistor.reached_c);
        }
        thermistor
    }

    /// Advances by a step, s, in which the surroundings moved linearly to `site`.
    pub fn step(&mut self, step_s: f64, site: &Site) {
        let target_c = self.target_c(site);
        self.reached_c = self.lag.ramp_response(step_s, self.reached_c, self.target_c, target_c);
        self.target_c = target_c;
        self.update_ratio();
    }

    /// Sets the defect; the voltage at the pin changes at once.
    pub fn set_defect(&mut self, defect: ThermistorDefect) {
        if defect.resistance_factor != self.defect.resistance_factor {
            self.lag = FirstOrderLag::new(self.params.lag_s * defect.resistance_factor);
        }
        self.defect = defect;
        self.update_ratio();
    }

    fn update_ratio(&mut self) {
        self.ratio = match self.defect.circuit {
            Circuit::Closed => self.params.ratio(self.reached_c + self.defect.offset_k),
            Circuit::Open => 1.0,
            Circuit::Short => 0.0,
            Circuit::Resistor(ohm) => ohm / (ohm + self.params.pull_up_ohm),
        };
    }

    /// Divider ratio, pin voltage over reference.
    pub const fn ratio(&self) -> f64 {
        self.ratio
    }

    /// Reading, deg C; none if its circuit is open or shorted, or a resistor is in its place.
    pub fn reading_c(&self) -> Option<f64> {
        (self.defect.circuit == Circuit::Closed).then_some(self.reached_c + self.defect.offset_k)
    }

    /// Steady-state temperature, deg C, with the self-heating of the end of the previous step.
    fn target_c(&self, site: &Site) -> f64 {
        let factor = self.defect.resistance_factor;
        let heat_k = self.heat_k * factor * self.ratio * (1.0 - self.ratio);
        let lead_share = (self.params.lead_share * factor).min(1.0);
        site.surface_c + lead_share * (site.room_c - site.surface_c) + heat_k
    }
}

#[cfg(test)]
mod tests;
