//! The fixed-point path against golden values, the reference and its own invariants.

mod golden;

use contact_model::fixed_point::{
    Celsius, Contact, Force, Pairing, PairingError, exp2, log2, log2_relative_pressure,
};
use contact_model::material::{MATERIALS, Material, REFERENCE_DISPLAY, SKIN, find};
use contact_model::pressure;
use golden::{number, rows};
use proptest::prelude::*;

/// One unit of `E`.
const UNIT: f64 = 1.0 / 4_294_967_296.0;

proptest! {
    #[test]
    fn response_stays_between_skin_and_object(
        skin in -40.0..125.0f64,
        object in -40.0..125.0f64,
        index in 0..MATERIALS.len(),
        elapsed in 0u32..,
        force in 0.001..20.0f64,
    ) {
        let contact = fixed_contact(&MATERIALS[index].1, force, 1e-3);
        let at = contact.at(elapsed, Celsius::from_num(skin), Celsius::from_num(object));
        let between = |t: Celsius| {
            t.to_num::<f64>() >= skin.min(object) - 2e-6 && t.to_num::<f64>() <= skin.max(object) + 2e-6
        };
        prop_assert!(between(at.skin()) && between(at.object()));
        prop_assert!((at.object() <= at.skin() + Celsius::DELTA * 8) == (object <= skin + 1e-6)
            || (at.object() - at.skin()).abs() < Celsius::DELTA * 8);
    }
}

fn fixed_contact(object: &Material, force_n: f64, tick_s: f64) -> Contact {
    Pairing::new(&SKIN, object, &REFERENCE_DISPLAY, tick_s)
        .expect("pairing")
        .under(log2_relative_pressure(Force::from_num(force_n)))
}

/// The whole chain, from properties and force to Eq. 6-5, 6-6, 6-7 and 6-12.
#[test]
fn chain_meets_golden_values() {
    let mut worst = [0.0f64; 4];
    for row in rows("contact") {
        let t_s = number(&row, "t_s");
        // The pressures of section 6.4.2 are reached by force; that of section 6.3 is not.
        if !row["condition"].starts_with("val") || t_s == 0.0 {
            continue;
        }
        let object = find(&row["material"]).expect("material");
        let contact = fixed_contact(object, number(&row, "force_N"), t_s);
        let (skin, object_c) = (number(&row, "T_skin_i_C"), number(&row, "T_object_i_C"));
        let at = contact.at(1, Celsius::from_num(skin), Celsius::from_num(object_c));
        let step = (skin - object_c).abs();
        let bound = step / f64::from(1 << 20) + 1e-6;
        let flux_scale = step / number(&row, "R_skin_object_m2K_W");
        let errors = [
            (at.skin().to_num::<f64>() - number(&row, "T_skin_s_C")).abs() / bound,
            (at.object().to_num::<f64>() - number(&row, "T_object_s_C")).abs() / bound,
            (at.display().to_num::<f64>() - number(&row, "T_display_C")).abs() / bound,
            (at.flux_w_m2().to_num::<f64>() - number(&row, "q_W_m2")).abs() / flux_scale * f64::from(1 << 20),
        ];
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error);
        }
        assert!(errors.iter().all(|e| *e < 1.0), "{errors:?} {row:?}");
    }
    println!("worst share of the bound: skin, object, display, flux {worst:.3?}");
}

#[test]
fn interface_temperature_meets_golden_values() {
    for row in rows("semi_infinite") {
        let object = find(&row["material"]).expect("material");
        let pairing = Pairing::new(&SKIN, object, &REFERENCE_DISPLAY, 1e-3).expect("pairing");
        let t = pairing.interface_temperature(
            Celsius::from_num(number(&row, "T_skin_i_C")),
            Celsius::from_num(number(&row, "T_material_i_C")),
        );
        assert!(
            (t.to_num::<f64>() - number(&row, "T_s_C")).abs() < 1e-6,
            "{row:?}"
        );
    }
}

#[test]
fn logarithm_and_power_stay_within_their_stated_errors() {
    let (mut worst_log, mut worst_exp) = (0.0f64, 0.0f64);
    for i in 0..1u32 << 20 {
        // Walks over all magnitudes.
        let x = (i.wrapping_mul(2_654_435_761) | 1) >> (i % 32);
        let x = x.max(1);
        worst_log = worst_log.max((log2(x).to_num::<f64>() - f64::from(x).log2()).abs());
        let f = i << 12 | i >> 8;
        let power = (31.0 + f64::from(f) * UNIT).exp2();
        worst_exp = worst_exp.max((f64::from(exp2(f)) / power - 1.0).abs());
    }
    println!(
        "log2: {:.2} * 2^-24, exp2: {:.2} * 2^-32",
        worst_log * 2f64.powi(24),
        worst_exp / UNIT
    );
    assert!(worst_log < 2f64.powi(-23), "{worst_log:e}");
    assert!(worst_exp < 2f64.powi(-27), "{worst_exp:e}");
}

#[test]
fn streaming_pressure_agrees_with_the_reference() {
    for milli in 1..20_000 {
        let force = Force::from_num(f64::from(milli) * 1e-3);
        let expected =
            (pressure::pressure_pa(force.to_num()) / contact_model::material::SKIN_MICROHARDNESS_PA).log2();
        let error = log2_relative_pressure(force).to_num::<f64>() - expected;
        assert!(error.abs() < 2f64.powi(-21), "{force} N: {error:e}");
    }
}

#[test]
fn a_material_that_does_not_fit_is_refused_by_name() {
    let copper = *find("copper").expect("material");
    let with = |change: fn(&mut Material)| {
        let mut material = copper;
        change(&mut material);
        Pairing::new(&SKIN, &material, &REFERENCE_DISPLAY, 1e-3)
    };
    assert_eq!(
        with(|m| m.density_kg_m3 = -1.0),
        Err(PairingError::Property {
            name: "density (kg/m3)",
            value: -1.0
        })
    );
    assert!(with(|m| m.surface.roughness_um = f64::NAN).is_err());
    assert!(with(|m| m.surface.slope_rad = f64::INFINITY).is_err());
    assert!(matches!(
        with(|m| m.surface.slope_rad = 1e4),
        Err(PairingError::Ratio(_))
    ));
    assert!(with(|_| ()).is_ok());
}
