//! What holds for any input.

use std::vec::Vec;

use contact_model::fixed_point::{Celsius, WEIGHTS};
use proptest::prelude::*;

use super::contacts::{learner_of, learnt, new_learner, sensor};
use super::random::Random;
use super::simulation::*;
use crate::{
    ContactInput, Distrust, Flux, FluxSensor, Learner, LearnerInput, LearnerOutput, PersonPrior,
    PlaceBeforeContact, Resistance, Restart, Trust,
};

fn place() -> impl Strategy<Value = PlaceBeforeContact> {
    prop_oneof![Just(PlaceBeforeContact::Air), Just(PlaceBeforeContact::Pad)]
}

/// Nothing, or any bytes.
fn person() -> impl Strategy<Value = Option<PersonPrior>> {
    prop::option::of(any::<[u8; PersonPrior::BYTES]>().prop_map(PersonPrior))
}

/// Any bits, and values near those of contacts.
fn bits() -> impl Strategy<Value = i32> {
    prop_oneof![any::<i32>(), -0x400_0000..0x400_0000, Just(0), Just(i32::MIN), Just(i32::MAX)]
}

fn contact() -> impl Strategy<Value = ContactInput> {
    (any::<u8>(), bits(), bits(), bits(), prop_oneof![any::<u32>(), 0..2000u32], any::<bool>())
        .prop_map(|(touching_ticks, above, air, resistance, ticks_since_landing, is_steady)| {
            ContactInput {
                touching_ticks,
                skin_above_display_k: Celsius::from_bits(above),
                air_flux_w_m2: Flux::from_bits(air),
                resistance_mm2k_w: Resistance::from_bits(resistance as u32),
                ticks_since_landing,
                is_steady,
            }
        })
}

fn input() -> impl Strategy<Value = LearnerInput> {
    let restart =
        (place(), person()).prop_map(|(place, person)| Restart { place, sensor: sensor(), person });
    let restart = prop::option::weighted(0.02, restart);
    (
        any::<u16>(),
        restart,
        prop::option::weighted(0.95, bits()),
        prop::option::weighted(0.9, contact()),
    )
        .prop_map(|(sequence, restart, flux, contact)| LearnerInput {
            sequence,
            restart,
            flux_w_m2: flux.map(Flux::from_bits),
            contact,
        })
}

fn assert_within_limits(output: &LearnerOutput) {
    let within = |value: f64, low: f64, high: f64| {
        assert!((low - 1e-6..=high + 1e-6).contains(&value), "{output:?}")
    };
    for weight in output.weights {
        within(weight.to_num(), 0.4, 2.0);
    }
    within(output.air_flux_deviation.to_num(), -2.5, 2.5);
    within(output.skin_offset_k.to_num(), -0.3, 0.3);
    within(output.resistance_factor.to_num(), 0.4, 2.5);
    within(output.parameters[0].to_num(), -3.5, 3.5);
    within(output.parameters[1].to_num(), -7.0, 7.0);
    for variance in output.variances {
        assert!(variance > 0 && variance <= 1.25, "{output:?}");
    }
}

proptest! {
    #[test]
    fn any_inputs_give_outputs_within_their_limits(
        lag_us in prop_oneof![any::<u32>(), 0..100_000u32],
        resistance in any::<u32>(),
        place in place(),
        person in person(),
        inputs in prop::collection::vec(input(), 1..300),
    ) {
        let sensor = FluxSensor::new(lag_us, Resistance::from_bits(resistance));
        let mut learner = Learner::new();
        learner.restart(Restart { place, sensor, person });
        for input in inputs {
            let output = learner.advance(&input);
            prop_assert_eq!(output.sequence, input.sequence);
            assert_within_limits(output);
        }
    }
}

/// Inputs of the mean finger on copper; of a dead sensor if it is not sound.
fn inputs(is_sound: bool) -> Vec<LearnerInput> {
    let finger = Finger::mean(PlaceBeforeContact::Air);
    let reported = |flux: f64, _| if is_sound { flux } else { 0.0 };
    let scene = Scene {
        finger: &finger,
        object: OBJECTS[0],
        force_n: 2.0,
        ticks: 800,
        errors: Errors::NONE,
        reported: &reported,
    };
    scene.inputs(&mut Random(0), 0)
}

const LIFTED: LearnerInput =
    LearnerInput { sequence: 0, restart: None, flux_w_m2: Some(Flux::ZERO), contact: None };

#[test]
fn distrusted_finger_becomes_the_mean_one_until_the_next_landing() {
    let mut learner = new_learner(PlaceBeforeContact::Air);
    let outputs: Vec<_> = inputs(false).iter().map(|input| *learner.advance(input)).collect();
    let at = outputs.iter().position(|output| output.trust == Trust::Mean(Distrust::Sensor));
    let at = at.expect("a distrust");
    // A tenth of a second later little is left, after a second nothing.
    for (after, left) in [(10, 0.06), (70, 1e-8)] {
        let weights = outputs[at + after].weights;
        assert!(weights.iter().all(|weight| (weight.to_num::<f64>() - 1.0).abs() < left));
        let factor: f64 = outputs[at + after].resistance_factor.to_num();
        assert!((factor - 1.0).abs() < left);
    }
    assert_eq!(learner.advance(&LIFTED).trust, Trust::Mean(Distrust::Sensor));
    let mut again = inputs(true);
    // The first window of the contact is not learnt from.
    again[2].contact.as_mut().expect("a contact").is_steady = false;
    let again: Vec<_> = again.iter().map(|input| *learner.advance(input)).collect();
    // So all is as before the first contact.
    let new = *new_learner(PlaceBeforeContact::Air).advance(&LIFTED);
    assert_eq!(again[2].trust, Trust::Learning);
    assert_eq!((again[2].parameters, again[2].variances), (new.parameters, new.variances));
    assert_eq!(again.last().map(|output| output.trust), Some(Trust::Trusted));
}

#[test]
fn finger_is_kept_between_contacts_with_wider_deviations_until_a_restart() {
    let mut learner = new_learner(PlaceBeforeContact::Air);
    let new = *learner.clone().advance(&LIFTED);
    let last = (inputs(true).iter()).fold(new, |_, input| *learner.advance(input));
    let lifted = *learner.advance(&LIFTED);
    assert_eq!((lifted.parameters, lifted.trust), (last.parameters, Trust::Trusted));
    assert!(lifted.variances.iter().zip(last.variances).all(|(wider, before)| *wider > before));
    assert_eq!(learner.advance(&LIFTED).variances, lifted.variances);
    let restart = LearnerInput {
        restart: Some(Restart { place: PlaceBeforeContact::Air, sensor: sensor(), person: None }),
        ..LIFTED
    };
    let restarted = *learner.advance(&restart);
    assert!(restarted.revision > lifted.revision);
    assert_eq!(restarted, LearnerOutput { revision: restarted.revision, ..new });
}

#[test]
fn a_restart_brings_place_sensor_and_person() {
    let (place, sensor, person) = (PlaceBeforeContact::Pad, sensor(), Some(PersonPrior([77; 20])));
    let (mut restarted, mut begun) = (Learner::new(), learner_of(place, person));
    let first = LearnerInput { restart: Some(Restart { place, sensor, person }), ..LIFTED };
    assert_eq!(restarted.advance(&first), begun.advance(&LIFTED));
    for input in inputs(true) {
        assert_eq!(restarted.advance(&input), begun.advance(&input));
    }
}

#[test]
fn windows_that_are_not_steady_change_nothing_that_is_learnt() {
    let mut learner = new_learner(PlaceBeforeContact::Air);
    let first = *learner.advance(&LIFTED);
    for mut input in inputs(false) {
        if let Some(contact) = &mut input.contact {
            contact.is_steady = false;
        }
        let output = learner.advance(&input);
        assert_eq!((output.parameters, output.trust), (first.parameters, Trust::Learning));
    }
    assert_eq!(first.weights.len(), WEIGHTS);
}

/// The flux is unknown in one window of a contact: from then on the banks are wrong.
#[test]
fn contact_with_an_unknown_flux_ends_in_the_mean_finger() {
    let mut learner = new_learner(PlaceBeforeContact::Air);
    for (window, input) in inputs(true).iter().enumerate() {
        let flux_w_m2 = input.flux_w_m2.filter(|_| window != 40);
        let trust = learner.advance(&LearnerInput { flux_w_m2, ..*input }).trust;
        let is_distrusted = trust == Trust::Mean(Distrust::Sensor);
        assert_eq!(is_distrusted, window >= 40, "{window}: {trust:?}");
    }
}

#[test]
fn wet_finger_ends_in_the_mean_finger() {
    let mut finger = Finger::mean(PlaceBeforeContact::Air);
    finger.resistance_factor = 0.3;
    let mut seen = 0;
    for object in OBJECTS {
        let scene = Scene {
            finger: &finger,
            object,
            force_n: 2.0,
            ticks: 1500,
            errors: Errors::NONE,
            reported: &sound,
        };
        let last = *learnt(&scene, &mut Random(0), 0).last().expect("an output");
        if let Trust::Mean(why) = last.trust {
            assert_eq!(why, Distrust::Wet, "{object:?}");
            seen += 1;
            assert!((last.resistance_factor.to_num::<f64>() - 1.0).abs() < 1e-6);
            assert!(last.weights.iter().all(|weight| (weight.to_num::<f64>() - 1.0).abs() < 1e-6));
        }
    }
    assert!(seen > 0);
}
