//! Frequency response of a plant to its current, from the plant alone: without device, sensor and noise.
//!
//! The bridge is driven with a sine, and the fundamentals of the plate's surface temperature and of the current are
//! compared. Drift is removed from both first: half of the difference between a signal and the mean of its values half
//! a period before and after keeps the fundamental and turns a parabola into a constant.

use std::f64::consts::TAU;

use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::{ConfigError, STEP_S};

use super::CommissioningSetup;

/// Amplitude of the duty cycle around one half: about 1.5 A.
const DUTY_AMPLITUDE: f64 = 0.08;
/// Settling periods, which are ignored, and analysed periods.
const SETTLING_PERIODS: usize = 3;
const ANALYSED_PERIODS: usize = 4;

/// Frequency response of the plate's surface to the current, at one frequency; a cooling current is positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrequencyResponse {
    /// Angular frequency, rad/s.
    pub w: f64,
    /// Amplitude of the surface per that of the current, K/A.
    pub k_a: f64,
    /// Phase by which the cooling lags the current, rad; a quarter turn for an integrator.
    pub phase_lag_rad: f64,
}

impl FrequencyResponse {
    /// Measures the response near an angular frequency, rad/s: half a period is rounded to whole steps.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn measure(setup: &CommissioningSetup, w: f64) -> Result<Self, ConfigError> {
        let half = ((0.5 * TAU / (w * STEP_S)).round() as usize).max(2);
        let period = 2 * half;
        let mut world = setup.in_use()?;
        world.connect_supply();
        let (mut surface_c, mut current_a) = (Vec::new(), Vec::new());
        for step in 0..(SETTLING_PERIODS + ANALYSED_PERIODS + 1) * period {
            let duty = DUTY_AMPLITUDE * (TAU * step as f64 / period as f64).sin();
            world.step(BridgeOutputs {
                a: Leg::Duty(0.5 + duty),
                b: Leg::Duty(0.5 - duty),
                enabled: true,
            });
            surface_c.push(world.plant().display_c());
            current_a.push(world.plant().current_a());
        }
        let from = SETTLING_PERIODS * period;
        let fundamental = |signal: &[f64]| {
            let compared = from..from + ANALYSED_PERIODS * period;
            compared.fold((0.0, 0.0), |(re, im), i| {
                let around = 0.5 * (signal[i - half] + signal[i + half]);
                let swing = 0.5 * (signal[i] - around);
                let angle = TAU * i as f64 / period as f64;
                (re + swing * angle.cos(), im - swing * angle.sin())
            })
        };
        let ((a, b), (c, d)) = (fundamental(&surface_c), fundamental(&current_a));
        let phase_lag_rad = (d.atan2(c) - (-b).atan2(-a)).rem_euclid(TAU);
        Ok(Self { w: TAU / (period as f64 * STEP_S), k_a: a.hypot(b) / c.hypot(d), phase_lag_rad })
    }
}
