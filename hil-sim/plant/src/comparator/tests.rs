//! Thresholds against independently computed thermistor ratios; the latch against its truth table.

use super::*;
use crate::sensors::BONDED;

/// Divider ratios of a 10 kohm thermistor (beta 3950 K) under 10 kohm at 9.9, 10.1, 44.9 and 45.1 deg C.
const COLD: (f64, f64) = (0.669_686, 0.667_503);
const HOT: (f64, f64) = (0.303_871, 0.302_222);
const INSIDE: f64 = 0.5;

fn comparator() -> Comparator {
    Comparator::new(&ComparatorParams::NOMINAL, &BONDED, INSIDE)
}

fn after(ratio: f64) -> bool {
    let mut comparator = comparator();
    comparator.set_input(ratio);
    comparator.tripped()
}

#[test]
fn window_is_from_10_to_45_c_and_broken_wires_are_outside() {
    assert_eq!(
        [COLD.0, COLD.1, HOT.0, HOT.1].map(after),
        [true, false, false, true]
    );
    assert_eq!([0.0, INSIDE, 1.0].map(after), [true, false, true]);
}

#[test]
fn thresholds_follow_the_parameters() {
    let params = ComparatorParams {
        cold_c: 9.8,
        hot_c: 45.2,
    };
    for ratio in [COLD.0, HOT.1] {
        let mut comparator = Comparator::new(&params, &BONDED, INSIDE);
        comparator.set_input(ratio);
        assert!(!comparator.tripped(), "{ratio}");
    }
}

/// A change at the inputs.
#[derive(Clone, Copy, Debug)]
enum Event {
    Inside,
    Outside,
    High,
    Low,
}
use Event::{High, Inside, Low, Outside};

#[test]
fn latch_has_its_truth_table() {
    let rows: [&[(Event, bool)]; 7] = [
        // Cleared at power-on; a test line that stays low changes nothing.
        &[(Inside, false), (Low, false)],
        // An excursion from the window stays latched.
        &[(Outside, true), (Inside, true)],
        // A test: set while high, cleared by the edge.
        &[(High, true), (Inside, true), (High, true), (Low, false)],
        // Only the falling edge clears.
        &[
            (Outside, true),
            (Inside, true),
            (Low, true),
            (High, true),
            (Low, false),
        ],
        // The falling edge does not clear outside of the window.
        &[
            (Outside, true),
            (High, true),
            (Low, true),
            (Inside, true),
            (Low, true),
        ],
        // An excursion during a test that ends before the test does is cleared.
        &[(High, true), (Outside, true), (Inside, true), (Low, false)],
        // It works again after a test.
        &[(High, true), (Low, false), (Outside, true), (Inside, true)],
    ];
    for row in rows {
        let mut comparator = comparator();
        for (event, expected) in row {
            match event {
                Inside => comparator.set_input(INSIDE),
                Outside => comparator.set_input(HOT.1),
                High => comparator.set_test_line(true),
                Low => comparator.set_test_line(false),
            }
            assert_eq!(comparator.tripped(), *expected, "{event:?} of {row:?}");
        }
    }
}

#[test]
fn latch_is_set_at_power_on_outside_of_the_window() {
    assert!(Comparator::new(&ComparatorParams::NOMINAL, &BONDED, COLD.0).tripped());
}

#[test]
fn a_defect_forces_the_output_and_preserves_the_latch() {
    let mut comparator = comparator();
    comparator.set_defect(ComparatorDefect::NeverTrips);
    comparator.set_test_line(true);
    assert!(!comparator.tripped());
    comparator.set_test_line(false);
    comparator.set_defect(ComparatorDefect::AlwaysTripped);
    comparator.set_test_line(true);
    comparator.set_test_line(false);
    assert!(comparator.tripped());
    comparator.set_defect(ComparatorDefect::None);
    assert!(!comparator.tripped());
    comparator.set_input(HOT.1);
    comparator.set_defect(ComparatorDefect::NeverTrips);
    assert!(!comparator.tripped());
}
