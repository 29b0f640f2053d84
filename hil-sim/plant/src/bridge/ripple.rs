//! Ripple of the tile current behind the LC filter.
//!
//! In periodic steady state the voltage across the legs is a pulse train. Each harmonic passes the linear filter
//! independently, and the mean squares of orthogonal harmonics add:
//!
//! ```text
//! v(t) = V (w + sum over n of 2 sin(pi n w)/(pi n) cos(2 pi n t/T))       pulses of width w T
//! ripple_a2 = sum over n of (V 2 sin(pi n w)/(pi n) |Y(n)|)^2 / 2
//! ```
//!
//! with the transfer admittance `Y = Zp/(Zs + Zp)/R` from the legs to the tile current, series branch `Zs = r + j w L`,
//! parallel branch `Zp` of the tile and `1/(j w C) + ESR`.

use std::f64::consts::PI;

use super::BridgeParams;

/// Intervals of the table over duty cycles from 0 to 1/2.
const PARTS: usize = 64;
/// The series ends at the harmonic whose power is below this fraction of the first one's.
const NEGLIGIBLE: f64 = 1e-9;
/// Largest number of harmonics; without a filter their power falls only with the square of their number.
const MAX_HARMONICS: usize = 4096;

/// Mean square of the ripple of the tile voltage over the duty cycle, as a fraction of the square of the supply. A table for one tile resistance serves others near
/// it, since the capacitor takes most of the ripple: a change of 20 % in resistance changes the ripple by 1 %.
#[derive(Clone, Debug)]
pub struct Ripple {
    /// Mean square divided by `w (1 - w)`, at equal steps of the duty cycle `w` from 0 to 1/2, per V^2. The quotient is
    /// smooth with a filter and constant without.
    shape: [f64; PARTS + 1],
}

impl Ripple {
    /// The table for a bridge and a tile of about this resistance, ohm.
    pub fn new(params: &BridgeParams, load_ohm: f64) -> Self {
        let power = harmonics(params, load_ohm);
        let mut shape = std::array::from_fn(|part| {
            let width = part as f64 / (2 * PARTS) as f64;
            mean_square(&power, width) / (width * (1.0 - width))
        });
        // At zero duty cycle the quotient is 0/0: linear extrapolation.
        shape[0] = (2.0 * shape[1] - shape[2]).max(0.0);
        Self { shape }
    }

    /// Mean square of the ripple of the tile voltage, per V^2 of the supply, at a duty cycle of 0 to 1.
    pub fn mean_square(&self, width: f64) -> f64 {
        let narrow = width.min(1.0 - width).max(0.0);
        let position = narrow * (2 * PARTS) as f64;
        let part = (position as usize).min(PARTS - 1);
        let (low, high) = (self.shape[part], self.shape[part + 1]);
        narrow * (1.0 - narrow) * (low + (high - low) * (position - part as f64))
    }
}

/// Mean square of each harmonic of the tile voltage, per V^2 of the supply, for `sin^2 = 1`.
fn harmonics(params: &BridgeParams, load_ohm: f64) -> Vec<f64> {
    let mut power: Vec<f64> = Vec::new();
    for n in 1..=MAX_HARMONICS {
        let pulse = 2.0 / (PI * n as f64);
        let omega = 2.0 * PI * n as f64 * params.pwm_hz;
        power.push(pulse * pulse * power_gain(params, load_ohm, omega) / 2.0);
        if power[n - 1] < NEGLIGIBLE * power[0] {
            break;
        }
    }
    power
}

/// Power gain of the filter, from the legs to the tile, at an angular frequency, rad/s.
fn power_gain(params: &BridgeParams, load_ohm: f64, omega: f64) -> f64 {
    // Admittance of the parallel branch, Y = 1/R + jwC/(1 + jwC ESR); the ratio is 1/(1 + Zs Y).
    let susceptance = omega * params.filter_f;
    let esr_part = susceptance * params.filter_esr_ohm;
    let scale = 1.0 / (1.0 + esr_part * esr_part);
    let (g, b) = (1.0 / load_ohm + susceptance * esr_part * scale, susceptance * scale);
    let (r, x) = (params.on_ohm + params.filter_ohm, omega * params.filter_h);
    let (re, im) = (1.0 + r * g - x * b, r * b + x * g);
    1.0 / (re * re + im * im)
}

/// Mean square of all harmonics at a duty cycle.
fn mean_square(power: &[f64], width: f64) -> f64 {
    let sines = (1..).map(|n| (PI * f64::from(n) * width).sin().powi(2));
    power.iter().zip(sines).map(|(power, sine)| power * sine).sum()
}
