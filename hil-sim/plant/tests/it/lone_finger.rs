//! A finger alone, on an object: the thesis's finger on half-spaces follows its closed form (on surfaces of a given temperature,
//! see the earlier displays' tests of the ideal tile).

use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
use contact_model::pressure::pressure_pa;
use contact_model::reference::{Contact, contact_resistance};
use thermal_plant::finger::FingerParams;
use thermal_plant::lone_finger::LoneFinger;
use thermal_plant::object::ObjectConfig;

const SKIN_C: f64 = 34.0;
const OBJECT_C: f64 = 24.0;

#[test]
fn skin_and_flux_on_half_spaces_follow_the_closed_form() {
    let finger = LoneFinger {
        params: FingerParams::homogeneous(),
        flow: 1.0,
        skin_c: SKIN_C,
        room_c: OBJECT_C,
    };
    let pressure_pa = pressure_pa(2.0);
    for (name, material) in MATERIALS {
        let exact =
            Contact::new((&SKIN, SKIN_C), (&material, OBJECT_C), &REFERENCE_DISPLAY, pressure_pa);
        let m2k_w = contact_resistance::<f64>(&SKIN.surface, &material.surface, pressure_pa);
        let touched = finger.on_object(m2k_w, 2000, &ObjectConfig::half_space(material, OBJECT_C));
        assert_eq!((touched.skin_c.len(), touched.flux_w_m2.len()), (2001, 2001));
        for ms in [0, 1, 5, 50, 500, 2000] {
            let exact = exact.at(f64::from(ms) / 1e3);
            let off_k = touched.skin_c[ms as usize] - exact.skin_c;
            assert!(off_k.abs() < 0.5e-3, "{name}, {ms} ms: {off_k} K");
            let exact_w_m2 = (exact.skin_c - exact.object_c) / m2k_w;
            let off_w_m2 = touched.flux_w_m2[ms as usize] - exact_w_m2;
            let landing_w_m2 = (SKIN_C - OBJECT_C) / m2k_w;
            assert!(off_w_m2.abs() < 3e-4 * landing_w_m2, "{name}, {ms} ms: {off_w_m2} W/m2");
        }
    }
}
