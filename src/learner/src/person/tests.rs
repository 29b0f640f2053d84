use std::println;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::parameters::PRIOR;
use crate::tests::contacts::{first_component, learner_of};
use crate::tests::matrix::least_pivot;
use crate::tests::random::Random;
use crate::tests::simulation::{Errors, Finger, OBJECTS, Object, Scene, sound};
use crate::{Distrust, Flux, Learner, LearnerInput, LearnerOutput, Trust};

const LIFTED: LearnerInput =
    LearnerInput { sequence: 0, restart: None, flux_w_m2: Some(Flux::ZERO), contact: None };

/// Windows between contacts, 1000 s, after which the simulated finger is in equilibrium again.
const REST_WINDOWS: usize = 100_000;

/// The learner's outputs in a contact of this length after a rest, and last that after lifting.
fn touch(
    learner: &mut Learner,
    finger: &Finger,
    (object, ticks): (Object, usize),
    errors: Errors,
    random: &mut Random,
) -> Vec<LearnerOutput> {
    for _ in 0..REST_WINDOWS {
        assert_eq!(learner.advance(&LIFTED).person, None);
    }
    let scene = Scene { finger, object, force_n: 2.0, ticks, errors, reported: &sound };
    let inputs = scene.inputs(random, 0).into_iter().chain([LIFTED]);
    inputs.map(|input| *learner.advance(&input)).collect()
}

/// What is stored after the last of these outputs; it must not be earlier.
fn stored(outputs: &[LearnerOutput]) -> Option<PersonPrior> {
    let (last, before) = outputs.split_last().expect("outputs");
    assert!(before.iter().all(|output| output.person.is_none()));
    last.person
}

/// Two contacts of 8 s, on copper and ABS.
fn enrolled(finger: &Finger, errors: Errors, random: &mut Random) -> (LearnerOutput, PersonPrior) {
    let mut learner = learner_of(finger.place, None);
    let [copper, _, abs, ..] = OBJECTS;
    touch(&mut learner, finger, (copper, 8000), errors, random);
    let outputs = touch(&mut learner, finger, (abs, 8000), errors, random);
    let person = stored(&outputs).expect("an enrolled finger");
    assert_eq!((person.contacts(), person.place()), (2, finger.place));
    (outputs[outputs.len() - 1], person)
}

#[test]
fn the_record_has_the_documented_layout() {
    let mut estimate = Estimate::PRIOR;
    estimate.parameters = [0.5, -1.0, 0.25, 9.0, 1.0 / 4096.0, 9.0];
    // Deviations of 0.495, 0.1, 0.051 and 0.9 are rounded up to 1/2, 1/8 (1 - 12/64), 1/16 (1 - 11/64) and 1 - 6/64.
    let deviations = [0.495, 0.1, 0.051, 1.0, 0.9, 1.0];
    for (i, deviation) in deviations.into_iter().enumerate() {
        estimate.covariance[i][i] = deviation * deviation;
    }
    // With the rounded deviations of 0.5 and 0.101 56, a correlation of 64.2 / 128.
    let between = 0.025_47;
    (estimate.covariance[0][1], estimate.covariance[1][0]) = (between, between);
    let person = PersonPrior::new(&estimate, 3, PlaceBeforeContact::Pad);
    let expected = [0, 8, 0, 0xf0, 0, 4, 1, 0, 32, 108, 139, 6, 64, 0, 0, 0, 0, 0, 3, 1];
    assert_eq!(person.0, expected);
    assert_eq!(person.parameters(), [0.5, -1.0, 0.25, 1.0 / 4096.0]);
    assert_eq!((person.contacts(), person.place()), (3, PlaceBeforeContact::Pad));
}

#[test]
fn stored_deviations_are_32_in_each_octave_rounded_up() {
    for number in 0..=u8::MAX {
        let (octave, part) = (number / 32, number % 32);
        let exact = (-f64::from(octave)).exp2() * (1.0 - f64::from(part) / 64.0);
        assert_eq!(f64::from(deviation(number)), exact);
        // Just below it, and half a level below it.
        for below in [0.9999f64, 0.993] {
            assert_eq!(level((exact * below).powi(2) as f32), number);
        }
    }
    assert_eq!([level(1.25), level(f32::MAX), level(f32::INFINITY)], [0; 3]);
    assert_eq!([level(0.0), level(f32::MIN_POSITIVE)], [u8::MAX; 2]);
}

#[test]
fn the_finger_that_was_learnt_is_adopted_within_the_rounding_of_the_record() {
    let (mut worst_parameter, mut worst_weight) = (0.0f64, 0.0f64);
    for seed in 0..6 {
        let mut random = Random(seed);
        let finger = Finger::drawn(&mut random);
        let errors = Errors::drawn(&mut random);
        let (learnt, person) = enrolled(&finger, errors, &mut random);
        let adopted = *learner_of(finger.place, Some(person)).advance(&LIFTED);
        assert_eq!(adopted.trust, Trust::Learning);
        for i in STORED {
            let difference = (adopted.parameters[i] - learnt.parameters[i]).abs();
            worst_parameter = worst_parameter.max(difference.to_num());
            let ratio: f64 =
                adopted.variances[i].to_num::<f64>() / learnt.variances[i].to_num::<f64>();
            assert!((0.999_999..1.064).contains(&ratio), "{seed}, {i}: {ratio}");
        }
        for (ours, theirs) in adopted.weights.iter().zip(learnt.weights) {
            worst_weight = worst_weight.max((ours - theirs).abs().to_num());
        }
        assert!(
            adopted.is_nearly(&LearnerOutput { skin_offset_k: adopted.skin_offset_k, ..learnt })
        );
    }
    println!("largest differences {worst_parameter:.1e} deviations, weights {worst_weight:.1e}");
    // Half a unit of a parameter; times the sum of both relative components of a weight.
    assert!(worst_parameter <= 0.5 / 4096.0 + 1e-6);
    assert!(worst_weight <= 0.26 * 0.5 / 4096.0);
}

/// Correlations are kept: what is stored is the estimate, not only its deviations.
#[test]
fn the_covariance_that_was_learnt_is_adopted() {
    let mut random = Random(3);
    let finger = Finger::drawn(&mut random);
    let errors = Errors::drawn(&mut random);
    let mut learner = learner_of(finger.place, None);
    let [copper, ..] = OBJECTS;
    let outputs = touch(&mut learner, &finger, (copper, 8000), errors, &mut random);
    let person = stored(&outputs).expect("a trusted finger");
    let (learnt, adopted) = (&learner.estimate, &learner_of(finger.place, Some(person)).estimate);
    let mut largest = 0.0f32;
    for i in STORED {
        for j in STORED.into_iter().filter(|j| *j != i) {
            let scale = (learnt.covariance[i][i] * learnt.covariance[j][j]).sqrt();
            let difference = learnt.covariance[i][j] - adopted.covariance[i][j];
            assert!(difference.abs() <= scale * 1.07 / 128.0, "{i} {j}");
            largest = largest.max(learnt.covariance[i][j].abs() / scale);
        }
    }
    assert!(largest > 0.3, "largest correlation {largest}");
}

#[test]
fn an_enrolled_finger_is_known_when_it_lands() {
    // Squared errors of component and resistance before landing and 50 ms later: not enrolled, enrolled.
    let mut sums = [[[0.0; 2]; 2]; 2];
    for seed in 10..22 {
        let mut random = Random(seed);
        let finger = Finger::drawn(&mut random);
        let component = first_component(&finger);
        let errors = Errors::drawn(&mut random);
        let (_, person) = enrolled(&finger, errors, &mut random);
        // On another day the contact differs, and so does the error of the skin's thermistor.
        let mut today = finger.clone();
        today.resistance_factor *= 0.07f64.mul_add(random.normal(), 1.0);
        today.skin_offset_k = 0.02 * random.normal();
        for (sums, person) in sums.iter_mut().zip([None, Some(person)]) {
            let mut learner = learner_of(finger.place, person);
            let contact = (OBJECTS[1], 60);
            let outputs = touch(&mut learner, &today, contact, errors, &mut random);
            for (sums, output) in sums.iter_mut().zip([&outputs[1], &outputs[6]]) {
                assert!(!matches!(output.trust, Trust::Mean(_)), "{seed}");
                let factor = output.resistance_factor.to_num::<f64>();
                sums[0] += (output.parameters[0].to_num::<f64>() - component).powi(2);
                sums[1] += (factor / today.resistance_factor - 1.0).powi(2);
            }
        }
    }
    let [without, with] = sums.map(|sums| sums.map(|sums| sums.map(|sum| (sum / 12.0f64).sqrt())));
    println!(
        "before landing, 50 ms later: component and resistance {without:.3?}, enrolled {with:.3?}"
    );
    assert!(with[0][0] < 0.3 * without[0][0] && with[0][1] < 0.3 * without[0][1]);
    assert!(with[1][0] < 0.7 * without[1][0] && with[1][1] < without[1][1]);
}

#[test]
fn only_trusted_contacts_of_eight_seconds_are_stored() {
    let finger = Finger::mean(PlaceBeforeContact::Air);
    let mut random = Random(0);
    let mut learner = learner_of(PlaceBeforeContact::Air, None);
    let [copper, granite, ..] = OBJECTS;
    let mut last = |object, ticks, finger: &Finger| {
        let outputs = touch(&mut learner, finger, (object, ticks), Errors::NONE, &mut random);
        stored(&outputs).map(|person| person.contacts())
    };
    // Windows end 8 s and 7.99 s after landing.
    assert_eq!(last(copper, 7990, &finger), None);
    assert_eq!(last(copper, 8000, &finger), Some(1));
    assert_eq!(last(granite, 8000, &finger), Some(2));
    // Something between finger and display is no finger, and what was learnt before is gone.
    let mut covered = finger.clone();
    covered.resistance_factor = 4.0;
    assert_eq!(last(copper, 8000, &covered), None);
    assert_eq!(last(copper, 8000, &finger), Some(1));
}

#[test]
fn a_distrusted_finger_is_the_enrolled_one_again_at_the_next_landing() {
    let person = PersonPrior::new(
        &Estimate { parameters: [1.0, 0.0, 0.0, 0.0, 0.5, 0.0], ..Estimate::PRIOR },
        2,
        PlaceBeforeContact::Air,
    );
    let mut learner = learner_of(PlaceBeforeContact::Air, Some(person));
    let first = *learner.advance(&LIFTED);
    let dead = Scene {
        finger: &Finger::mean(PlaceBeforeContact::Air),
        object: OBJECTS[0],
        force_n: 2.0,
        ticks: 500,
        errors: Errors::NONE,
        reported: &|_, _| 0.0,
    };
    for input in dead.inputs(&mut Random(0), 0) {
        learner.advance(&input);
    }
    let lifted = *learner.advance(&LIFTED);
    assert_eq!(lifted.trust, Trust::Mean(Distrust::Sensor));
    let mut landing = dead.inputs(&mut Random(0), 0)[2];
    // The first window of the contact is not learnt from.
    landing.contact.as_mut().expect("a contact").is_steady = false;
    let again = *learner.advance(&landing);
    assert_eq!(
        (again.parameters, again.variances, again.trust),
        (first.parameters, first.variances, Trust::Learning)
    );
}

#[test]
fn of_another_place_the_air_is_not_adopted() {
    let mut estimate = Estimate::PRIOR;
    estimate.parameters = [1.0, -0.5, 0.7, 0.0, 0.5, 0.0];
    for i in STORED {
        for j in STORED {
            estimate.covariance[i][j] = if i == j { 0.04 } else { 0.02 };
        }
    }
    let person = PersonPrior::new(&estimate, 2, PlaceBeforeContact::Air);
    let scale = Scale::new(PlaceBeforeContact::Pad, 0.3);
    let adopted = person.estimate(PlaceBeforeContact::Pad, &scale);
    assert_eq!(adopted.parameters, [1.0, -0.5, 0.0, 0.0, 0.5, 0.0]);
    for i in 0..PARAMETERS {
        let expected = if i == AIR { 1.0 } else { 0.0 };
        assert_eq!(adopted.covariance[AIR][i], expected);
        assert_eq!(adopted.covariance[i][AIR], expected);
    }
    assert!((adopted.covariance[0][1] - 0.02).abs() < 1e-3);
    assert_eq!(Estimate::PRIOR.parameters, PRIOR);
}

proptest! {
    #[test]
    fn any_bytes_give_an_estimate_within_the_limits_with_a_positive_covariance(
        bytes in any::<[u8; 20]>(),
        correlations in prop::option::of(prop::array::uniform6(prop_oneof![Just(127u8), Just(129), Just(128), Just(0)])),
        on_pad in any::<bool>(),
    ) {
        let mut bytes = bytes;
        // Also those that are far from any matrix.
        if let Some(correlations) = correlations {
            bytes[12..18].copy_from_slice(&correlations);
        }
        let place = if on_pad { PlaceBeforeContact::Pad } else { PlaceBeforeContact::Air };
        let scale = Scale::new(place, 0.3);
        let person = PersonPrior(bytes);
        let estimate = person.estimate(place, &scale);
        for (parameter, (low, high)) in estimate.parameters.iter().zip(scale.low.iter().zip(&scale.high)) {
            prop_assert!((low..=high).contains(&parameter), "{estimate:?}");
        }
        let covariance = &estimate.covariance;
        let mut correlations = *covariance;
        for i in 0..PARAMETERS {
            prop_assert!(covariance[i][i] > 0.0 && covariance[i][i] <= 1.0);
            for j in 0..PARAMETERS {
                prop_assert_eq!(covariance[i][j].to_bits(), covariance[j][i].to_bits());
                correlations[i][j] /= (covariance[i][i] * covariance[j][j]).sqrt();
            }
        }
        prop_assert!(least_pivot(&correlations) > 0.9e-3, "{estimate:?}");
        // What is stored again is the same within the rounding of the correlations.
        let again = PersonPrior::new(&estimate, person.contacts(), person.place());
        if place == person.place() {
            for (ours, theirs) in again.deviations().iter().zip(person.deviations()) {
                prop_assert!((ours / theirs - 1.0).abs() < 0.035);
            }
        }
    }

    #[test]
    fn storing_any_estimate_does_not_panic(
        parameters in prop::array::uniform6(any::<f32>()),
        covariance in prop::array::uniform6(prop::array::uniform6(any::<f32>())),
    ) {
        let person = PersonPrior::new(&Estimate { parameters, covariance }, 1, PlaceBeforeContact::Air);
        let estimate = person.estimate(PlaceBeforeContact::Air, &Scale::new(PlaceBeforeContact::Air, 0.3));
        prop_assert!(estimate.parameters.iter().all(|one| one.is_finite()));
    }
}
