//! Invariants of the fixed-point path; `budgets` measures its errors.

use contact_model::fixed_point::{
    Celsius, Contact, Force, Fraction, Pairing, PairingError, Rate, Ticks, erfcx, log2_relative_pressure,
};
use contact_model::material::{MATERIALS, Material, REFERENCE_DISPLAY, SKIN, find};
use contact_model::reference;
use proptest::prelude::*;

/// One unit of `E`.
const UNIT: f64 = 1.0 / 4_294_967_296.0;
/// Stated error of the kernel, in units.
const KERNEL_UNITS: f64 = 9.0;

fn e_of(elapsed: u32, per_tick: Rate) -> f64 {
    f64::from(erfcx(Ticks::new(elapsed).expect("in range"), per_tick).to_bits()) * UNIT
}

/// The exact `E`, as close as it can be had in `f64`, but not above the largest fraction.
fn truth(elapsed: u32, per_tick: Rate) -> f64 {
    reference::erfcx((f64::from(elapsed) * per_tick.to_f64()).sqrt()).min(1.0 - UNIT)
}

#[test]
fn kernel_saturates_for_the_longest_contact_and_the_extreme_rates() {
    for exponent in [-1022, -300, -65, 64, 300, 1023] {
        let per_tick = Rate::from_f64(f64::from(exponent).exp2()).expect("normal");
        for elapsed in [1, 1000, Ticks::MAX.get()] {
            assert!((e_of(elapsed, per_tick) - truth(elapsed, per_tick)).abs() <= KERNEL_UNITS * UNIT);
        }
    }
    assert_eq!(
        erfcx(Ticks::MAX, Rate::from_f64(1e300).expect("normal")),
        Fraction::ZERO
    );
}

proptest! {
    #[test]
    fn kernel_holds_for_any_elapsed_time_and_rate(
        elapsed in 1..=Ticks::MAX.get(),
        exponent in -90i32..70,
        fraction in 0.0..1.0f64,
    ) {
        let per_tick = Rate::from_f64((1.0 + fraction) * f64::from(exponent).exp2()).expect("normal");
        let error = e_of(elapsed, per_tick) - truth(elapsed, per_tick);
        prop_assert!(error.abs() <= KERNEL_UNITS * UNIT, "{} units", error / UNIT);
    }

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
    assert!(matches!(
        Pairing::new(&copper, &copper, &REFERENCE_DISPLAY, 0.0),
        Err(PairingError::Property { name: "tick (s)", .. })
    ));
    let with_skin = |change: fn(&mut Material)| {
        let mut skin = SKIN;
        change(&mut skin);
        Pairing::new(&skin, &copper, &REFERENCE_DISPLAY, 1e-3)
    };
    assert!(matches!(
        with_skin(|m| m.specific_heat_j_kgk = f64::NAN),
        Err(PairingError::Property { .. })
    ));
    assert!(matches!(
        with_skin(|m| m.surface.conductivity_w_mk = 1e-300),
        Err(PairingError::Rate(_))
    ));
}
