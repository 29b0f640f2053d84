//! The limits follow the sink.

use contact_model::fixed_point::Celsius;
use thermal_display::control::Control;
use thermal_display::settings::Settings;

use crate::bench::step;

/// Current of a law that wants more than there is.
fn wanting(target_c: f64, display_c: f64, sink_c: f64) -> f64 {
    let mut control = Control::new(&Settings::default());
    step(&mut control, target_c, (display_c, sink_c), 0.0)
}

/// All of 6 A up to 39.5 °C, none from 41.5 °C on, a straight line between: before the sink trips at 42 °C.
#[test]
fn cooling_tapers_with_a_hot_sink() {
    for tenths in 150..=440 {
        let sink_c = 0.1 * f64::from(tenths);
        let allowed_a = 6.0 * ((41.5 - sink_c) / 2.0).clamp(0.0, 1.0);
        let current_a = wanting(20.0, 40.0, sink_c);
        assert!(
            (current_a - allowed_a).abs() < 1e-5,
            "{sink_c} C: {current_a} A, not {allowed_a} A"
        );
    }
}

/// A current that warms the display cools the sink.
#[test]
fn heating_does_not() {
    for tenths in 150..=440 {
        let current_a = wanting(40.0, 20.0, 0.1 * f64::from(tenths));
        assert!((current_a + 6.0).abs() < 1e-6, "{tenths}: {current_a} A");
    }
}

/// No sink, however hot, turns cooling into heating or overflows.
#[test]
fn a_sink_beyond_all_sense_allows_nothing() {
    for sink in [Celsius::lit("44"), Celsius::lit("300"), Celsius::MAX] {
        let current_a = wanting(20.0, 40.0, sink.to_num());
        assert!(current_a.abs() < 1e-9, "{sink}: {current_a} A");
    }
}
