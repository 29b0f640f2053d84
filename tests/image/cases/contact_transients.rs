//! Transients beyond the closed form of Eq. 6-12, on the release image: an object that appears under a resting finger, repeated
//! contacts, a force that changes.

use documented_figures::assert_figure;
use image_tests::on_image;
use system_tests::{between, worst_k};
use thermal_campaigns::fidelity::{FidelityCase, Scenario};
use thermal_display::device::control::Law;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

/// Largest skin error after the time that the tile's power needs, K.
const SETTLED_K: f64 = 0.05;

fn case(scenario: Scenario, material: &str, force_n: f64) -> FidelityCase {
    let mut cases = scenario.cases().into_iter();
    let wanted = cases.find(|case| (case.name.as_str(), case.force_n) == (material, force_n));
    wanted.expect("a case of the scenario")
}

fn displayed(scenario: Scenario, material: &str) -> (Scene, Outcome) {
    let case = case(scenario, material, 2.0);
    let scene = case.scene(Law::default(), 1, &[]).expect("a good scene");
    let outcome = on_image(&scene);
    for row in outcome.trace.rows() {
        let device = row.device.as_ref().expect("telemetry of every tick");
        assert_ne!(device.state.name(), "tripped", "{material} at {} s", row.t_s);
    }
    (scene, outcome)
}

/// A finger rests on the neutral display; from `from_s` after the object's appearance on, the skin is as on the real object.
fn appears(material: &str, from_s: f64) {
    let (scene, outcome) = displayed(Scenario::B, material);
    let appears_s = scene.object.appears_t_s;
    for row in between(&outcome, appears_s - 1.0, appears_s - 2e-3) {
        let device = row.device.as_ref().expect("telemetry of every tick");
        assert_eq!(device.state.name(), "armed");
        assert!(
            (row.skin_c - scene.skin_c).abs() < 0.01,
            "neutral at {} s: {}",
            row.t_s,
            row.skin_c
        );
    }
    let error_k = worst_k(&scene, &outcome, from_s);
    assert_figure(&format!("changing.{material}_appears"), 1e3 * error_k);
    // The tile's power limits the change: an error below that from the start on would mean that nothing appeared.
    let before_k = worst_k(&scene, &outcome, 0.0);
    assert!(before_k > SETTLED_K, "{material}: {before_k} K at first");
}

#[test]
fn copper_appears_under_a_resting_finger_within_1_25_s() {
    appears("copper", 1.25);
}

#[test]
fn abs_appears_under_a_resting_finger_within_0_35_s() {
    appears("abs", 0.35);
}

#[test]
fn foam_appears_under_a_resting_finger_within_0_1_s() {
    appears("foam", 0.1);
}

/// One second on, one off, ten times: the skin does not recover in between, and the device takes that into account.
#[test]
fn ten_contacts_with_granite_are_displayed_within_50_mk() {
    let (scene, outcome) = displayed(Scenario::C, "granite");
    let error_k = worst_k(&scene, &outcome, 0.1);
    assert_figure("changing.granite_replaced", 1e3 * error_k);
    let at_landing = |t_s: f64| {
        let row = between(&outcome, t_s, 21.0).next().expect("a row");
        row.skin_real_c
    };
    assert!(at_landing(19.0) < at_landing(1.0) - 0.5, "the skin has cooled by the tenth contact");
}

/// 0.1 N to 2 N within a second, and back: contact resistance falls to a tenth.
#[test]
fn granite_under_a_changing_force_is_displayed_within_50_mk() {
    let (scene, outcome) = displayed(Scenario::D, "granite");
    let error_k = worst_k(&scene, &outcome, 0.1);
    assert_figure("changing.granite_force", 1e3 * error_k);
}
