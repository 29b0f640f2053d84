//! Thresholds against independently computed thermistor ratios; the latch against its truth table.

use super::*;
use crate::sensors::BONDED;

/// Divider ratios of a 10 kohm thermistor (beta 3950 K) under 10 kohm at 9.9, 10.1, 44.9 and 45.1 deg C.
const COLD: (f64, f64) = (0.669_686, 0.667_503);
const HOT: (f64, f64) = (0.303_871, 0.302_222);
const INSIDE: f64 = 0.5;
const STEP_S: f64 = 1e-3;

/// With a cleared latch.
fn comparator() -> Comparator {
    let mut comparator = Comparator::new(&ComparatorParams::NOMINAL, &BONDED, INSIDE);
    comparator.clear();
    comparator
}

fn after(ratio: f64) -> bool {
    let mut comparator = comparator();
    comparator.step(STEP_S, ratio);
    comparator.tripped()
}

#[test]
fn window_is_from_10_to_45_c_and_broken_wires_are_outside() {
    assert_eq!([COLD.0, COLD.1, HOT.0, HOT.1].map(after), [true, false, false, true]);
    assert_eq!([0.0, INSIDE, 1.0].map(after), [true, false, true]);
}

#[test]
fn thresholds_follow_the_parameters_and_a_wrong_ladder() {
    let params = ComparatorParams { cold_c: 9.8, hot_c: 45.2, ..ComparatorParams::NOMINAL };
    for (ratio, shift_k, trips) in
        [(COLD.0, 0.0, false), (HOT.1, 0.0, false), (COLD.0, 0.2, true), (HOT.1, -0.2, true)]
    {
        let mut comparator = Comparator::new(&params, &BONDED, INSIDE);
        comparator.clear();
        comparator.set_defects(&ComparatorDefects {
            ladder_shift_k: shift_k,
            ..ComparatorDefects::default()
        });
        comparator.step(STEP_S, ratio);
        assert_eq!(comparator.tripped(), trips, "{ratio} {shift_k}");
    }
}

/// A change at the inputs.
#[derive(Clone, Copy, Debug)]
enum Event {
    /// A step with the thermistor inside or outside.
    Inside,
    Outside,
    /// A change of the test.
    Hot,
    Cold,
    End,
    /// As many steps inside as the release takes, rounded up.
    Release,
}
use Event::{Cold, End, Hot, Inside, Outside, Release};

#[test]
fn latch_has_its_truth_table() {
    let rows: [&[(Event, bool)]; 7] = [
        // No test; nothing changes.
        &[(Inside, false), (End, false), (Release, false)],
        // An excursion from the window stays latched.
        &[(Outside, true), (Inside, true), (Release, true)],
        // Tests of both sides: set at once, cleared some time after their ends.
        &[
            (Hot, true),
            (Inside, true),
            (End, true),
            (Inside, true),
            (Release, false),
            (Cold, true),
            (Release, true),
            (End, true),
            (Release, false),
        ],
        // Only the end of a test clears.
        &[(Outside, true), (Cold, true), (End, true), (Release, false)],
        // It does not clear outside of the window.
        &[
            (Hot, true),
            (End, true),
            (Outside, true),
            (Outside, true),
            (Outside, true),
            (Outside, true),
            (Outside, true),
            (Inside, true),
            (Release, true),
        ],
        // An excursion during a test that ends before the test does is cleared.
        &[(Hot, true), (Outside, true), (Inside, true), (End, true), (Release, false)],
        // A test that begins before the latch is cleared keeps it set.
        &[(Hot, true), (End, true), (Cold, true), (Release, true)],
    ];
    for row in rows {
        let mut comparator = comparator();
        for (event, expected) in row {
            match event {
                Inside => comparator.step(STEP_S, INSIDE),
                Outside => comparator.step(STEP_S, HOT.1),
                Hot => comparator.set_test(ComparatorTest::Hot),
                Cold => comparator.set_test(ComparatorTest::Cold),
                End => comparator.set_test(ComparatorTest::None),
                Release => (0..5).for_each(|_| comparator.step(STEP_S, INSIDE)),
            }
            assert_eq!(comparator.tripped(), *expected, "{event:?} of {row:?}");
        }
    }
}

#[test]
fn latch_is_set_at_power_on() {
    assert!(Comparator::new(&ComparatorParams::NOMINAL, &BONDED, INSIDE).tripped());
}

#[test]
fn a_dead_side_and_a_wrong_ladder_show_in_their_tests_only() {
    let sound = ComparatorDefects::default();
    for (defects, hot, cold) in [
        (sound, true, true),
        (ComparatorDefects { hot_dead: true, ..sound }, false, true),
        (ComparatorDefects { cold_dead: true, ..sound }, true, false),
        (ComparatorDefects { ladder_shift_k: 4.0, ..sound }, false, true),
        (ComparatorDefects { ladder_shift_k: -6.0, ..sound }, true, false),
    ] {
        let shows = |test| {
            let mut comparator = comparator();
            comparator.set_defects(&defects);
            comparator.set_test(test);
            comparator.tripped()
        };
        assert_eq!(
            [ComparatorTest::Hot, ComparatorTest::Cold].map(shows),
            [hot, cold],
            "{defects:?}"
        );
    }
}

#[test]
fn a_defect_of_the_latch_forces_the_output_and_preserves_the_state() {
    let mut comparator = comparator();
    let stuck = |latch| ComparatorDefects { latch, ..ComparatorDefects::default() };
    comparator.set_defects(&stuck(LatchDefect::StuckClear));
    comparator.set_test(ComparatorTest::Hot);
    assert!(!comparator.tripped());
    comparator.set_test(ComparatorTest::None);
    comparator.set_defects(&stuck(LatchDefect::StuckSet));
    comparator.clear();
    assert!(comparator.tripped());
    comparator.set_defects(&stuck(LatchDefect::None));
    assert!(!comparator.tripped());
}
