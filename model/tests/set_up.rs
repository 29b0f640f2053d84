//! Set-up of the fixed-point path from materials, and the range of its outputs.

use contact_model::fixed_point::{
    Celsius, Contact, ContactPair, ContactPairError, Force, log2_relative_pressure,
};
use contact_model::material::{MATERIALS, Material, REFERENCE_DISPLAY, SKIN, find};
use proptest::prelude::*;

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
        let response = contact.at(elapsed, Celsius::from_num(skin), Celsius::from_num(object));
        let is_between = |t: Celsius| {
            t.to_num::<f64>() >= skin.min(object) - 2e-6 && t.to_num::<f64>() <= skin.max(object) + 2e-6
        };
        prop_assert!(is_between(response.skin()) && is_between(response.object()));
        prop_assert!((response.object() < response.skin() + Celsius::DELTA * 8) == (object <= skin + 1e-6)
            || (response.object() - response.skin()).abs() < Celsius::DELTA * 8);
    }
}

fn fixed_contact(object: &Material, force_n: f64, tick_s: f64) -> Contact {
    ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, tick_s)
        .expect("material within the range")
        .at_pressure(log2_relative_pressure(Force::from_num(force_n)))
}

#[test]
fn material_outside_the_range_is_refused_with_the_name_of_the_property() {
    let copper = *find("copper").expect("material");
    let with = |change: fn(&mut Material)| {
        let mut material = copper;
        change(&mut material);
        ContactPair::new(&SKIN, &material, &REFERENCE_DISPLAY, 1e-3)
    };
    assert_eq!(
        with(|m| m.density_kg_m3 = -1.0),
        Err(ContactPairError::Property { name: "density (kg/m3)", value: -1.0 })
    );
    assert!(with(|m| m.surface.roughness_um = f64::NAN).is_err());
    assert!(with(|m| m.surface.slope_rad = f64::INFINITY).is_err());
    assert!(matches!(with(|m| m.surface.slope_rad = 1e4), Err(ContactPairError::Ratio(_))));
    assert!(with(|_| ()).is_ok());
    assert!(matches!(
        ContactPair::new(&copper, &copper, &REFERENCE_DISPLAY, 0.0),
        Err(ContactPairError::Property { name: "tick (s)", .. })
    ));
    let with_skin = |change: fn(&mut Material)| {
        let mut skin = SKIN;
        change(&mut skin);
        ContactPair::new(&skin, &copper, &REFERENCE_DISPLAY, 1e-3)
    };
    assert!(matches!(
        with_skin(|m| m.specific_heat_j_kgk = f64::NAN),
        Err(ContactPairError::Property { .. })
    ));
    assert!(matches!(
        with_skin(|m| m.surface.conductivity_w_mk = 1e-300),
        Err(ContactPairError::OutOfRange(_))
    ));
}
