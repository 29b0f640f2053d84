//! A device that was switched off, and gets its settings back.

use thermal_sim::commissioning::{CommissionError, restore, settings_for_device};
use thermal_sim::engine::NativeEngine;

use super::{ROOM_C, bench, device, mean, wait};

#[test]
fn a_device_reads_and_controls_as_before_by_its_lines() {
    let plants = device(Some(4), 4);
    let settings = settings_for_device(plants.params(), ROOM_C, 4).expect("settings");
    let mut engine = NativeEngine::new(plants.in_use().expect("a plant"));
    let tile = restore(&mut engine, &settings).expect("restored");
    let words: Vec<f64> = (settings.last().expect("a tile").split(' '))
        .filter_map(|word| word.parse().ok())
        .collect();
    let has = [tile.gain_k_s_a, tile.joule_per_a, tile.leak_1_s, tile.lag_s, tile.dead_s];
    for (has, set) in has.into_iter().zip(&words) {
        assert!((has - set).abs() < 1e-4, "{has}, {set}");
    }
    assert_eq!(words.len(), 5);
    // Sensors of this draw are off by 0.2 K, and right after the lines.
    let mut bench = bench(&mut engine, &[]);
    wait(&mut bench, 500);
    let (read, truth) =
        mean(&mut bench, |line| line.display_c, 250, |world| world.plant().display_c());
    assert!((read - truth).abs() < 5e-3, "{read}, {truth}");
}

#[test]
fn lines_that_the_device_does_not_take_or_keep_are_named() {
    let plants = device(None, 1);
    let mut engine = NativeEngine::new(plants.in_use().expect("a plant"));
    let mut with =
        |line: &str| restore(&mut engine, &[line.to_owned()]).expect_err("no device has it");
    let refused = with("set correction display 9 0 0");
    assert_eq!(
        refused.to_string(),
        "commissioning: the device answers 'set correction display 9 0 0' with 'err offset '9' out of range; -1.2 to 1.2 K'"
    );
    // Taken, but not as a line of settings has it.
    assert_eq!(
        with("set correction display 1 0 0"),
        CommissionError::NotRestored("set correction display 1 0 0".into())
    );
}
