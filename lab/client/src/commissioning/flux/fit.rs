//! Fit of a heat-flux sensor to a phantom that the display has warmed and cooled.
//!
//! The phantom is a half-space of effusivity `e`, at `T_p` before. A flux `q` out of it into the display lowers its surface by the
//! half-integral of `q` over `e`, and the contact takes `R q`. The sensor reads `m = g q + z`. So the surface of the display is
//!
//! ```text
//! T = T_p - (I m - z I 1) / (e g) - (m - z) R / g        I x = 1 / sqrt(pi) times the integral of x(s) / sqrt(t - s)
//! ```
//!
//! which is linear in `1 / (e g)`, `R / g`, the zero and the temperature. It is fitted where the display rests, because it is
//! known there best; so the sensor's lag does not matter.

use thermal_commissioning::solve_by_cholesky;

/// Interval of the samples, s.
pub const STEP_S: f64 = 0.01;
/// Unknowns: `T_p + z R / g`, `1 / (e g)`, `R / g`, and the zero over `e g`.
const UNKNOWNS: usize = 4;
/// Time over which the residuals are alike, s: what the model leaves is slow, not noise.
const CORRELATION_S: f64 = 1.0;
/// Gamma function of 5 / 2.
const GAMMA_5_2: f64 = 1.329_340_388_179_137;

/// A reading of the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Flux by the sensor as it is set, W/m².
    pub flux_w_m2: f64,
    /// The display's surface, °C.
    pub surface_c: f64,
}

/// What was fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Temperature of the phantom before, °C.
    pub phantom_c: f64,
    /// Gain over the one that is set, and its standard deviation by the residuals.
    pub gain: (f64, f64),
    /// Resistance between phantom and display, the sensor's layer included, m² K/W.
    pub resistance_m2k_w: f64,
    /// RMS of the residuals, K.
    pub residual_k: f64,
}

impl Fit {
    /// Fits the samples with these numbers to a phantom of this effusivity, W s½/(m² K). The first sample is before the phantom was
    /// put on. `None` if they do not determine the unknowns, as without a flux.
    pub fn new(samples: &[Sample], fitted: &[usize], effusivity: f64) -> Option<Self> {
        let flux: Vec<f64> = samples.iter().map(|sample| sample.flux_w_m2).collect();
        let (integrated, of_one) = (half_integral(&flux), half_integral(&vec![1.0; flux.len()]));
        let rows = fitted.iter().map(|&n| {
            let row = [1.0, -integrated[n], -flux[n], of_one[n]];
            (row, samples[n].surface_c)
        });
        let solution = Solution::of(&rows.collect::<Vec<_>>())?;
        // What the zero makes of the contact is a millikelvin.
        let [phantom_c, by_flux, by_contact, _] = solution.values;
        let [_, by_flux_error, ..] = solution.deviations;
        let gain = 1.0 / (effusivity * by_flux);
        Some(Self {
            phantom_c,
            gain: (gain, (gain * by_flux_error / by_flux).abs()),
            resistance_m2k_w: by_contact * gain,
            residual_k: solution.residual,
        })
    }
}

/// Least squares.
struct Solution {
    values: [f64; UNKNOWNS],
    deviations: [f64; UNKNOWNS],
    residual: f64,
}

impl Solution {
    fn of(rows: &[([f64; UNKNOWNS], f64)]) -> Option<Self> {
        // Unit columns, as the unknowns differ by six orders of magnitude.
        let mut scale = [0.0; UNKNOWNS];
        for (row, _) in rows {
            for (scale, value) in scale.iter_mut().zip(row) {
                *scale += value * value;
            }
        }
        let scale = scale.map(f64::sqrt);
        let (mut matrix, mut right) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
        for (row, value) in rows {
            for i in 0..UNKNOWNS {
                right[i] += row[i] / scale[i] * value;
                for j in 0..UNKNOWNS {
                    matrix[i][j] += row[i] / scale[i] * row[j] / scale[j];
                }
            }
        }
        solve_by_cholesky(&mut matrix.clone(), &mut right)?;
        let values: [f64; UNKNOWNS] = std::array::from_fn(|i| right[i] / scale[i]);
        let squares = rows.iter().map(|(row, value)| {
            let fitted: f64 = row.iter().zip(values).map(|(a, b)| a * b).sum();
            (value - fitted).powi(2)
        });
        let residual = (squares.sum::<f64>() / rows.len() as f64).sqrt();
        let alike = (CORRELATION_S / STEP_S).sqrt();
        let mut deviations = [0.0; UNKNOWNS];
        for (i, deviation) in deviations.iter_mut().enumerate() {
            let mut unit = [0.0; UNKNOWNS];
            unit[i] = 1.0;
            solve_by_cholesky(&mut matrix.clone(), &mut unit)?;
            *deviation = residual * alike * unit[i].sqrt() / scale[i];
        }
        Some(Self { values, deviations, residual })
    }
}

/// Integral of the signal from the first sample on over `sqrt(pi (t - s))`: exact for straight lines between samples.
fn half_integral(signal: &[f64]) -> Vec<f64> {
    let power = |n: usize| (n as f64).powi(3).sqrt();
    let weights: Vec<f64> =
        (1..signal.len().max(1)).map(|k| power(k + 1) - 2.0 * power(k) + power(k - 1)).collect();
    let unit = STEP_S.sqrt() / GAMMA_5_2;
    let at = |n: usize| {
        let Some(last) = n.checked_sub(1) else {
            return 0.0;
        };
        let first = (power(last) - (last as f64 - 0.5) * (n as f64).sqrt()) * signal[0];
        let middle = signal[1..n].iter().rev().zip(&weights);
        let middle: f64 = middle.map(|(value, weight)| value * weight).sum();
        unit * (first + middle + signal[n])
    };
    (0..signal.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Fluxes of `sqrt(t - t_i)`, whose half-integral is `sqrt(pi) / 2 (t - t_i)`.
    const RAMPS: [(f64, f64); 4] = [(1.0, 3000.0), (2.0, -6000.0), (6.0, -2500.0), (8.0, 8000.0)];

    fn sum_of(t_s: f64, of: impl Fn(f64) -> f64) -> f64 {
        let ramps = RAMPS.iter().filter(|(from_s, _)| t_s > *from_s);
        ramps.map(|(from_s, size)| size * of(t_s - from_s)).sum()
    }

    #[test]
    fn half_integral_of_a_step_and_of_a_square_root_are_the_known_ones() {
        let t_s = |n: usize| n as f64 * STEP_S;
        let of_one = half_integral(&[1.0; 1000]);
        let root: Vec<f64> = (0..1000).map(|n| t_s(n).sqrt()).collect();
        let of_root = half_integral(&root);
        for n in [0, 1, 2, 10, 999] {
            assert!((of_one[n] - 2.0 * (t_s(n) / PI).sqrt()).abs() < 1e-12, "{n}");
        }
        // The first interval's line is not the root.
        for n in [100, 999] {
            assert!((of_root[n] / (0.5 * PI.sqrt() * t_s(n)) - 1.0).abs() < 1e-3, "{n}");
        }
    }

    #[test]
    fn gain_and_contact_of_an_exact_half_space_are_found() {
        let (effusivity, resistance, phantom_c) = (1585.0, 8e-5, 23.7);
        for (gain, zero_w_m2) in [(1.0, 0.0), (0.8, 12.0), (1.3, -20.0)] {
            let sample = |n: usize| {
                let t_s = STEP_S * n as f64;
                let flux = sum_of(t_s, f64::sqrt);
                let fall_k = sum_of(t_s, |since_s| 0.5 * PI.sqrt() * since_s) / effusivity;
                Sample {
                    flux_w_m2: gain * flux + zero_w_m2,
                    surface_c: phantom_c - fall_k - resistance * flux,
                }
            };
            let samples: Vec<_> = (0..1200).map(sample).collect();
            let fitted: Vec<_> = (50..1200).collect();
            let fit = Fit::new(&samples, &fitted, effusivity).expect("a solution");
            assert!((fit.gain.0 / gain - 1.0).abs() < 2e-4, "{fit:?}");
            assert!((fit.phantom_c - phantom_c).abs() < 3e-3, "{fit:?}");
            assert!((fit.resistance_m2k_w / resistance - 1.0).abs() < 3e-3, "{fit:?}");
            assert!(fit.residual_k < 1e-3, "{fit:?}");
        }
    }

    #[test]
    fn a_sensor_without_a_signal_has_no_fit() {
        let samples: Vec<_> = (0..1000)
            .map(|n| Sample { flux_w_m2: 0.0, surface_c: 24.0 + 1e-3 * f64::from(n) })
            .collect();
        assert_eq!(Fit::new(&samples, &[10, 100, 500, 900, 999], 1585.0), None);
    }
}
