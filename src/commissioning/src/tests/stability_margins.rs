//! Stability margins against a published loop, and against a frequency sweep of the open loop.

use core::f64::consts::PI;

use proptest::prelude::*;

use crate::StabilityMargins;
use thermal_settings::{PiGains, Tile};

/// Skogestad 2003, table 1: SIMC with `tauc = theta` on an integrator behind a dead time has a gain margin of 2.96 and
/// a phase margin of 46.9 degrees.
#[test]
fn simc_on_an_integrator_has_the_published_margins() {
    let tile = Tile {
        gain_k_s_a: 2.0,
        joule_per_a: 0.0,
        leak_1_s: 0.0,
        sensor_lag_s: 0.0,
        dead_time_s: 0.1,
    };
    let StabilityMargins { phase_deg, gain } =
        StabilityMargins::new(&tile, &PiGains::simc_for_update_interval(&tile, 0.0));
    assert!((gain - 2.96).abs() < 0.005, "{gain}");
    assert!((phase_deg - 46.9).abs() < 0.05, "{phase_deg}");
}

type Complex = (f64, f64);

fn product((a, b): Complex, (c, d): Complex) -> Complex {
    (a * c - b * d, a * d + b * c)
}

fn quotient(a: Complex, (c, d): Complex) -> Complex {
    let square = c * c + d * d;
    product(a, (c / square, -d / square))
}

/// The complex gain of the open loop at `s = jw`, by its transfer function.
fn open_loop(tile: &Tile, gains: &PiGains, w: f64) -> Complex {
    let controller = (gains.proportional_a_k, -gains.proportional_a_k / (gains.integral_s * w));
    let plate = quotient((tile.gain_k_s_a, 0.0), (tile.leak_1_s, w));
    let sensor = quotient((1.0, 0.0), (1.0, tile.sensor_lag_s * w));
    let dead = ((tile.dead_time_s * w).cos(), -(tile.dead_time_s * w).sin());
    product(product(controller, plate), product(sensor, dead))
}

/// Margins by a sweep: the phase margin, degrees, where the magnitude passes one, and the gain margin where the locus
/// crosses the negative real axis.
fn margins_by_sweep(tile: &Tile, gains: &PiGains) -> (f64, Option<f64>) {
    let (mut phase, mut margin) = (f64::NAN, None);
    let mut previous = open_loop(tile, gains, 1e-6);
    let mut w = 1e-6;
    // Above 1 / Ti the locus starts below the negative real axis and crosses it upwards.
    while w < PI * 1000.0 {
        w *= 1.000_1;
        let (re, im) = open_loop(tile, gains, w);
        if previous.0.hypot(previous.1) > 1.0 && re.hypot(im) <= 1.0 {
            phase = (180.0 + im.atan2(re).to_degrees()).rem_euclid(360.0);
        }
        if previous.1 < 0.0
            && im >= 0.0
            && re < 0.0
            && margin.is_none()
            && w > 1.0 / gains.integral_s
        {
            margin = Some(-1.0 / re);
        }
        previous = (re, im);
    }
    (phase, margin)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    /// For any tile within its allowed ranges.
    #[test]
    fn margins_agree_with_a_frequency_sweep(
        gain in 0.1f64..50.0,
        leak in 0.0f64..5.0,
        lag in 0.001f64..5.0,
        dead in 0.002f64..1.0,
    ) {
        let tile = Tile {
            gain_k_s_a: gain,
            joule_per_a: 0.0,
            leak_1_s: leak,
            sensor_lag_s: lag,
            dead_time_s: dead,
        };
        let [gains, _] = PiGains::for_1khz_and_10hz_laws(&tile);
        let found = StabilityMargins::new(&tile, &gains);
        let (phase_deg, margin) = margins_by_sweep(&tile, &gains);
        prop_assert!((found.phase_deg - phase_deg).abs() < 0.05, "{found:?}, {phase_deg}");
        let margin = margin.unwrap_or(f64::NAN);
        prop_assert!((found.gain / margin - 1.0).abs() < 1e-3, "{found:?}, {margin}");
    }
}
