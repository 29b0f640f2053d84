//! How a plant answers its current, found from the plant alone: no device, no sensor, no noise.
//!
//! Its bridge is driven with a sine, and the fundamentals of the plate's surface and of the current that flows are
//! compared. Both are freed of drift first: half of what a signal differs from the mean of half a period before and
//! after leaves its fundamental as it is, and of a parabola only a constant.

use std::f64::consts::TAU;

use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::{ConfigError, STEP_S};

use super::Plants;

/// Duty around one half: about 1.5 A.
const DUTY: f64 = 0.08;
/// Periods that are left out at first, and that are compared.
const BEFORE: usize = 3;
const COMPARED: usize = 4;

/// The surface of a plate per current, at one frequency; a current that cools counts as positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// rad/s.
    pub w: f64,
    /// Amplitude of the surface per that of the current, K/A.
    pub k_a: f64,
    /// By how much its cooling trails the current, rad; a quarter turn for an integrator.
    pub behind_rad: f64,
}

impl Response {
    /// At about an angular frequency, rad/s, of which a half period is a whole number of steps.
    ///
    /// # Errors
    /// A value that the plant cannot take.
    pub fn of(plants: &Plants, w: f64) -> Result<Self, ConfigError> {
        let half = ((0.5 * TAU / (w * STEP_S)).round() as usize).max(2);
        let period = 2 * half;
        let mut world = plants.at_work()?;
        let (mut surface_c, mut current_a) = (Vec::new(), Vec::new());
        for step in 0..(BEFORE + COMPARED + 1) * period {
            let duty = DUTY * (TAU * step as f64 / period as f64).sin();
            world.step(BridgeOutputs {
                a: Leg::Duty(0.5 + duty),
                b: Leg::Duty(0.5 - duty),
                enabled: true,
            });
            surface_c.push(world.plant().display_c());
            current_a.push(world.plant().current_a());
        }
        let from = BEFORE * period;
        let fundamental = |signal: &[f64]| {
            let compared = from..from + COMPARED * period;
            compared.fold((0.0, 0.0), |(re, im), i| {
                let around = 0.5 * (signal[i - half] + signal[i + half]);
                let swing = 0.5 * (signal[i] - around);
                let angle = TAU * i as f64 / period as f64;
                (re + swing * angle.cos(), im - swing * angle.sin())
            })
        };
        let ((a, b), (c, d)) = (fundamental(&surface_c), fundamental(&current_a));
        let behind_rad = (d.atan2(c) - (-b).atan2(-a)).rem_euclid(TAU);
        Ok(Self {
            w: TAU / (period as f64 * STEP_S),
            k_a: a.hypot(b) / c.hypot(d),
            behind_rad,
        })
    }
}
