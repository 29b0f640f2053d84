//! The scenes are those that the scenarios promise.

use contact_model::material::THESIS_MATERIALS;
use thermal_device::control::Law;
use thermal_sim::scene::Scene;

use super::*;

fn scene(case: &FidelityCase) -> Scene {
    case.scene(Law::Pi10Hz, 5, &[]).expect("a scene")
}

fn find<'a>(cases: &'a [FidelityCase], name: &str, force_n: f64) -> &'a FidelityCase {
    cases.iter().find(|case| case.name == name && case.force_n == force_n).expect(name)
}

#[test]
fn every_case_is_a_scene_with_its_law_seed_and_temperatures() {
    for case in Scenario::ALL.iter().flat_map(|scenario| scenario.cases()) {
        let scene = scene(&case);
        assert_eq!((scene.law, scene.seed, scene.room_c), (Some(Law::Pi10Hz), 5, 24.0));
        assert_eq!((scene.skin_c, scene.object_c()), (case.skin_c, case.object_c));
    }
}

#[test]
fn a_has_nine_materials_at_five_forces_for_ten_seconds() {
    let cases = Scenario::A.cases();
    assert_eq!(cases.len(), 45);
    for name in THESIS_MATERIALS {
        for force_n in [0.1, 0.25, 0.5, 1.0, 2.0] {
            let scene = scene(find(&cases, name, force_n));
            assert_eq!(scene.object.name, name);
            assert_eq!((scene.skin_c, scene.object_c()), (34.0, 24.0));
            assert_eq!((scene.force_n(0.999), scene.force_n(1.0)), (0.0, force_n));
            assert_eq!((scene.force_n(scene.duration_s), scene.duration_s), (force_n, 11.0));
        }
    }
}

#[test]
fn b_has_the_finger_there_before_the_object() {
    let cases = Scenario::B.cases();
    assert_eq!(cases.len(), 45);
    for (name, bound_s) in
        [("copper", Some(1.25)), ("abs", Some(0.35)), ("foam", Some(0.1)), ("zns", None)]
    {
        let case = find(&cases, name, 2.0);
        let expected = Measure::Settles { below_mk: 50.0, bound_s };
        assert_eq!(case.measure, expected);
        let scene = scene(case);
        assert_eq!(scene.object.appears_t_s, 2.0);
        assert_eq!(
            (scene.force_n(0.499), scene.force_n(0.5), scene.force_n(12.0)),
            (0.0, 2.0, 2.0)
        );
    }
}

#[test]
fn c_lifts_and_replaces_ten_times() {
    let scene = scene(find(&Scenario::C.cases(), "abs", 0.5));
    let touches = |ms: u32| scene.force_n(f64::from(ms) * 1e-3) > 0.0;
    let landings = (1..=21_000).filter(|&ms| touches(ms) && !touches(ms - 1)).count();
    let lifts = (1..=21_000).filter(|&ms| !touches(ms) && touches(ms - 1)).count();
    assert_eq!((landings, lifts), (10, 10));
    assert_eq!((0..21_000).filter(|&ms| touches(ms)).count(), 10_000);
}

#[test]
fn d_ramps_from_a_tenth_of_a_newton_to_two_and_back_within_a_second_each() {
    let cases = Scenario::D.cases();
    assert_eq!(cases.len(), 9);
    let scene = scene(&cases[0]);
    for (t_s, force_n) in [
        (0.9, 0.0),
        (1.0, 0.1),
        (2.0, 0.1),
        (2.5, 1.05),
        (3.0, 2.0),
        (5.0, 2.0),
        (5.5, 1.05),
        (6.0, 0.1),
        (8.0, 0.1),
    ] {
        assert!((scene.force_n(t_s) - force_n).abs() < 1e-12, "{t_s} s");
    }
}

#[test]
fn unseen_are_materials_warm_objects_other_skin_and_a_bar_that_is_too_warm() {
    let cases = Scenario::Unseen.cases();
    for name in ["glass", "aluminium", "oak", "cork"] {
        assert_eq!(scene(find(&cases, name, 0.1)).object.name, "custom");
    }
    assert!(cases.iter().filter(|case| case.object_c == 41.0).count() >= 4);
    let skins: Vec<_> = cases.iter().map(|case| case.skin_c).collect();
    assert!(skins.contains(&28.0) && skins.contains(&36.0));
    let bar = cases.iter().find(|case| case.object_c == 44.0).expect("a bar");
    assert_eq!(bar.measure, Measure::Limited);
    // Effusivities of handbooks, J/(m2 s^0.5 K): glass 1450, aluminium 24000, oak 490, cork 117.
    for (name, effusivity) in
        [("glass", 1450.0), ("aluminium", 24e3), ("oak", 490.0), ("cork", 117.0)]
    {
        let material = find(&cases, name, 2.0).object.properties.expect("properties");
        let ratio = material.effusivity() / effusivity;
        assert!((0.95..1.05).contains(&ratio), "{name}: {}", material.effusivity());
    }
}
