//! Thermal dose.

use thermal_sim::dose::cem43_min;

/// Values from the definition; each degree above 43 deg C doubles the dose.
#[test]
fn doses_are_those_of_the_definition() {
    for (temperature_c, minutes, expected_min) in [
        (43.0, 10.0, 10.0),
        (44.0, 10.0, 20.0),
        (45.0, 10.0, 40.0),
        (51.0, 1.0, 256.0),
        (42.0, 10.0, 2.5),
        (39.0, 256.0, 1.0),
        (38.99, 1e4, 0.0),
        (10.0, 1e4, 0.0),
    ] {
        let steps = (minutes * 60.0) as usize;
        let dose_min = cem43_min(std::iter::repeat_n(temperature_c, steps), 1.0);
        assert!(
            (dose_min - expected_min).abs() < 1e-9 * (1.0 + expected_min),
            "{minutes} min at {temperature_c} C: {dose_min}"
        );
    }
}
