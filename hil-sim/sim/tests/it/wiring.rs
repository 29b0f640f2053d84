//! The comparator's ladder and the line that selects the side of its test.

use thermal_sim::board::Wiring;

/// Both taps by Kirchhoff's law, worked out by hand: 2.2077 V and 1.0087 V.
#[test]
fn the_taps_are_those_of_the_circuit() {
    let [cold_v, hot_v] = Wiring::NOMINAL.taps_v();
    assert!((cold_v - 2.2077).abs() < 1e-4, "{cold_v}");
    assert!((hot_v - 1.0087).abs() < 1e-4, "{hot_v}");
}

#[test]
fn a_pull_down_lies_beside_the_resistors_of_the_test_level() {
    let ohm = Wiring::NOMINAL.side_to_ground_ohm(0.0);
    // 4.7 k beside 6.34 k + 5 k.
    assert!((ohm - 3322.8).abs() < 0.1, "{ohm}");
    let missing = Wiring { side_ohm: f64::INFINITY, ..Wiring::NOMINAL };
    assert!((missing.side_to_ground_ohm(0.0) - 11_340.0).abs() < 0.1);
}
