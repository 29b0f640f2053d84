//! Set-points against the thesis's equations in `f64`.

use contact_model::material::{SKIN, find};
use contact_model::reference::{Contact, interface_temperature};

use super::{TestBench, assert_close};
use crate::device::StateName;

/// Age of a contact in the tick in which it is detected, s: two ticks with a force.
const DETECTION_S: f64 = 2e-3;

/// Lands with `force_n`, and asserts that the set-point follows Eq. 6-12 for `ticks` ticks from the detection on.
#[track_caller]
pub(super) fn assert_follows_new_contact(
    bench: &mut TestBench,
    material: &str,
    object_c: f64,
    force_n: f64,
    ticks: u32,
) {
    bench.force_n = 0.0;
    let preset = bench.contact(material, object_c);
    let preset_c = preset.skin_c - preset.ratio * (preset.skin_c - object_c);
    // The lift is found in the seventh tick.
    bench.steps(6);
    bench.assert_reaches_setpoint(preset_c);
    bench.force_n = force_n;
    bench.assert_setpoint(preset_c);
    let contact = bench.contact(material, object_c);
    assert_follows_contact(bench, &contact, DETECTION_S, ticks);
}

/// Asserts that the set-point follows a contact that is `from_s` old, s, for `ticks` ticks.
#[track_caller]
pub(super) fn assert_follows_contact(
    bench: &mut TestBench,
    contact: &Contact<f64>,
    from_s: f64,
    ticks: u32,
) {
    for tick in 0..ticks {
        let expected = contact.at(from_s + f64::from(tick) * 1e-3);
        bench.assert_setpoint(expected.display_c);
        assert_eq!(bench.state(), StateName::Contact);
    }
}

#[test]
fn an_armed_display_is_at_skin_temperature_touched_or_not() {
    let mut bench = TestBench::new();
    bench.plate_responds = true;
    bench.send_ok(&["material copper", "arm"]);
    for force_n in [0.0, 2.0, 0.0] {
        bench.force_n = force_n;
        bench.assert_reaches_setpoint(34.0);
        for _ in 0..200 {
            bench.assert_setpoint(34.0);
            assert_eq!(bench.state(), StateName::Armed);
        }
    }
}

#[test]
fn preset_and_contact_follow_equation_6_12_for_every_material() {
    for (material, _) in contact_model::material::MATERIALS {
        let mut bench = TestBench::presenting_with_plate(material);
        assert_follows_new_contact(&mut bench, material, 24.0, 2.0, 3000);
    }
}

#[test]
fn a_given_object_temperature_replaces_the_room_temperature() {
    let mut bench = TestBench::presenting_with_plate("copper");
    bench.send_ok(&["object 20.5"]);
    assert_follows_new_contact(&mut bench, "copper", 20.5, 1.0, 500);
    bench.send_ok(&["object room"]);
    assert_follows_new_contact(&mut bench, "copper", 24.0, 1.0, 500);
}

#[test]
fn each_landing_starts_a_new_contact() {
    let mut bench = TestBench::presenting_with_plate("granite");
    for (force_n, ticks) in [(2.0, 1500), (0.5, 300), (5.0, 10), (0.1, 700)] {
        assert_follows_new_contact(&mut bench, "granite", 24.0, force_n, ticks);
    }
}

#[test]
fn a_change_of_force_takes_effect_in_its_tick() {
    let mut bench = TestBench::presenting_with_plate("granite");
    assert_follows_new_contact(&mut bench, "granite", 24.0, 2.0, 400);
    bench.force_n = 0.5;
    let contact = bench.contact("granite", 24.0);
    assert_follows_contact(&mut bench, &contact, DETECTION_S + 0.4, 400);
}

#[test]
fn an_object_presented_under_a_resting_finger_starts_a_new_contact() {
    let mut bench = TestBench::new();
    bench.plate_responds = true;
    bench.send_ok(&["material copper", "arm"]);
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
        bench.send_ok(lines);
        assert_follows_contact(&mut bench, &contact, 0.0, 1000);
    }
}

#[test]
fn a_material_chosen_under_a_finger_starts_a_new_contact() {
    let mut bench = TestBench::presenting_with_plate("copper");
    assert_follows_new_contact(&mut bench, "copper", 24.0, 2.0, 300);
    bench.send_ok(&["material foam"]);
    let contact = bench.contact("foam", 24.0);
    assert_follows_contact(&mut bench, &contact, 0.0, 300);
}

/// The skin sensor sits beside the contact, so its reading during a contact is not the initial temperature.
#[test]
fn a_contact_starts_from_the_skin_and_room_temperature_before_it() {
    let mut bench = TestBench::presenting_with_plate("abs");
    assert_follows_new_contact(&mut bench, "abs", 24.0, 2.0, 100);
    let contact = bench.contact("abs", 24.0);
    (bench.skin_c, bench.room_c) = (31.0, 28.0);
    assert_follows_contact(&mut bench, &contact, DETECTION_S + 0.1, 2000);
    bench.force_n = 0.0;
    bench.steps(5000);
    assert_follows_new_contact(&mut bench, "abs", 28.0, 2.0, 100);
}

#[test]
fn semi_infinite_mode_holds_the_interface_temperature() {
    let mut bench = TestBench::presenting_with_plate("granite");
    bench.send_ok(&["mode semi-infinite"]);
    let granite = find("granite").expect("a material of the thesis");
    let expected_c = interface_temperature(&SKIN, 34.0, granite, 24.0);
    for (force_n, state) in
        [(0.0, StateName::Preset), (2.0, StateName::Contact), (0.0, StateName::Preset)]
    {
        bench.force_n = force_n;
        for _ in 0..500 {
            bench.assert_setpoint(expected_c);
        }
        assert_eq!(bench.state(), state);
    }
    assert_eq!(bench.step().1.evaluations, 0);
}

#[test]
fn contact_mode_chosen_under_a_finger_starts_from_the_interface_temperature() {
    let mut bench = TestBench::presenting_with_plate("copper");
    assert_follows_new_contact(&mut bench, "copper", 24.0, 2.0, 300);
    bench.send_ok(&["mode semi-infinite"]);
    bench.steps(300);
    bench.send_ok(&["mode contact"]);
    let contact = bench.contact("copper", 24.0);
    assert_follows_contact(&mut bench, &contact, 0.0, 300);
}

#[test]
fn a_set_point_beyond_the_safe_range_is_limited_and_flagged() {
    for (object, limit_c) in [("object 60", 42), ("object -20", 15)] {
        let mut bench = TestBench::presenting_with_plate("copper");
        bench.send_ok(&["law model", object]);
        for _ in 0..500 {
            let (_, telemetry) = bench.step();
            assert_eq!(telemetry.setpoint.map(|t| t == limit_c), Some(true));
            assert!(telemetry.limited);
        }
        bench.send_ok(&["object 30"]);
        assert!(!bench.step().1.limited);
    }
}

#[test]
fn the_contact_kernel_is_evaluated_only_in_contact() {
    let mut bench = TestBench::new();
    bench.plate_responds = true;
    bench.send_ok(&["material copper"]);
    let evaluations = |bench: &mut TestBench, ticks| bench.steps(ticks).1.evaluations;
    bench.force_n = 2.0;
    assert_eq!(evaluations(&mut bench, 50), 0);
    bench.send_ok(&["arm"]);
    assert_eq!(evaluations(&mut bench, 50), 0);
    bench.force_n = 0.0;
    bench.steps(6);
    bench.send_ok(&["start"]);
    assert_eq!(evaluations(&mut bench, 50), 0);
    bench.force_n = 2.0;
    let landed = evaluations(&mut bench, 51);
    assert!((5..30).contains(&landed), "{landed}");
    bench.force_n = 0.0;
    // The first tick without force may be noise, so the contact is still evaluated in it.
    let lifted = evaluations(&mut bench, 51);
    assert!(lifted <= landed + 2, "{landed}, {lifted}");
    bench.send_ok(&["abort"]);
    bench.force_n = 2.0;
    assert_eq!(evaluations(&mut bench, 50), lifted);
}

#[test]
fn the_contact_kernel_is_not_evaluated_for_an_object_at_skin_temperature() {
    let mut bench = TestBench::presenting_with_plate("granite");
    bench.room_c = 34.0;
    bench.steps(5000);
    bench.force_n = 2.0;
    for _ in 0..1000 {
        bench.assert_setpoint(34.0);
    }
    assert_eq!(bench.step().1.evaluations, 0);
}

/// A ripple of 0.6 mN, the noise of the sensor in its least favourable order, costs at most 80 evaluations in 10 s.
#[test]
fn force_noise_hardly_costs_evaluations_of_the_contact_kernel() {
    for (force_n, material) in [(2.0, "granite"), (0.1, "granite"), (2.0, "foam"), (0.1, "copper")]
    {
        let mut bench = TestBench::presenting_with_plate(material);
        bench.steps(3000);
        bench.force_n = force_n;
        bench.steps(2);
        let contact = bench.contact(material, 24.0);
        let start = bench.step().1.evaluations;
        for tick in 1..10_000 {
            let ripple_n = if tick % 14 < 7 { 0.6e-3 } else { -0.6e-3 };
            bench.force_n = force_n + ripple_n;
            let setpoint_c = bench.setpoint_c();
            // The mean force takes 500 ticks to settle.
            if tick > 500 {
                let expected = contact.at(DETECTION_S + f64::from(tick) * 1e-3);
                assert_close(setpoint_c, expected.display_c);
            }
        }
        let evaluations = bench.step().1.evaluations - start;
        assert!(evaluations <= 80, "{material}, {force_n} N: {evaluations}");
    }
}
