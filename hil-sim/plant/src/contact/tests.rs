use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
use contact_model::pressure::pressure_pa;
use contact_model::reference::contact_resistance;

use super::*;

fn at_force(law: &ContactLaw, force_n: f64) -> SkinContact {
    law.at_force(force_n, &SKIN.surface, &REFERENCE_DISPLAY).expect("pressed")
}

#[test]
fn nominal_law_is_that_of_the_contact_model_bit_for_bit() {
    for (_, material) in MATERIALS {
        for force_n in (1..=400).map(|k| 0.01 * f64::from(k)) {
            let contact = ContactLaw::NOMINAL
                .at_force(force_n, &SKIN.surface, &material.surface)
                .expect("pressed");
            let resistance: f64 =
                contact_resistance(&SKIN.surface, &material.surface, pressure_pa(force_n));
            assert_eq!(contact.resistance_m2k_w.to_bits(), resistance.to_bits());
            assert_eq!(contact.area_m2.to_bits(), contact_area_m2(force_n).to_bits());
        }
    }
    let lifted = ContactLaw::NOMINAL.at_force(0.0, &SKIN.surface, &REFERENCE_DISPLAY);
    assert_eq!(lifted, None);
}

#[test]
fn gap_is_parallel_to_the_spots() {
    let nominal = ContactLaw::NOMINAL;
    for force_n in [0.1, 2.0] {
        for gap_w_m2k in [200.0, 400.0] {
            let law = ContactLaw { gap_w_m2k, ..nominal };
            let [with, without] =
                [&law, &nominal].map(|law| at_force(law, force_n).resistance_m2k_w.recip());
            assert!((with - without - gap_w_m2k).abs() < 1e-9 * with);
        }
    }
}

#[test]
fn resistance_follows_hardness_exponent_and_true_area() {
    let nominal = ContactLaw::NOMINAL;
    let ratio = |law: ContactLaw| {
        let [law, nominal] = [law, nominal].map(|law| at_force(&law, 1.0));
        (law.resistance_m2k_w / nominal.resistance_m2k_w, law.area_m2 / nominal.area_m2)
    };
    let close = |(resistance, area): (f64, f64), expected: (f64, f64)| {
        (resistance / expected.0 - 1.0).abs() < 1e-12 && (area / expected.1 - 1.0).abs() < 1e-12
    };
    let hard = ContactLaw { hardness_pa: 2.0 * nominal.hardness_pa, ..nominal };
    assert!(close(ratio(hard), (2f64.powf(0.95), 1.0)));
    // The same force on a larger area presses less.
    let wide = ContactLaw { area_factor: 1.2, ..nominal };
    assert!(close(ratio(wide), (1.2f64.powf(0.95), 1.2)));
    let linear = ContactLaw { exponent: 1.0, ..nominal };
    assert!(close(ratio(linear), ((nominal.hardness_pa / pressure_pa(1.0)).powf(0.05), 1.0)));
}
