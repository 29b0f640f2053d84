//! The release image where Eq. 6-12 in closed form does not hold: an object that appears under a finger, a finger that
//! comes back, a force that changes.

use documented_figures::assert_figure;
use hil_sim::fidelity::{Case, Scenario};
use hil_sim::run::Outcome;
use hil_sim::scene::Scene;
use system_tests::{between, on_image, worst_k};
use thermal_display::control::Law;

/// What remains after a time that the power allows, K.
const SETTLED_K: f64 = 0.05;

fn case(scenario: Scenario, material: &str, force_n: f64) -> Case {
    let mut cases = scenario.cases().into_iter();
    let wanted = cases.find(|case| (case.name.as_str(), case.force_n) == (material, force_n));
    wanted.expect("a case of the scenario")
}

fn felt(scenario: Scenario, material: &str) -> (Scene, Outcome) {
    let case = case(scenario, material, 2.0);
    let scene = case.scene(Law::default(), 1, &[]).expect("a good scene");
    let outcome = on_image(&scene);
    for row in outcome.trace.rows() {
        let device = row.device.as_ref().expect("telemetry of every tick");
        assert_ne!(device.state, "tripped", "{material} at {} s", row.t_s);
    }
    (scene, outcome)
}

/// A finger rests at neutral; from `from_s` after the object's appearance on the skin is as on the object.
fn appears(material: &str, from_s: f64) {
    let (scene, outcome) = felt(Scenario::B, material);
    let appears_s = scene.object.appears_t_s;
    for row in between(&outcome, appears_s - 1.0, appears_s - 2e-3) {
        let device = row.device.as_ref().expect("telemetry of every tick");
        assert_eq!(device.state, "armed");
        assert!(
            (row.skin_c - scene.skin_c).abs() < 0.01,
            "neutral at {} s: {}",
            row.t_s,
            row.skin_c
        );
    }
    let left_k = worst_k(&scene, &outcome, from_s);
    assert_figure(&format!("changing.{material}_appears"), 1e3 * left_k);
    // Power bounds what comes before: a display that stood still, or was there at once, would not be this one.
    let before_k = worst_k(&scene, &outcome, 0.0);
    assert!(before_k > SETTLED_K, "{material}: {before_k} K at first");
}

#[test]
fn copper_appears_under_a_resting_finger() {
    appears("copper", 1.25);
}

#[test]
fn abs_appears_under_a_resting_finger() {
    appears("abs", 0.35);
}

#[test]
fn foam_appears_under_a_resting_finger() {
    appears("foam", 0.1);
}

/// One second on, one off, ten times: the skin does not recover in between, and the display knows.
#[test]
fn granite_is_lifted_off_and_replaced() {
    let (scene, outcome) = felt(Scenario::C, "granite");
    let left_k = worst_k(&scene, &outcome, 0.1);
    assert_figure("changing.granite_replaced", 1e3 * left_k);
    let at_landing = |t_s: f64| {
        let row = between(&outcome, t_s, 21.0).next().expect("a row");
        row.skin_real_c
    };
    assert!(
        at_landing(19.0) < at_landing(1.0) - 0.5,
        "the skin has cooled by the tenth contact"
    );
}

/// 0.1 N to 2 N within a second, and back: contact resistance falls to a tenth.
#[test]
fn a_force_changes_on_granite() {
    let (scene, outcome) = felt(Scenario::D, "granite");
    let left_k = worst_k(&scene, &outcome, 0.1);
    assert_figure("changing.granite_force", 1e3 * left_k);
}
