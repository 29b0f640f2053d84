//! Effects that the thesis's half-spaces neglect (blood, epidermis, thickness of the object) against an independent
//! numerical study: the change of the skin temperature in a contact with a difference of 10 K at 14.8 kPa.

use contact_model::material::find;
use contact_model::reference::contact_resistance;
use documented_figures::assert_figure;

use super::*;
use crate::slab::{BackBoundary, Layer, Medium};

/// Pressure of section 6.3, Pa.
const PRESSURE_PA: f64 = 2.0 / 135e-6;

/// Skin temperature on the object, deg C, at each time.
fn skin_c(
    finger: &FingerParams,
    object: &ObjectConfig,
    core_c: Option<f64>,
    times_s: &[f64],
) -> Vec<f64> {
    let mut bench = Bench::new(finger, object, TileParams::NOMINAL);
    if let Some(core_c) = core_c {
        bench.heat.set_finger(&vec![SKIN_C; bench.finger.cells()], core_c);
    }
    let touch = SkinContact {
        area_m2: 135e-6,
        resistance_m2k_w: contact_resistance(&SKIN.surface, &object.surface, PRESSURE_PA),
    };
    bench.touch(None, Some(touch));
    let mut steps = 0;
    times_s
        .iter()
        .map(|t_s| {
            while f64::from(steps) * STEP_S < t_s - 0.5 * STEP_S {
                bench.step(None);
                steps += 1;
            }
            bench.heat.skin_c(Finger::OnObject)
        })
        .collect()
}

fn half_space(name: &str) -> ObjectConfig {
    ObjectConfig::half_space(*find(name).expect("known"), ROOM_C)
}

#[test]
fn blood_warms_the_skin() {
    // Perfusion 8.3e-3 1/s. The study does not state its blood; assumed are 3.8e6 J/(m3 K) and 37 deg C.
    let mut perfused = FingerParams::homogeneous();
    perfused.layers[0].medium.perfusion_w_m3k = 8.3e-3 * 3.8e6;
    for (name, warmer_k) in [("copper", 0.11), ("abs", 0.23)] {
        let object = half_space(name);
        let [plain, with] = [&FingerParams::homogeneous(), &perfused]
            .map(|f| skin_c(f, &object, Some(37.0), &[10.0])[0]);
        assert_figure(&format!("variants.blood_{name}"), with - plain);
        let off = (with - plain) / warmer_k - 1.0;
        assert!(off.abs() < 0.2, "{name}: {:+.3} K", with - plain);
    }
}

#[test]
fn epidermis_changes_only_the_first_second() {
    let mut layered = FingerParams::homogeneous();
    let dermis = layered.layers[0];
    layered.layers.insert(
        0,
        Layer { thickness_m: 0.1e-3, medium: Medium { conductivity_w_mk: 0.21, ..dermis.medium } },
    );
    let object = half_space("copper");
    let times_s = [0.1, 10.0];
    let plain = skin_c(&FingerParams::homogeneous(), &object, None, &times_s);
    let with = skin_c(&layered, &object, None, &times_s);
    assert_figure("variants.epidermis_soon", plain[0] - with[0]);
    assert_figure("variants.epidermis_late", plain[1] - with[1]);
}

#[test]
fn thin_copper_warms_up() {
    let object = half_space("copper");
    let mut thin = object.clone();
    thin.layers[0].thickness_m = 10e-3;
    let finger = FingerParams::homogeneous();
    let [plain, with] = [&object, &thin].map(|o| skin_c(&finger, o, None, &[10.0])[0]);
    assert_figure("variants.slab", with - plain);
    // With its back held at the start temperature it stays colder than a half-space.
    let held = ObjectConfig {
        back: BackBoundary::Film { film_w_m2k: f64::INFINITY, temperature_c: ROOM_C },
        ..thin
    };
    assert!(skin_c(&finger, &held, None, &[10.0])[0] < plain);
}
