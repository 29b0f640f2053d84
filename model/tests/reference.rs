//! Materials, pressure and limits of the floating-point reference; `budgets` measures its errors.

use contact_model::material::{
    MATERIALS, REFERENCE_DISPLAY, SKIN, THESIS_MATERIALS, average_slope_rad, find,
};
use contact_model::pressure::{contact_area_m2, pressure_pa};
use contact_model::reference::{Contact, SemiInfinite};

use crate::budgets::sweep::relative;
use crate::golden::{material, number, rows};

#[test]
fn effusivity_and_average_slope_agree_with_golden_values() {
    for row in rows("semi_infinite") {
        let expected = number(&row, "e_from_k_rho_c");
        assert!(relative(material(&row).effusivity(), expected) < 1e-14, "{row:?}");
    }
    for row in rows("roughness_sinusoid") {
        let slope = average_slope_rad(number(&row, "Rdq"));
        assert!(relative(slope, number(&row, "Rdq_over_1.25")) < 1e-14, "{row:?}");
    }
}

#[test]
fn no_heat_flows_at_zero_pressure() {
    let (skin_c, object_c) = (34.0, 24.0);
    let copper = find("copper").expect("copper");
    let contact = Contact::<f64>::new((&SKIN, skin_c), (copper, object_c), &REFERENCE_DISPLAY, 0.0);
    for t_s in [0.0, 1e-3, 1e9] {
        let at = contact.at(t_s);
        assert_eq!((at.skin_c, at.object_c, at.flux_w_m2), (skin_c, object_c, 0.0));
    }
}

/// Eq. 6-7 approaches Eq. 3-3 with the opposite sign; the difference is `1 / (2 z²)`, the next term of `erfcx`.
#[test]
fn flux_approaches_that_of_perfect_contact_as_resistance_vanishes() {
    for (name, object) in &MATERIALS {
        let contact = Contact::<f64>::new((&SKIN, 34.0), (object, 24.0), &REFERENCE_DISPLAY, 1e12);
        let perfect = SemiInfinite::new((&SKIN, 34.0), (object, 24.0));
        for t_s in [1e-3, 1.0, 1e3] {
            let limit = -perfect.flux_w_m2(t_s).expect("after landing");
            let difference = 0.51 / (contact.rate_per_s * t_s) + 1e-12;
            assert!(relative(contact.at(t_s).flux_w_m2, limit) < difference, "{name} at {t_s} s");
        }
        assert_eq!(perfect.flux_w_m2(0.0), None);
        assert_eq!(perfect.skin_at_depth(1e-3, 0.0), 34.0);
    }
}

#[test]
fn every_material_is_found_by_its_name() {
    for (name, material) in &MATERIALS {
        assert_eq!(find(name), Some(material));
    }
    assert!(THESIS_MATERIALS.iter().all(|name| find(name).is_some()));
    for unknown in ["Copper", "copper-", "coppe", ""] {
        assert_eq!(find(unknown), None);
    }
}

/// Section 6.4.2: 0.73, 1.68, 3.14, 5.90 and 10.98 kPa at 0.1, 0.25, 0.5, 1 and 2 N.
#[test]
fn pressure_equals_the_five_points_of_the_thesis_and_area_is_constant_outside_them() {
    for (force, pressure) in
        [(0.1, 730.0), (0.25, 1680.0), (0.5, 3140.0), (1.0, 5900.0), (2.0, 10980.0)]
    {
        assert!(relative(pressure_pa(force), pressure) < 1e-12);
    }
    assert_eq!(contact_area_m2(0.0), contact_area_m2(0.1));
    assert_eq!(contact_area_m2(2.0), contact_area_m2(9.0));
    let middle = (contact_area_m2(0.5) + contact_area_m2(1.0)) / 2.0;
    assert!(relative(contact_area_m2(0.75), middle) < 1e-12);
}
