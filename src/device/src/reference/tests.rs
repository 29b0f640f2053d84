//! Set-points against Eq. 6-12 in `f64`, for forces as they come: steady, with noise, in steps, drifting.

extern crate std;

use contact_model::fixed_point::{FingerBody, TissueWeights};
use contact_model::material::{
    MATERIALS, Material, REFERENCE_DISPLAY, SKIN, THESIS_MATERIALS, find,
};
use contact_model::pressure::pressure_pa;
use contact_model::reference::Contact;
use documented_figures::assert_figure;
use std::f64::consts::TAU;
use std::vec::Vec;
use std::{format, println};

use super::*;

const TICK_S: f64 = 1e-3;
const SKIN_C: f64 = 34.0;
const OBJECT_C: f64 = 24.0;
/// The largest noise that the force sensor shows, N.
const NOISE_N: f64 = 0.6e-3;

/// What a contact of some seconds has shown.
struct Seen {
    /// Largest error of the set-point, K, from the time on that was asked for.
    worst_k: f64,
    /// Largest change from tick to tick since then, K.
    step_k: f64,
    evaluations: u32,
}

fn granite() -> &'static Material {
    find("granite").expect("granite")
}

/// Lets a finger rest on a material under `force_n(t_s)`, for `ticks`; judges from `from_s` on.
fn contact(object: &Material, ticks: u32, from_s: f64, force_n: impl Fn(f64) -> f64) -> Seen {
    let pair = ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, TICK_S).expect("pair");
    let object_c = Celsius::from_num(OBJECT_C);
    let scene = PresentedObject {
        bodies: &Bodies::HALF_SPACES,
        pair: &pair,
        object: Some(object_c),
        mode: ContactModel::ContactResistance,
    };
    let mut finger_estimator = FingerEstimator::default();
    let mut generator = ReferenceGenerator::default();
    finger_estimator.update_by_readings(Celsius::from_num(SKIN_C), object_c, None, 0);
    let (mut worst_k, mut step_k, mut before) = (0.0f64, 0.0f64, None);
    for tick in 0..ticks {
        let t_s = f64::from(tick) * TICK_S;
        let noise_n =
            NOISE_N * (f64::from(tick.wrapping_mul(2_654_435_761) >> 8) / 2f64.powi(23) - 1.0);
        let force = Force::from_num(force_n(t_s) + noise_n);
        finger_estimator.update_by_readings(Celsius::from_num(SKIN_C), object_c, Some(force), 0);
        let reference = generator
            .next_reference(&scene, &mut finger_estimator, Celsius::ZERO, false)
            .expect("observed");
        let setpoint_c = reference.setpoint.celsius().to_num::<f64>();
        let finger = (&SKIN, SKIN_C);
        let exact =
            Contact::new(finger, (object, OBJECT_C), &REFERENCE_DISPLAY, pressure_pa(force_n(t_s)));
        if t_s >= from_s {
            worst_k = worst_k.max((setpoint_c - exact.at(t_s).display_c).abs());
            step_k = step_k.max(before.map_or(0.0, |before: f64| (setpoint_c - before).abs()));
        }
        before = Some(setpoint_c);
    }
    Seen { worst_k, step_k, evaluations: generator.erfcx_evaluations() }
}

/// From 0.1 s on: before, the mean has not seen enough of the noise.
#[test]
fn steady_force_is_within_half_a_millikelvin_in_few_evaluations() {
    let (mut worst_k, mut evaluations) = (0.0f64, 0);
    for (name, material) in &MATERIALS {
        for force_n in [0.1, 0.25, 0.5, 1.0, 2.0] {
            let seen = contact(material, 10_000, 0.1, |_| force_n);
            println!("{name} {force_n} N: {:.3} mK, {}", seen.worst_k * 1e3, seen.evaluations);
            worst_k = worst_k.max(seen.worst_k);
            if THESIS_MATERIALS.contains(name) {
                evaluations = evaluations.max(seen.evaluations);
            }
        }
    }
    assert_figure("render.error", 1e3 * worst_k);
    assert_figure("render.evaluations", evaluations.into());
}

/// A step of the force that is too small to be distinguished from noise at once is followed as fast as the mean of the
/// last ticks follows it.
#[test]
fn small_steps_are_followed_within_half_a_second() {
    let mut later_k = 0.0f64;
    for step_s in [1.0, 17.0] {
        let after = |t_s: f64| if t_s < step_s { 2.0 } else { 1.9 };
        let ticks = (step_s / TICK_S) as u32 + 5000;
        let seen = contact(granite(), ticks, step_s + 0.4, after);
        later_k = later_k.max(seen.worst_k);
    }
    assert_figure("render.small_step", 1e3 * later_k);
}

/// Ramps and waves: the set-point lags by half the recent mean, and takes small steps.
#[test]
fn changing_force_is_followed_without_jumps() {
    let ramp = |length_s: f64| move |t_s: f64| 1.0 + ((t_s - 20.0) / length_s).clamp(0.0, 1.0);
    let wave = |t_s: f64| 1.5 * (1.0 + 0.05 * (TAU * 0.1 * t_s).sin());
    for (name, seen) in [
        ("slow_ramp", contact(granite(), 40_000, 19.0, ramp(20.0))),
        ("ramp", contact(granite(), 27_000, 19.0, ramp(5.0))),
        ("wave", contact(granite(), 30_000, 1.0, wave)),
    ] {
        assert_figure(&format!("render.{name}_error"), 1e3 * seen.worst_k);
        assert_figure(&format!("render.{name}_step"), 1e3 * seen.step_k);
    }
}

/// Leads of the target in the last ticks of a contact of a mean finger with granite, in which the law `model` follows the
/// skin in the ticks that `follows` names.
fn last_leads(follows: impl Fn(u32) -> bool) -> Vec<Celsius> {
    const TICKS: u32 = 1500;
    let pair = ContactPair::new(&SKIN, granite(), &REFERENCE_DISPLAY, TICK_S).expect("pair");
    let (skin, object) = (Celsius::from_num(SKIN_C), Celsius::from_num(OBJECT_C));
    let bodies = Bodies { finger: FingerBody::MEAN, are_half_spaces: false, ..Bodies::HALF_SPACES };
    let scene = PresentedObject {
        bodies: &bodies,
        pair: &pair,
        object: Some(object),
        mode: ContactModel::ContactResistance,
    };
    let (mut finger, mut generator) = (FingerEstimator::default(), ReferenceGenerator::default());
    finger.update_by_readings(skin, object, None, 0);
    let mut leads = Vec::new();
    for tick in 0..TICKS {
        finger.update_by_readings(skin, object, Some(Force::from_num(2)), 0);
        finger.step_skin_heat_flow(&pair, &bodies, Celsius::from_num(28));
        let reference = generator
            .next_reference(&scene, &mut finger, Celsius::from_num(28), follows(tick))
            .expect("a finger with temperatures");
        leads.push(reference.target.celsius() - reference.setpoint.celsius());
    }
    leads.split_off(1300)
}

/// The filter of the lead follows the set-point under every law, so a law that is selected again has no step of the target.
#[test]
fn the_lead_is_the_same_after_another_law() {
    let always = last_leads(|_| true);
    assert!(always.iter().all(|lead| *lead != 0), "{always:?}");
    assert_eq!(always, last_leads(|tick| !(300..1300).contains(&tick)));
}

/// A finger that rests on a display which follows the target: the skins on display and object are then those of another tissue,
/// both alike, so that the display need not make up for a difference.
#[test]
fn another_tissue_in_a_steady_contact_asks_for_no_correction() {
    let pair = ContactPair::new(&SKIN, granite(), &REFERENCE_DISPLAY, TICK_S).expect("pair");
    let (skin, object) = (Celsius::from_num(SKIN_C), Celsius::from_num(OBJECT_C));
    let mut bodies =
        Bodies { finger: FingerBody::MEAN, are_half_spaces: false, ..Bodies::HALF_SPACES };
    let (mut finger, mut generator) = (FingerEstimator::default(), ReferenceGenerator::default());
    finger.update_by_readings(skin, object, None, 0);
    let mut surface = Celsius::from_num(28);
    for tick in 0..3000u32 {
        let scene = PresentedObject {
            bodies: &bodies,
            pair: &pair,
            object: Some(object),
            mode: ContactModel::ContactResistance,
        };
        finger.update_by_readings(skin, object, Some(Force::from_num(2)), 0);
        finger.step_skin_heat_flow(&pair, &bodies, surface);
        let reference = generator
            .next_reference(&scene, &mut finger, surface, true)
            .expect("a finger with temperatures");
        surface = reference.setpoint.celsius();
        if tick < 1000 || tick % 500 != 0 {
            continue;
        }
        let correction = |generator: &ReferenceGenerator,
                          finger: &FingerEstimator,
                          bodies: &Bodies| {
            let contact = finger.contact().and_then(FingerContact::stored_conductances);
            let display = &contact.expect("a contact").display;
            let on_display = finger.skin_state_on_display();
            (generator.skin_on_object).skin_matching_correction(on_display, display, Some(bodies))
        };
        let before = correction(&generator, &finger, &bodies);
        let weights = [fixed::types::I2F30::from_num(1.0 - f64::from(tick) * 1e-5); 9];
        let to = TissueWeights::at_least_min(weights).tissue();
        let from = bodies.finger.tissue.relaxations();
        let factors = TissueStateFactors::new(&from, &to.relaxations());
        finger.change_tissue(&factors, &to);
        generator.change_finger(&factors, &to);
        bodies.finger.tissue = to;
        let moved = correction(&generator, &finger, &bodies) - before;
        println!("{tick}: {:.3} mK", 1e3 * moved.to_num::<f64>());
        assert!(moved.abs() < 1e-3, "{moved} K in tick {tick}");
    }
}
