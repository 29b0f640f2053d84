//! Heat-flux sensor of the patch under the finger: a thermopile across a thin layer on the display's face, with amplifier,
//! filter, and a converter of its own.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal};

use super::converter::CODES;
use super::lag::FirstOrderLag;
use crate::parameters::stream_seed;

/// Code at which the sensor reads no flux: mid-scale, 1.65 V.
const MID_SCALE: f64 = 0.5 * CODES;

/// Parameters of the heat-flux sensor. Fluxes are positive out of the skin.
///
/// The non-linearity of its converter is part of the zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxParams {
    /// Error of its gain after calibration, fraction.
    pub gain_error: f64,
    /// Flux that it reads without any, W/m2, after its zero was taken.
    pub zero_w_m2: f64,
    /// Standard deviation of one conversion before quantisation, W/m2.
    pub noise_w_m2: f64,
    /// Time constant of layer and filter together, s.
    pub lag_s: f64,
    /// Thermal resistance of the layer, between display and skin, m2 K/W.
    pub resistance_m2k_w: f64,
    /// Gain, counts per W/m2.
    pub counts_per_w_m2: f64,
}

impl FluxParams {
    /// Values of the reference design, by the error budget in `docs/flux.md`.
    pub const NOMINAL: Self = Self {
        gain_error: 0.0,
        zero_w_m2: 0.0,
        noise_w_m2: 6.5,
        lag_s: 5e-3,
        resistance_m2k_w: 3e-5,
        counts_per_w_m2: 0.1192,
    };

    /// Flux that a code stands for at the nominal gain, W/m2.
    pub fn read_w_m2(code: u16) -> f64 {
        (f64::from(code) - MID_SCALE) / Self::NOMINAL.counts_per_w_m2
    }
}

/// Wiring of the thermopile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FluxCircuit {
    /// Intact.
    #[default]
    Closed,
    /// A wire is broken: the pull at the amplifier's input drives its output to the upper rail.
    Open,
    /// Shorted: no voltage, which reads as no flux.
    Short,
    /// Its wires are swapped.
    Reversed,
}

/// Defects of the heat-flux sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxDefect {
    /// Wiring.
    pub circuit: FluxCircuit,
    /// Whether the converter repeats its last code.
    pub stuck: bool,
    /// Factor on the gain.
    pub gain: f64,
    /// Flux that it reads too much, W/m2.
    pub zero_w_m2: f64,
    /// Factor on the noise.
    pub noise: f64,
}

impl Default for FluxDefect {
    fn default() -> Self {
        Self { circuit: FluxCircuit::Closed, stuck: false, gain: 1.0, zero_w_m2: 0.0, noise: 1.0 }
    }
}

/// The sensor with its converter. It has a random stream of its own, so the other sensors of a finger that is fitted with it
/// read what they read without.
#[derive(Clone, Debug)]
pub struct FluxSensor {
    params: FluxParams,
    lag: FirstOrderLag,
    /// Flux through the layer, mean of the last step, and flux behind the lag, W/m2.
    flux_w_m2: f64,
    lagged_w_m2: f64,
    defect: FluxDefect,
    random: Xoshiro256PlusPlus,
    code: u16,
}

impl FluxSensor {
    /// A sensor in steady state under a flux, W/m2; the seed determines its noise.
    pub fn new(params: FluxParams, flux_w_m2: f64, seed: u64) -> Self {
        let mut sensor = Self {
            params,
            lag: FirstOrderLag::new(params.lag_s),
            flux_w_m2,
            lagged_w_m2: flux_w_m2,
            defect: FluxDefect::default(),
            random: random(seed),
            code: 0,
        };
        sensor.convert();
        sensor
    }

    /// Reseeds the noise.
    pub fn reseed_noise(&mut self, seed: u64) {
        self.random = random(seed);
    }

    /// Sets the defects, which act from the next conversion on.
    pub const fn set_defect(&mut self, defect: FluxDefect) {
        self.defect = defect;
    }

    /// Advances by a step, s, in which the flux through the layer had this mean, W/m2, and converts at its end.
    pub fn step(&mut self, step_s: f64, mean_w_m2: f64) {
        self.flux_w_m2 = mean_w_m2;
        self.lagged_w_m2 = self.lag.step_response(step_s, self.lagged_w_m2, mean_w_m2);
        if !self.defect.stuck {
            self.convert();
        }
    }

    fn convert(&mut self) {
        let (params, defect) = (&self.params, &self.defect);
        let normal: f64 = StandardNormal.sample(&mut self.random);
        let zero_w_m2 =
            params.zero_w_m2 + defect.zero_w_m2 + params.noise_w_m2 * defect.noise * normal;
        let gain = (1.0 + params.gain_error) * defect.gain;
        let level = |seen_w_m2| MID_SCALE + params.counts_per_w_m2 * (gain * seen_w_m2 + zero_w_m2);
        let level = match defect.circuit {
            FluxCircuit::Closed => level(self.lagged_w_m2),
            FluxCircuit::Reversed => level(-self.lagged_w_m2),
            FluxCircuit::Short => level(0.0),
            FluxCircuit::Open => CODES,
        };
        self.code = level.round().clamp(0.0, CODES - 1.0) as u16;
    }

    /// Thermal resistance of its layer, m2 K/W.
    pub const fn resistance_m2k_w(&self) -> f64 {
        self.params.resistance_m2k_w
    }

    /// Flux through its layer, mean of the last step, W/m2.
    pub const fn flux_w_m2(&self) -> f64 {
        self.flux_w_m2
    }

    /// Code at the end of the last step, 0 to 4095.
    pub const fn code(&self) -> u16 {
        self.code
    }
}

fn random(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(stream_seed(seed, "flux"))
}

#[cfg(test)]
mod tests;
