//! First-order lags and the bank of unit relaxations, updated once per window.

use contact_model::fixed_point::WEIGHTS;

use crate::decay::WindowDecay;
use crate::parameters::RELAXATIONS;
use crate::sensor::FluxSensor;
use crate::window::WINDOW_S;

/// Number of relaxations in a bank: those of the mean finger without its integrator.
pub const RELAXATION_COUNT: usize = WEIGHTS - 1;

/// The flux sensor's lag, applied to another signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag(f32);

impl Lag {
    pub const ZERO: Self = Self(0.0);

    /// Mean of the lagged signal over the next window, in which the signal is constant.
    #[inline(always)]
    pub fn mean(&self, signal: f32, sensor: &FluxSensor) -> f32 {
        signal + (self.0 - signal) * sensor.mean()
    }

    /// Advances by that window.
    #[inline(always)]
    pub fn advance(&mut self, signal: f32, sensor: &FluxSensor) {
        self.0 = signal + (self.0 - signal) * sensor.remaining();
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

const UNIT_RELAXATIONS: [UnitRelaxation; RELAXATION_COUNT] = {
    let mut all = [UnitRelaxation { remaining: 0.0, gain_s: 0.0, mean: 0.0, mean_gain_s: 0.0 };
        RELAXATION_COUNT];
    let mut k = 0;
    while k < RELAXATION_COUNT {
        let decay = WindowDecay::new(RELAXATIONS[k].rate_1_s);
        all[k] = UnitRelaxation {
            remaining: decay.remaining as f32,
            gain_s: (decay.mean * WINDOW_S) as f32,
            mean: decay.mean as f32,
            mean_gain_s: (decay.mean_of_input_response * WINDOW_S) as f32,
        };
        k += 1;
    }
    all
};

/// Unit relaxations of the mean finger's rates, all driven by one flux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bank([f32; RELAXATION_COUNT]);

/// Window means of a bank's states, J/m², and the flux itself, W/m²: with the weights of a finger their sum is the rise of its
/// surface, K.
pub type BankOutput = [f32; WEIGHTS];

impl Bank {
    pub const ZERO: Self = Self([0.0; RELAXATION_COUNT]);

    /// Output in the next window, with this mean flux, W/m².
    pub fn output(&self, flux_w_m2: f32) -> BankOutput {
        let mut output = [flux_w_m2; WEIGHTS];
        for ((mean, state), one) in output.iter_mut().zip(&self.0).zip(&UNIT_RELAXATIONS) {
            *mean = one.mean * state + one.mean_gain_s * flux_w_m2;
        }
        output
    }

    /// Advances two banks by a window with these mean fluxes, W/m². In one loop, because of the coefficients.
    pub fn advance_both(banks: [&mut Self; 2], fluxes_w_m2: [f32; 2]) {
        let [first, second] = banks;
        let states = first.0.iter_mut().zip(&mut second.0);
        for ((first, second), one) in states.zip(&UNIT_RELAXATIONS) {
            *first = one.remaining * *first + one.gain_s * fluxes_w_m2[0];
            *second = one.remaining * *second + one.gain_s * fluxes_w_m2[1];
        }
    }
}

/// The sum of products, from the first to the last. Not inlined, so that its loop is in the program once.
#[inline(never)]
pub fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}
