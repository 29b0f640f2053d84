use thermal_thesis::published::{PublishedPair, discrimination, localisation};

use super::condition::{DEVICE_SEED, material};
use super::*;
use crate::ObserverParams;
use crate::device::PreparedDevice;
use crate::falls::Exploration;

/// The observer's parameters are those that the fit finds, and both tables are reproduced within their tolerances.
#[test]
fn the_observer_of_touch_is_the_fitted_one() {
    let falls = falls_of_chapter_3().expect("falls");
    let two_hands = table_3_3(&falls);
    let [high_low, low_high] = table_3_5(&falls);
    let all: Vec<Cell> =
        (two_hands.iter().chain(&high_low).chain(&low_high)).map(|(_, cell)| *cell).collect();
    let fitted = fit(&all, true).expect("the search ends");
    let touch = ObserverParams::TOUCH;
    for (name, found, constant, tolerance) in [
        ("s0", fitted.s0_k, touch.s0_k, 0.005),
        ("w", fitted.w, touch.w, 0.0005),
        ("three fingers", fitted.three_finger_factor, touch.three_finger_factor, 0.005),
        ("lapse", fitted.lapse, touch.lapse, 0.0005),
    ] {
        assert!((found - constant).abs() <= tolerance, "{name}: fitted {found}, used {constant}");
    }
    let three_fingers: [&[(String, Cell)]; 2] = [&high_low, &low_high];
    for table in [
        table("Table 3-3", Basis::Fitted, &fitted, &[&two_hands], check_table_3_3),
        table("Table 3-5", Basis::Fitted, &fitted, &three_fingers, check_table_3_5),
    ] {
        assert!(table.checks.iter().all(|check| check.met), "{table}");
    }
}

#[test]
fn published_means_are_those_of_the_text() {
    let mean_of = |pairs: Vec<PublishedPair>| mean(pairs.iter().map(|pair| pair.percent));
    let [mean_3_3, mean_3_5] = [discrimination(), localisation()].map(mean_of);
    assert_eq!(mean_3_3.round(), 90.0);
    assert_eq!(mean_3_5.round(), 57.0);
}

#[test]
fn the_display_of_this_device_is_nearer_to_a_sample_that_is_touched_once() {
    let setup = Condition { lifts: false, ..Condition::of_thesis(SECTION_4_3_C) }.setup();
    let device =
        PreparedDevice::new(&setup.params, setup.room_c, DEVICE_SEED, 1).expect("a device");
    let exploration = Exploration::new(&setup, 0);
    let real_k =
        exploration.on_sample(&setup, material("granite").expect("known")).expect("a fall");
    let [thesis_k, ours_k] = DisplayMode::ALL.map(|mode| {
        let simulated_k = exploration.on_display(&setup, &device, mode.setting(), "granite");
        (simulated_k.expect("a fall") - real_k).abs()
    });
    assert!(thesis_k > 0.2, "{thesis_k} K");
    assert!(ours_k < 0.05, "{ours_k} K");
}
