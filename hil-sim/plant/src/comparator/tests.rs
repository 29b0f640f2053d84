//! Thresholds against the thermistor's equation, worked out apart; the latch against its truth table.

use super::*;
use crate::sensors::BONDED;

/// Divider's ratios of 10 k and beta 3950 K over 10 k at 9.9, 10.1, 44.9 and 45.1 deg C.
const COLD: (f64, f64) = (0.669_686, 0.667_503);
const HOT: (f64, f64) = (0.303_871, 0.302_222);
const INSIDE: f64 = 0.5;

fn comparator() -> Comparator {
    Comparator::new(&ComparatorParams::NOMINAL, &BONDED, INSIDE)
}

fn after(ratio: f64) -> bool {
    let mut comparator = comparator();
    comparator.watch(ratio);
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
fn thresholds_are_those_of_its_resistors() {
    let params = ComparatorParams {
        cold_c: 9.8,
        hot_c: 45.2,
    };
    for ratio in [COLD.0, HOT.1] {
        let mut comparator = Comparator::new(&params, &BONDED, INSIDE);
        comparator.watch(ratio);
        assert!(!comparator.tripped(), "{ratio}");
    }
}

/// What happens to it, and whether the latch is set then.
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
        // Power-on has cleared it; a low line that stays low changes nothing.
        &[(Inside, false), (Low, false)],
        // What has left the window stays known when it is back.
        &[(Outside, true), (Inside, true)],
        // A test: set while high, cleared by the edge.
        &[(High, true), (Inside, true), (High, true), (Low, false)],
        // Only the edge clears.
        &[
            (Outside, true),
            (Inside, true),
            (Low, true),
            (High, true),
            (Low, false),
        ],
        // Not outside of the window.
        &[
            (Outside, true),
            (High, true),
            (Low, true),
            (Inside, true),
            (Low, true),
        ],
        // What leaves the window during a test, and is back before its end, is forgotten.
        &[(High, true), (Outside, true), (Inside, true), (Low, false)],
        // It works again after a test.
        &[(High, true), (Low, false), (Outside, true), (Inside, true)],
    ];
    for row in rows {
        let mut comparator = comparator();
        for (event, expected) in row {
            match event {
                Inside => comparator.watch(INSIDE),
                Outside => comparator.watch(HOT.1),
                High => comparator.test(true),
                Low => comparator.test(false),
            }
            assert_eq!(comparator.tripped(), *expected, "{event:?} of {row:?}");
        }
    }
}

#[test]
fn powered_on_outside_of_the_window_it_is_set() {
    assert!(Comparator::new(&ComparatorParams::NOMINAL, &BONDED, COLD.0).tripped());
}

#[test]
fn defects_hold_the_latch_and_leave_it_when_they_pass() {
    let mut comparator = comparator();
    comparator.set_defect(ComparatorDefect::Dead);
    comparator.test(true);
    assert!(!comparator.tripped());
    comparator.test(false);
    comparator.set_defect(ComparatorDefect::Stuck);
    comparator.test(true);
    comparator.test(false);
    assert!(comparator.tripped());
    comparator.set_defect(ComparatorDefect::Sound);
    assert!(!comparator.tripped());
    comparator.watch(HOT.1);
    comparator.set_defect(ComparatorDefect::Dead);
    assert!(!comparator.tripped());
}
