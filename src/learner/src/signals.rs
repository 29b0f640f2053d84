//! First-order lags and the bank of unit relaxations, updated once per window.

use contact_model::fixed_point::WEIGHTS;

use crate::decay::WindowDecay;
use crate::parameters::RELAXATIONS;
use crate::sensor::FluxSensor;
use crate::window::WINDOW_S;

/// Number of relaxations with a rate.
pub const RATES: usize = WEIGHTS - 1;

/// The flux sensor's lag, applied to another signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag(f32);

impl Lag {
    pub const ZERO: Self = Self(0.0);

    /// Mean of the lagged signal over a window in which the signal is constant.
    pub fn advance(&mut self, signal: f32, sensor: &FluxSensor) -> f32 {
        let mean = signal + (self.0 - signal) * sensor.mean();
        self.0 = signal + (self.0 - signal) * sensor.remaining();
        mean
    }
}

/// Coefficients of a unit relaxation `du/dt = input - rate u` for windows.
#[derive(Clone, Copy)]
struct UnitRelaxation {
    /// Part of the state that remains at the window's end.
    remaining: f32,
    /// State at the window's end over an input that is constant in the window, s.
    gain_s: f32,
    /// Mean of the decaying state over the window, over its value at the start.
    mean: f32,
    /// Mean of the state over the window, over the input, s.
    mean_gain_s: f32,
}

impl UnitRelaxation {
    /// Mean of the state over a window with this mean input.
    #[inline(always)]
    fn advance(&self, state: &mut f32, input: f32) -> f32 {
        let mean = self.mean * *state + self.mean_gain_s * input;
        *state = self.remaining * *state + self.gain_s * input;
        mean
    }
}

const UNIT_RELAXATIONS: [UnitRelaxation; RATES] = {
    let mut all = [UnitRelaxation {
        remaining: 0.0,
        gain_s: 0.0,
        mean: 0.0,
        mean_gain_s: 0.0,
    }; RATES];
    let mut k = 0;
    while k < RATES {
        let decay = WindowDecay::new(RELAXATIONS[k].rate_1_s);
        all[k] = UnitRelaxation {
            remaining: decay.remaining as f32,
            gain_s: (decay.mean * WINDOW_S) as f32,
            mean: decay.mean as f32,
            mean_gain_s: (decay.mean_of_dose * WINDOW_S) as f32,
        };
        k += 1;
    }
    all
};

/// Unit relaxations of the mean finger's rates, all driven by one flux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bank([f32; RATES]);

/// Window means of a bank's states, J/m², and the flux itself, W/m²: with the weights of a finger their sum is the rise of its
/// surface, K.
pub type BankOutput = [f32; WEIGHTS];

impl Bank {
    pub const ZERO: Self = Self([0.0; RATES]);

    /// Outputs of two banks in a window with these mean fluxes, W/m². In one loop, because of the coefficients.
    pub fn advance_both(banks: [&mut Self; 2], fluxes_w_m2: [f32; 2]) -> [BankOutput; 2] {
        let mut outputs = fluxes_w_m2.map(|flux_w_m2| [flux_w_m2; WEIGHTS]);
        let ([first, second], [of_first, of_second]) = (banks, &mut outputs);
        let states = first.0.iter_mut().zip(&mut second.0);
        let means = of_first.iter_mut().zip(of_second);
        for ((states, means), one) in states.zip(means).zip(&UNIT_RELAXATIONS) {
            *means.0 = one.advance(states.0, fluxes_w_m2[0]);
            *means.1 = one.advance(states.1, fluxes_w_m2[1]);
        }
        outputs
    }
}

/// The sum of products, from the first to the last. Not inlined, so that its loop is in the program once.
#[inline(never)]
pub fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}
