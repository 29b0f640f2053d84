//! Skin and object as bodies: against Eq. 6-5, against the same impedances in `f64`, and under any input.

extern crate std;

use std::vec::Vec;

use contact_model::contact_law::ContactLaw;
use contact_model::finger::{FingerProperties, MEAN, THESIS};
use contact_model::fixed_point::{
    Body, ContactPair, FingerBody, Force, OwnContactLaw, ScaledBody, contact_area,
    log2_relative_pressure, to_fixed,
};
use contact_model::impedance::{Impedance, Relaxation};
use contact_model::material::{MATERIALS, Material, REFERENCE_DISPLAY, SKIN};
use contact_model::pressure::pressure_pa;
use contact_model::reference::{Contact, contact_resistance};
use contact_model::slab::{Back, Slab};
use fixed::types::I4F28;
use proptest::prelude::*;

use super::*;
use crate::estimate::FingerEstimator;

const TICK_S: f64 = 1e-3;
const SKIN_C: f64 = 34.0;
const OBJECT_C: f64 = 24.0;
const DIFFERENCE_K: f64 = SKIN_C - OBJECT_C;
const FORCE_N: f64 = 2.0;
/// First tick whose temperatures are compared: before it the tick is too coarse for the transient.
const FROM_TICK: usize = 10;
/// Largest error of the simulated skin for a contact of 10 K, K.
const SKIN_MAX_K: f64 = 8e-3;
/// The same of the object's surface, which changes faster: foam's takes on the skin's temperature in the first ticks.
const OBJECT_MAX_K: f64 = 35e-3;

fn pair(object: &Material) -> ContactPair {
    ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, TICK_S).expect("a valid pair")
}

fn body(impedance: &Impedance<'_>) -> Body {
    Body::new(impedance, SKIN.effusivity(), TICK_S).expect("a valid body")
}

/// Cooling of the simulated skin and warming of the object's surface at the end of each tick, K.
fn simulated(
    material: &Material,
    finger: &FingerBody,
    object: ScaledBody,
    ticks: usize,
) -> Vec<(f64, f64)> {
    let pair = pair(material);
    let contact = pair.at_pressure(log2_relative_pressure(Force::from_num(FORCE_N)));
    let conductance = contact.conductance_of(&finger.tissue, &object, &OwnResistances::NONE);
    let bodies = Bodies {
        finger: *finger,
        object,
        resistances: OwnResistances::NONE,
        are_half_spaces: false,
    };
    let before = BodiesBeforeContact {
        bodies: &bodies,
        skin_above_object: Celsius::from_num(DIFFERENCE_K),
        skin_above_room: Celsius::from_num(DIFFERENCE_K),
    };
    let mut skin = SkinOnObject::default();
    skin.start_from_skin_on_display(&SkinState::default(), &bodies);
    (0..ticks)
        .map(|_| {
            let (mut skin_before, warming) = (skin.skin, skin.object);
            skin.step_bodies(Some(&conductance), &before);
            let into_skin = flux_beyond_air(
                finger,
                Some(skin.scaled_flux),
                Celsius::ZERO,
                before.skin_above_room,
            );
            let cooling = skin_before.tissue().expect("a finger's tissue");
            let cooling = cooling.response_to(into_skin, &finger.tissue.relaxations());
            let flux = object.scaled(skin.scaled_flux);
            let warming = warming.response_to(flux, &object.body.relaxations());
            (cooling.to_num(), warming.to_num())
        })
        .collect()
}

/// The same of the impedances in `f64`, implicitly in steps of a twentieth of a tick.
fn exact(
    finger: &FingerProperties,
    object: &Impedance<'_>,
    resistance_m2k_w: f64,
    ticks: usize,
) -> Vec<(f64, f64)> {
    const STEPS: u32 = 20;
    let step_s = TICK_S / f64::from(STEPS);
    let coefficients = |impedance: &Impedance<'_>| {
        let term = |one: &Relaxation| {
            let decay = libm::exp(-one.rate_1_s * step_s);
            let only = [*one];
            let only = Impedance { direct_m2k_w: 0.0, relaxations: &only };
            (decay, only.step_response(step_s), 0.0f64)
        };
        let terms: Vec<_> = impedance.relaxations.iter().map(term).collect();
        let gain: f64 = terms.iter().map(|(_, gain, _)| gain).sum();
        (terms, impedance.direct_m2k_w + gain)
    };
    let (mut skin, skin_gain) = coefficients(&finger.impedance);
    let (mut object, object_gain) = coefficients(object);
    let air_w_m2 = finger.air_w_m2k * DIFFERENCE_K;
    let free = |terms: &[(f64, f64, f64)]| -> f64 { terms.iter().map(|(a, _, x)| a * x).sum() };
    let advance = |terms: &mut [(f64, f64, f64)], flux_w_m2: f64| {
        for (decay, gain, state) in terms {
            *state = *decay * *state + *gain * flux_w_m2;
        }
    };
    let mut tick = || {
        let mut surfaces = (0.0, 0.0);
        for _ in 0..STEPS {
            let (cooling, warming) = (free(&skin) - skin_gain * air_w_m2, free(&object));
            let flux_w_m2 =
                (DIFFERENCE_K - cooling - warming) / (resistance_m2k_w + skin_gain + object_gain);
            surfaces = (cooling + skin_gain * flux_w_m2, warming + object_gain * flux_w_m2);
            advance(&mut skin, flux_w_m2 - air_w_m2);
            advance(&mut object, flux_w_m2);
        }
        surfaces
    };
    (0..ticks).map(|_| tick()).collect()
}

fn unscaled(body: &Body) -> ScaledBody {
    ScaledBody { body: *body, factor: U16F16::ONE }
}

fn resistance_m2k_w(object: &Material) -> f64 {
    contact_resistance(&SKIN.surface, &object.surface, pressure_pa(FORCE_N))
}

#[test]
fn half_spaces_as_bodies_agree_with_equation_6_5() {
    let finger = FingerBody::new(&THESIS, TICK_S).expect("the thesis's finger");
    let mut worst_k = (0.0f64, 0.0f64);
    for (name, material) in &MATERIALS {
        let object = ScaledBody {
            body: finger.tissue,
            factor: to_fixed(SKIN.effusivity() / material.effusivity()),
        };
        let contact = Contact::new(
            (&SKIN, SKIN_C),
            (material, OBJECT_C),
            &REFERENCE_DISPLAY,
            pressure_pa(FORCE_N),
        );
        let simulated = simulated(material, &finger, object, 20_000);
        for (tick, (cooling_k, warming_k)) in simulated.iter().enumerate().skip(FROM_TICK) {
            let exact = contact.at((tick + 1) as f64 * TICK_S);
            let skin_k = (SKIN_C - cooling_k - exact.skin_c).abs();
            let object_k = (OBJECT_C + warming_k - exact.object_c).abs();
            assert!(
                skin_k < SKIN_MAX_K && object_k < OBJECT_MAX_K,
                "{name}, {tick} ms: {skin_k} K, {object_k} K"
            );
            worst_k = (skin_k.max(worst_k.0), object_k.max(worst_k.1));
        }
    }
    std::println!("half-spaces: {worst_k:?} K");
}

#[test]
fn bodies_agree_with_their_impedances_in_f64() {
    let mut worst_k = (0.0f64, 0.0f64);
    for finger in [&THESIS, &MEAN] {
        let in_fixed_point = FingerBody::new(finger, TICK_S).expect("a finger");
        for (name, material) in &MATERIALS {
            for (thickness_mm, back) in [
                (0.5, Back::Insulated),
                (3.0, Back::Insulated),
                (3.0, Back::Held),
                (3.0, Back::Film(20.0)),
                (20.0, Back::Insulated),
            ] {
                let slab = Slab {
                    thickness_m: 1e-3 * thickness_mm,
                    conductivity_w_mk: material.surface.conductivity_w_mk,
                    capacity_j_m3k: material.volumetric_heat_j_m3k(),
                    back,
                }
                .relaxations();
                let impedance = slab.impedance();
                let simulated =
                    simulated(material, &in_fixed_point, unscaled(&body(&impedance)), 3000);
                let exact = exact(finger, &impedance, resistance_m2k_w(material), 3000);
                for (tick, (is, should)) in simulated.iter().zip(exact).enumerate().skip(FROM_TICK)
                {
                    let (skin_k, object_k) = ((is.0 - should.0).abs(), (is.1 - should.1).abs());
                    assert!(
                        skin_k < SKIN_MAX_K && object_k < OBJECT_MAX_K,
                        "{name}, {thickness_mm} mm, {back:?}, {tick} ms: {skin_k} K, {object_k} K"
                    );
                    worst_k = (skin_k.max(worst_k.0), object_k.max(worst_k.1));
                }
            }
        }
    }
    std::println!("bodies: {worst_k:?} K");
}

/// A passive body: relaxations of any rate, and gains from those of copper to those of foam.
fn relaxations() -> impl Strategy<Value = Vec<Relaxation>> {
    let one = (prop_oneof![Just(0.0), 1e-3..690.0f64], -7.5..-2.0f64);
    prop::collection::vec(one, 1..9).prop_map(|all| {
        let one = |(rate_1_s, exponent): (f64, f64)| Relaxation {
            rate_1_s,
            gain_m2k_j: libm::pow(10.0, exponent),
        };
        all.into_iter().map(one).collect()
    })
}

fn any_body() -> impl Strategy<Value = Body> {
    (relaxations(), 0.0..1e-2f64).prop_filter_map("cannot be followed", |(all, direct_m2k_w)| {
        let impedance = Impedance { direct_m2k_w, relaxations: &all };
        Body::new(&impedance, SKIN.effusivity(), TICK_S).ok()
    })
}

/// None, or one of any that a host may tell.
fn law() -> impl Strategy<Value = Option<OwnContactLaw>> {
    let any = (ContactLaw::EXPONENTS, ContactLaw::HARDNESSES_PA, ContactLaw::GAPS_W_M2K);
    prop::option::of(any).prop_map(|law| {
        let (exponent, hardness_pa, gap_w_m2k) = law?;
        let law = ContactLaw { exponent, hardness_pa, gap_w_m2k };
        OwnContactLaw::new(&law, TICK_S)
    })
}

fn any_celsius() -> impl Strategy<Value = Celsius> {
    prop_oneof![
        any::<i32>().prop_map(Celsius::from_bits),
        (-20.0..60.0f64).prop_map(Celsius::from_num),
    ]
}

proptest! {
    /// Skin and object stay between their temperatures before contact, and the skin is nowhere colder than the object.
    #[test]
    fn passive_bodies_stay_between_their_temperatures(
        finger in any_body(),
        object in any_body(),
        material in 0..MATERIALS.len(),
    ) {
        let finger = FingerBody { tissue: finger, air: Fraction::ZERO };
        let small_k = 4e-3 * DIFFERENCE_K;
        for (cooling_k, warming_k) in simulated(&MATERIALS[material].1, &finger, unscaled(&object), 3000) {
            prop_assert!(cooling_k > -small_k && warming_k > -small_k, "{cooling_k}, {warming_k}");
            prop_assert!(cooling_k + warming_k < DIFFERENCE_K + small_k, "{cooling_k}, {warming_k}");
        }
    }

    /// Nothing panics or overflows, and the display never takes more heat than the conductance lets through.
    #[test]
    fn any_inputs_keep_the_states_bounded(
        fingers in prop::collection::vec((any_body(), any::<u32>()), 2),
        objects in prop::collection::vec(any_body(), 2),
        material in 0..MATERIALS.len(),
        events in prop::collection::vec(
            (any_celsius(), any_celsius(), any_celsius(), prop::option::of(any::<u32>()), 0..3usize, (0..2usize, any::<u32>()), (any::<i32>(), any::<u32>(), law()), any::<bool>(), 1..300u32),
            1..20,
        ),
    ) {
        let fingers: Vec<_> = fingers.into_iter()
            .map(|(tissue, air)| FingerBody { tissue, air: Fraction::from_bits(air) })
            .collect();
        let pair = pair(&MATERIALS[material].1);
        let factors = ContactPairFactors::new(&pair, &OwnResistances::NONE);
        let mut estimator = FingerEstimator::default();
        let mut skin = SkinOnObject::default();
        for (skin_c, room_c, other, force, finger, (object, factor), (skin_factor, layer, law), restart, ticks) in events {
            let force = force.map(Force::from_bits);
            // The third finger stands for the thesis's path without bodies.
            let bodies = Bodies {
                finger: *fingers.get(finger).unwrap_or(&FingerBody::THESIS),
                object: ScaledBody { body: objects[object], factor: U16F16::from_bits(factor) },
                resistances: OwnResistances {
                    skin_factor: I4F28::from_bits(skin_factor),
                    display_layer: U16F16::from_bits(layer),
                    law,
                },
                are_half_spaces: finger == fingers.len(),
            };
            if restart {
                skin.start_from_skin_on_display(estimator.skin_state_on_display(), &bodies);
                estimator.forget_conductances();
            }
            let before = BodiesBeforeContact {
                bodies: &bodies,
                skin_above_object: other,
                skin_above_room: skin_c.saturating_sub(room_c),
            };
            for _ in 0..ticks {
                estimator.update_by_readings(skin_c, room_c, force, 2);
                let heat = estimator.step_skin_heat_flow(&pair, &bodies, other);
                let conductance = estimator.contact().and_then(|contact| contact.stored_conductances()).copied();
                let object = conductance.as_ref().map(|both| &both.object);
                if bodies.are_half_spaces {
                    skin.step(object, &factors, other);
                    let on_display = force.is_none().then_some(estimator.skin_state_on_display());
                    let _ = skin.setpoint(&factors, skin_c, other, on_display);
                } else {
                    let changes = skin.step_bodies(object, &before);
                    let ratio = conductance.map_or(factors.ratio_at_landing, |both| both.ratio);
                    let _ = changes.setpoint(ratio, skin_c, other);
                }
                if let Some(both) = conductance {
                    let bodies = (!bodies.are_half_spaces).then_some(&bodies);
                    let _ = skin.skin_matching_correction(estimator.skin_state_on_display(), &both.display, bodies);
                }
                prop_assert!(force.is_some_and(|force| contact_area(force) > 0) || heat == 0);
            }
        }
    }
}
