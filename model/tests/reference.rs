//! The f64 and f32 references against golden values.

mod golden;

use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN, find};
use contact_model::pressure::{contact_area_m2, pressure_pa};
use contact_model::reference::{Contact, contact_resistance, erfcx, interface_temperature};
use golden::{number, rows};

fn relative(value: f64, truth: f64) -> f64 {
    if value == truth {
        0.0
    } else {
        (value / truth - 1.0).abs()
    }
}

#[test]
fn erfcx_f64_stays_within_its_stated_error() {
    let worst = rows("erfcx")
        .iter()
        .map(|row| relative(erfcx(number(row, "x")), number(row, "erfcx")))
        .fold(0.0, f64::max);
    assert!(worst < 1e-14, "{worst:e}");
}

#[test]
fn erfcx_f32_stays_within_its_stated_error_and_never_overflows() {
    let exact_in_f32 = rows("erfcx").into_iter().filter(|row| row["f32_exact"] == "1");
    let worst = exact_in_f32
        .map(|row| (erfcx(number(&row, "x") as f32), number(&row, "erfcx")))
        .filter(|(_, truth)| *truth > f64::from(f32::MIN_POSITIVE))
        .map(|(value, truth)| relative(f64::from(value), truth))
        .fold(0.0, f64::max);
    assert!(worst < 1.5e-6, "{worst:e}");
}

#[test]
fn response_follows_equations_6_5_to_6_12() {
    for row in rows("contact") {
        let object = find(&row["material"]).expect("material");
        let contact = Contact::<f64>::new(
            (&SKIN, number(&row, "T_skin_i_C")),
            (object, number(&row, "T_object_i_C")),
            &REFERENCE_DISPLAY,
            number(&row, "P_Pa"),
        );
        let at = contact.at(number(&row, "t_s"));
        assert!(relative(contact.resistance_m2k_w, number(&row, "R_skin_object_m2K_W")) < 1e-13);
        assert!(relative(contact.ratio, number(&row, "ratio_Rdisp_Robj")) < 1e-13);
        assert!(relative(at.erfcx, number(&row, "erfcx_z")) < 1e-13, "{row:?}");
        assert!((at.skin_c - number(&row, "T_skin_s_C")).abs() < 1e-11, "{row:?}");
        assert!(
            (at.object_c - number(&row, "T_object_s_C")).abs() < 1e-11,
            "{row:?}"
        );
        assert!(
            (at.display_c - number(&row, "T_display_C")).abs() < 1e-11,
            "{row:?}"
        );
        assert!(relative(at.flux_w_m2, number(&row, "q_W_m2")) < 1e-12, "{row:?}");
    }
}

#[test]
fn skin_at_depth_meets_golden_values() {
    for row in rows("contact_interior") {
        let object = find(&row["material"]).expect("material");
        let skin_c = number(&row, "T_skin_i_C");
        let mut contact = Contact::<f64>::new(
            (&SKIN, skin_c),
            (object, number(&row, "T_object_i_C")),
            &REFERENCE_DISPLAY,
            1e4,
        );
        // The rows give R, not the pressure.
        let r = number(&row, "R_m2K_W");
        contact.rate_per_s *= (contact.resistance_m2k_w / r).powi(2);
        let t = contact.skin_at_depth(&SKIN, number(&row, "x_m"), number(&row, "t_s"));
        assert!((t - number(&row, "T_skin_x_t_C")).abs() < 1e-10, "{t} {row:?}");
    }
}

#[test]
fn resistance_follows_equations_6_8_to_6_11() {
    for row in rows("resistance") {
        let object = find(&row["material"]).expect("material");
        let r = contact_resistance(&SKIN.surface, &object.surface, number(&row, "P_Pa"));
        assert!(relative(r, number(&row, "R_m2K_W")) < 1e-13, "{row:?}");
    }
}

#[test]
fn interface_temperature_follows_equation_3_1() {
    for row in rows("semi_infinite") {
        let object = find(&row["material"]).expect("material");
        assert!(
            relative(object.effusivity(), number(&row, "e_from_k_rho_c")) < 1e-14,
            "{row:?}"
        );
        let t = interface_temperature(
            &SKIN,
            number(&row, "T_skin_i_C"),
            object,
            number(&row, "T_material_i_C"),
        );
        assert!((t - number(&row, "T_s_C")).abs() < 1e-12, "{row:?}");
    }
}

#[test]
fn every_material_of_the_thesis_is_found_by_its_name() {
    for (name, material) in &MATERIALS {
        assert_eq!(find(name), Some(material));
    }
    assert_eq!(find("Copper"), None);
}

/// Section 6.4.2: 0.73, 1.68, 3.14, 5.90 and 10.98 kPa at 0.1, 0.25, 0.5, 1 and 2 N.
#[test]
fn pressure_meets_the_stated_points_and_area_is_constant_outside() {
    for (force, pressure) in [
        (0.1, 730.0),
        (0.25, 1680.0),
        (0.5, 3140.0),
        (1.0, 5900.0),
        (2.0, 10980.0),
    ] {
        assert!(relative(pressure_pa(force), pressure) < 1e-12);
    }
    assert_eq!(contact_area_m2(0.0), contact_area_m2(0.1));
    assert_eq!(contact_area_m2(2.0), contact_area_m2(9.0));
    let middle = (contact_area_m2(0.5) + contact_area_m2(1.0)) / 2.0;
    assert!(relative(contact_area_m2(0.75), middle) < 1e-12);
}
