//! The release image at the ends of its range: warm objects, cool and warm skin, and an object that is too warm to be displayed.

use image_tests::on_image;
use system_tests::{between, forces, host, scene, worst_k};
use thermal_campaigns::fidelity::Scenario;
use thermal_display::device::control::Law;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

/// Runs a case of the scenario "unseen", whose temperatures no tuning has used.
fn unseen(name: &str) -> (Scene, Outcome) {
    let mut cases = Scenario::Unseen.cases().into_iter();
    let case = cases.find(|case| case.name == name).expect(name);
    let scene = case.scene(Law::default(), 1, &[]).expect("a good scene");
    let outcome = on_image(&scene);
    (scene, outcome)
}

fn assert_displayed(name: &str) {
    let (scene, outcome) = unseen(name);
    let skin_k = worst_k(&scene, &outcome, 0.05);
    println!("{name}: skin {:.1} mK after 50 ms", 1e3 * skin_k);
    assert!(skin_k <= 0.02, "{name}: {skin_k} K");
    for row in between(&outcome, 1.01, 11.0) {
        let device = row.device.as_ref().expect("telemetry of every tick");
        let reported = (device.state.name(), device.remark());
        assert_eq!(reported, ("contact", None), "{name} at {} s", row.t_s);
    }
}

#[test]
fn copper_of_41_c_is_displayed_within_20_mk_of_the_skin() {
    assert_displayed("copper of 41 C");
}

#[test]
fn copper_is_displayed_to_a_skin_of_28_c_within_20_mk() {
    assert_displayed("copper, skin 28 C");
}

#[test]
fn granite_is_displayed_to_a_skin_of_36_c_within_20_mk() {
    assert_displayed("granite, skin 36 C");
}

/// An object of 44 °C: the display stops at 42 °C, the telemetry reports the limit, and the contact goes on.
#[test]
fn the_set_point_of_an_object_of_44_c_is_limited_to_42_c_and_reported() {
    const LIMIT_C: f64 = 42.0;
    let tables = forces(&[(1.0, 2.0)]) + &host(&[(5.0, "state")]);
    let mut scene = scene("copper", 11.0, "", &tables);
    scene.object.start_c = Some(44.0);
    let outcome = on_image(&scene);
    let mut warmest_c = f64::NEG_INFINITY;
    for row in outcome.trace.rows() {
        let device = row.device.as_ref().expect("telemetry of every tick");
        let state = if row.t_s < 1.0 { "preset" } else { "contact" };
        if !(1.0..1.01).contains(&row.t_s) {
            let reported = (device.state.name(), device.remark());
            assert_eq!(reported, (state, Some("limited")), "at {} s", row.t_s);
            assert_eq!(device.setpoint_c, Some(LIMIT_C), "at {} s", row.t_s);
        }
        assert!(row.skin_c < LIMIT_C, "skin {} C at {} s", row.skin_c, row.t_s);
        warmest_c = warmest_c.max(row.display_c);
    }
    println!("display {warmest_c:.3} C at most");
    assert!(warmest_c < LIMIT_C + 0.03, "display {warmest_c} C");
    let answer = outcome.answers.last().map(|(_, line)| line.as_str());
    let state = "ok state=contact fault=- material=copper object_c=44.00 mode=contact setpoint_c=42.00 limited body=half-space tile=tuned";
    assert_eq!(answer, Some(state));
}
