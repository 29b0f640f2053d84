//! Set-points, against the thesis's equations in `f64`.

use contact_model::material::{SKIN, find};
use contact_model::reference::{Contact, interface_temperature};

use super::{Bench, assert_close};
use crate::device::State;

/// Two ticks of force make a contact, which then is two ticks old.
const DETECTION_S: f64 = 2e-3;

/// Touches with `force_n` for `ticks` from the detected landing on, and compares with Eq. 6-12 on each.
#[track_caller]
pub(super) fn follows_a_contact(
    bench: &mut Bench,
    material: &str,
    object_c: f64,
    force_n: f64,
    ticks: u32,
) {
    bench.force_n = 0.0;
    let preset = bench.contact(material, object_c);
    let preset_c = preset.skin_c - preset.ratio * (preset.skin_c - object_c);
    assert_close(bench.steps_setpoint_c(3), preset_c);
    bench.force_n = force_n;
    assert_close(bench.setpoint_c(), preset_c);
    let contact = bench.contact(material, object_c);
    follows_from(bench, &contact, DETECTION_S, ticks);
}

#[track_caller]
fn follows_from(bench: &mut Bench, contact: &Contact<f64>, from_s: f64, ticks: u32) {
    for tick in 0..ticks {
        let expected = contact.at(from_s + f64::from(tick) * 1e-3);
        assert_close(bench.setpoint_c(), expected.display_c);
        assert_eq!(bench.state(), State::Contact);
    }
}

impl Bench {
    fn steps_setpoint_c(&mut self, ticks: u32) -> f64 {
        self.steps(ticks - 1);
        self.setpoint_c()
    }
}

#[test]
fn armed_is_neutral_touched_or_not() {
    let mut bench = Bench::new();
    bench.answers = true;
    bench.obey(&["material copper", "arm"]);
    for force_n in [0.0, 2.0, 0.0] {
        bench.force_n = force_n;
        for _ in 0..200 {
            assert_close(bench.setpoint_c(), 34.0);
            assert_eq!(bench.state(), State::Armed);
        }
    }
}

#[test]
fn preset_and_contact_follow_equation_6_12_for_every_material() {
    for (material, _) in contact_model::material::MATERIALS {
        let mut bench = Bench::answering(material);
        follows_a_contact(&mut bench, material, 24.0, 2.0, 3000);
    }
}

#[test]
fn a_given_object_temperature_replaces_that_of_the_room() {
    let mut bench = Bench::answering("copper");
    bench.obey(&["object 20.5"]);
    follows_a_contact(&mut bench, "copper", 20.5, 1.0, 500);
    bench.obey(&["object room"]);
    follows_a_contact(&mut bench, "copper", 24.0, 1.0, 500);
}

#[test]
fn each_landing_is_a_new_contact() {
    let mut bench = Bench::answering("granite");
    for (force_n, ticks) in [(2.0, 1500), (0.5, 300), (5.0, 10), (0.1, 700)] {
        follows_a_contact(&mut bench, "granite", 24.0, force_n, ticks);
    }
}

#[test]
fn a_new_force_counts_from_its_tick_on() {
    let mut bench = Bench::answering("granite");
    follows_a_contact(&mut bench, "granite", 24.0, 2.0, 400);
    bench.force_n = 0.5;
    let contact = bench.contact("granite", 24.0);
    follows_from(&mut bench, &contact, DETECTION_S + 0.4, 400);
}

#[test]
fn an_object_that_appears_under_a_resting_finger_is_new() {
    let mut bench = Bench::new();
    bench.answers = true;
    bench.obey(&["material copper", "arm"]);
    bench.force_n = 2.0;
    bench.steps(1000);
    let contact = bench.contact("copper", 24.0);
    for lines in [
        &["start"][..],
        &["abort", "arm", "start"],
        &["arm", "start"],
        &["material copper"],
        &["object 24"],
    ] {
        bench.obey(lines);
        follows_from(&mut bench, &contact, 0.0, 1000);
    }
}

#[test]
fn another_material_replaces_the_one_that_is_touched() {
    let mut bench = Bench::answering("copper");
    follows_a_contact(&mut bench, "copper", 24.0, 2.0, 300);
    bench.obey(&["material foam"]);
    let contact = bench.contact("foam", 24.0);
    follows_from(&mut bench, &contact, 0.0, 300);
}

/// What the sensor beside the contact sees during contact is not the skin that it started from.
#[test]
fn skin_and_room_are_those_before_contact() {
    let mut bench = Bench::answering("abs");
    follows_a_contact(&mut bench, "abs", 24.0, 2.0, 100);
    let contact = bench.contact("abs", 24.0);
    (bench.skin_c, bench.room_c) = (31.0, 28.0);
    follows_from(&mut bench, &contact, DETECTION_S + 0.1, 2000);
    bench.force_n = 0.0;
    bench.steps(5000);
    follows_a_contact(&mut bench, "abs", 28.0, 2.0, 100);
}

#[test]
fn semi_infinite_mode_holds_the_interface_temperature() {
    let mut bench = Bench::answering("granite");
    bench.obey(&["mode semi-infinite"]);
    let granite = find("granite").expect("a material of the thesis");
    let expected_c = interface_temperature(&SKIN, 34.0, granite, 24.0);
    for (force_n, state) in [
        (0.0, State::Preset),
        (2.0, State::Contact),
        (0.0, State::Preset),
    ] {
        bench.force_n = force_n;
        for _ in 0..500 {
            assert_close(bench.setpoint_c(), expected_c);
        }
        assert_eq!(bench.state(), state);
    }
    assert_eq!(bench.step().1.evaluations, 0);
}

#[test]
fn the_mode_can_change_under_a_finger() {
    let mut bench = Bench::answering("copper");
    follows_a_contact(&mut bench, "copper", 24.0, 2.0, 300);
    bench.obey(&["mode semi-infinite"]);
    bench.steps(300);
    bench.obey(&["mode contact"]);
    let contact = bench.contact("copper", 24.0);
    follows_from(&mut bench, &contact, 0.0, 300);
}

#[test]
fn a_set_point_beyond_the_safe_range_is_limited_and_flagged() {
    for (object, limit_c) in [("object 60", 42), ("object -20", 15)] {
        let mut bench = Bench::answering("copper");
        bench.obey(&[object]);
        for _ in 0..500 {
            let (_, telemetry) = bench.step();
            assert_eq!(telemetry.setpoint.map(|t| t == limit_c), Some(true));
            assert!(telemetry.limited);
        }
        bench.obey(&["object 30"]);
        assert!(!bench.step().1.limited);
    }
}

#[test]
fn the_kernel_is_evaluated_in_contact_only() {
    let mut bench = Bench::new();
    bench.answers = true;
    bench.obey(&["material copper"]);
    let evaluations = |bench: &mut Bench, ticks| bench.steps(ticks).1.evaluations;
    bench.force_n = 2.0;
    assert_eq!(evaluations(&mut bench, 50), 0);
    bench.obey(&["arm"]);
    assert_eq!(evaluations(&mut bench, 50), 0);
    bench.force_n = 0.0;
    bench.steps(2);
    bench.obey(&["start"]);
    assert_eq!(evaluations(&mut bench, 50), 0);
    bench.force_n = 2.0;
    let landed = evaluations(&mut bench, 51);
    assert!((5..30).contains(&landed), "{landed}");
    bench.force_n = 0.0;
    // The first tick without force may be noise: its contact is evaluated.
    let lifted = evaluations(&mut bench, 51);
    assert!(lifted <= landed + 2, "{landed}, {lifted}");
    bench.obey(&["abort"]);
    bench.force_n = 2.0;
    assert_eq!(evaluations(&mut bench, 50), lifted);
}

#[test]
fn nothing_is_evaluated_for_an_object_at_skin_temperature() {
    let mut bench = Bench::answering("granite");
    bench.room_c = 34.0;
    bench.steps(5000);
    bench.force_n = 2.0;
    for _ in 0..1000 {
        assert_close(bench.setpoint_c(), 34.0);
    }
    assert_eq!(bench.step().1.evaluations, 0);
}

/// A sensor's noise of 0.6 mN, its largest swings in a row.
#[test]
fn a_noisy_force_costs_no_evaluation() {
    for (force_n, material) in [
        (2.0, "granite"),
        (0.1, "granite"),
        (2.0, "foam"),
        (0.1, "copper"),
    ] {
        let mut bench = Bench::answering(material);
        bench.force_n = force_n;
        bench.steps(2);
        let contact = bench.contact(material, 24.0);
        let start = bench.step().1.evaluations;
        for tick in 1..10_000 {
            let swing = if tick % 14 < 7 { 0.6e-3 } else { -0.6e-3 };
            bench.force_n = force_n + swing;
            let setpoint_c = bench.setpoint_c();
            // Until the mean has settled, the first tick's force is as good as any.
            if tick > 500 {
                let expected = contact.at(DETECTION_S + f64::from(tick) * 1e-3);
                assert_close(setpoint_c, expected.display_c);
            }
        }
        let evaluations = bench.step().1.evaluations - start;
        assert!(evaluations <= 80, "{material}, {force_n} N: {evaluations}");
    }
}
