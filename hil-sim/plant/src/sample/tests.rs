use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN, find};
use contact_model::pressure::pressure_pa;
use contact_model::reference::Contact;

use super::SampleTouch;
use crate::bridge::BridgeOutputs;
use crate::finger::FingerParams;
use crate::object::ObjectConfig;
use crate::{Finger, Params, Plant, PlantConfig};

fn config(material: &str, finger: FingerParams) -> PlantConfig {
    PlantConfig {
        skin_c: 34.0,
        room_c: 24.0,
        object: ObjectConfig::half_space(*find(material).expect("known"), 24.0),
        start_s: 0.0,
        appears_s: 0.0,
        duration_s: 60.0,
        seed: 1,
        params: Params { finger, ..Params::nominal() },
    }
}

#[test]
fn a_touch_of_constant_force_follows_equations_6_5_to_6_7() {
    for (name, material) in MATERIALS {
        for force_n in [0.1, 0.5, 2.0] {
            let (finger, object) = ((&SKIN, 34.0), (&material, 24.0));
            let exact = Contact::new(finger, object, &REFERENCE_DISPLAY, pressure_pa(force_n));
            let mut touch =
                SampleTouch::new(&config(name, FingerParams::homogeneous())).expect("valid");
            touch.set_force(force_n);
            for step in 1..=10_000u32 {
                touch.step();
                let want = exact.at(f64::from(step) * 1e-3);
                let skin_off_mk = 1e3 * (touch.skin_c() - want.skin_c).abs();
                let sample_off_mk = 1e3 * (touch.sample_c() - want.object_c).abs();
                assert!(
                    skin_off_mk < 1.0 && sample_off_mk < 1.0,
                    "{name} at {force_n} N after {step} ms: {skin_off_mk} mK, {sample_off_mk} mK"
                );
            }
        }
    }
}

#[test]
fn repeated_touches_of_both_fingers_are_those_of_the_plant() {
    for finger in [FingerParams::homogeneous(), FingerParams::layered()] {
        for material in ["copper", "granite", "foam"] {
            let config = config(material, finger.clone());
            let mut plant = Plant::new(&config).expect("valid");
            let mut touch = SampleTouch::new(&config).expect("valid");
            // Touches of 0.4 s with a growing force and lifts of 0.3 s.
            for ms in 0..3_000u32 {
                let since_s = f64::from(ms % 700) * 1e-3;
                let force_n = if since_s < 0.4 { 0.05 + 4.0 * since_s } else { 0.0 };
                plant.set_force(force_n);
                touch.set_force(force_n);
                plant.step(&BridgeOutputs::default());
                touch.step();
                let [Some(real_c), Some(_)] = plant.receptors_c(Finger::OnObject) else {
                    panic!("the finger has receptors");
                };
                let [Some(cold_c), Some(_)] = touch.receptors_c() else {
                    panic!("the finger has receptors");
                };
                assert!((real_c - cold_c).abs() < 1e-9, "{material} after {ms} ms");
                assert!((plant.skin_real_c() - touch.skin_c()).abs() < 1e-9);
                assert!((plant.object_c() - touch.sample_c()).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn heat_that_leaves_the_skin_comes_back_only_from_its_depth() {
    // After a touch the surface recovers towards the temperature before it, and never beyond.
    let mut touch = SampleTouch::new(&config("copper", FingerParams::homogeneous())).expect("ok");
    touch.set_force(2.0);
    for _ in 0..2_000 {
        touch.step();
    }
    touch.set_force(0.0);
    let mut before_c = touch.skin_c();
    for _ in 0..20_000 {
        touch.step();
        assert!((before_c - 1e-9..34.0).contains(&touch.skin_c()));
        before_c = touch.skin_c();
    }
    assert!(before_c > 32.5, "{before_c}");
}
