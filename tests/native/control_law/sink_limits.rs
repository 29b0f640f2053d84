//! The cooling current is limited by the temperature of the sink.

use contact_model::fixed_point::Celsius;
use thermal_display::settings::Settings;

use super::bench::ControlLoop;

/// Current of a controller whose target cannot be reached, A.
fn saturated_current_a(target_c: f64, display_c: f64, sink_c: f64) -> f64 {
    let mut control = ControlLoop::new(&Settings::default());
    control.step(target_c, (display_c, sink_c), 0.0)
}

/// All of 6 A up to 39.5 °C, none from 41.5 °C on, a straight line between: before the sink trips at 42 °C.
#[test]
fn the_cooling_limit_falls_linearly_to_zero_with_a_hot_sink() {
    for tenths in 150..=440 {
        let sink_c = 0.1 * f64::from(tenths);
        let allowed_a = 6.0 * ((41.5 - sink_c) / 2.0).clamp(0.0, 1.0);
        let current_a = saturated_current_a(20.0, 40.0, sink_c);
        assert!(
            (current_a - allowed_a).abs() < 1e-5,
            "{sink_c} C: {current_a} A, not {allowed_a} A"
        );
    }
}

/// A heating current cools the sink.
#[test]
fn the_heating_limit_does_not_depend_on_the_sink() {
    for tenths in 150..=440 {
        let current_a = saturated_current_a(40.0, 20.0, 0.1 * f64::from(tenths));
        assert!((current_a + 6.0).abs() < 1e-6, "{tenths}: {current_a} A");
    }
}

/// A sink reading far out of range neither reverses the current nor overflows.
#[test]
fn a_sink_beyond_41_5_c_allows_no_cooling_current() {
    for sink in [Celsius::lit("44"), Celsius::lit("300"), Celsius::MAX] {
        let current_a = saturated_current_a(20.0, 40.0, sink.to_num());
        assert!(current_a.abs() < 1e-9, "{sink}: {current_a} A");
    }
}
