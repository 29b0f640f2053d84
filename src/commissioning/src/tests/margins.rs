//! Margins against a published loop, and against a sweep of the loop's complex gain.

use core::f64::consts::PI;

use proptest::prelude::*;

use crate::Margins;
use thermal_settings::{Gains, Tile};

/// Skogestad 2003, table 1: SIMC with `tauc = theta` on an integrator behind a dead time has a gain margin of 2.96 and
/// a phase margin of 46.9 degrees.
#[test]
fn simc_on_an_integrator_has_its_published_margins() {
    let tile = Tile {
        gain_k_s_a: 2.0,
        joule_per_a: 0.0,
        leak_1_s: 0.0,
        sensor_lag_s: 0.0,
        dead_time_s: 0.1,
    };
    let Margins { phase_deg, gain } = Margins::of(&tile, &Gains::simc(&tile, 0.0));
    assert!((gain - 2.96).abs() < 0.005, "{gain}");
    assert!((phase_deg - 46.9).abs() < 0.05, "{phase_deg}");
}

type Complex = (f64, f64);

fn times((a, b): Complex, (c, d): Complex) -> Complex {
    (a * c - b * d, a * d + b * c)
}

fn over(a: Complex, (c, d): Complex) -> Complex {
    let square = c * c + d * d;
    times(a, (c / square, -d / square))
}

/// The loop's complex gain at `s = jw`, by its transfer function.
fn loop_gain(tile: &Tile, gains: &Gains, w: f64) -> Complex {
    let law = (
        gains.proportional_a_k,
        -gains.proportional_a_k / (gains.integral_s * w),
    );
    let plate = over((tile.gain_k_s_a, 0.0), (tile.leak_1_s, w));
    let sensor = over((1.0, 0.0), (1.0, tile.sensor_lag_s * w));
    let dead = ((tile.dead_time_s * w).cos(), -(tile.dead_time_s * w).sin());
    times(times(law, plate), times(sensor, dead))
}

/// Phase margin where the magnitude passes one, and gain margin where the curve crosses the negative real axis.
fn swept(tile: &Tile, gains: &Gains) -> (f64, Option<f64>) {
    let (mut phase, mut margin) = (f64::NAN, None);
    let mut before = loop_gain(tile, gains, 1e-6);
    let mut w = 1e-6;
    // From the loop's integral time on the curve comes from below: the crossing is upwards through the negative axis.
    while w < PI * 1000.0 {
        w *= 1.000_1;
        let (re, im) = loop_gain(tile, gains, w);
        if before.0.hypot(before.1) > 1.0 && re.hypot(im) <= 1.0 {
            phase = (180.0 + im.atan2(re).to_degrees()).rem_euclid(360.0);
        }
        if before.1 < 0.0 && im >= 0.0 && re < 0.0 && margin.is_none() && w > 1.0 / gains.integral_s
        {
            margin = Some(-1.0 / re);
        }
        before = (re, im);
    }
    (phase, margin)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    /// Any tile of settings.
    #[test]
    fn margins_are_those_of_a_sweep(
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
        let [gains, _] = Gains::of_tile(&tile);
        let found = Margins::of(&tile, &gains);
        let (phase_deg, margin) = swept(&tile, &gains);
        prop_assert!((found.phase_deg - phase_deg).abs() < 0.05, "{found:?}, {phase_deg}");
        let margin = margin.unwrap_or(f64::NAN);
        prop_assert!((found.gain / margin - 1.0).abs() < 1e-3, "{found:?}, {margin}");
    }
}
