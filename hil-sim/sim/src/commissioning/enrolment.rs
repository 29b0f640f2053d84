//! The simulated operator enrols the finger of a scene on its device before the scene.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

use contact_model::material::{MATERIALS, find};
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal};
use thermal_client::commissioning::{CommissionError, SurroundingsError};
use thermal_plant::object::ObjectConfig;
use thermal_plant::parameters::stream_seed;

use super::settings_for_scene;
use crate::World;
use crate::engine::NativeEngine;
use crate::run::run_with_settings;
use crate::scene::{Force, HostLine, Object, Scene};

/// The code of the person.
const CODE: &str = "P01";
/// Objects that the finger touches for [`CONTACT_S`] each, with this force, from these times on: first that which cools it less, because
/// neither the skin nor what its thermistor shows has recovered at the second landing.
const CONTACTS: [(&str, f64); 2] = [("abs", 1.0), ("copper", 21.0)];
const CONTACT_S: f64 = 10.0;
const FORCE_N: f64 = 2.0;
/// Ramp of the force when the finger lifts, s.
const LIFTING_S: f64 = 0.05;
/// Time before a contact at which its object is chosen, s.
const CHOSEN_BEFORE_S: f64 = 6.0;
/// From the last contact's end to the order to enrol, and to the end of the run, s.
const ENROL_AFTER_S: f64 = 0.5;
const END_AFTER_S: f64 = 1.0;
/// Differences between two days: standard deviations of the contact resistance, relative, and of the skin thermistor, K.
const RESISTANCE: f64 = 0.07;
const SKIN_THERMISTOR_K: f64 = 0.02;
/// The refusal of a finger that was not trusted in both contacts.
const NOT_ENOUGH: &str = "enrol needs 2 contacts";
/// Time of the scene at which the person is chosen, s: the device is then armed and waits.
const CHOOSE_AT_S: f64 = -1.0;

/// The scene with the lines that choose its person, if its finger is enrolled. It was enrolled on the same device, by two contacts
/// of another day, natively, once per process for each finger on a device. A finger that the device did not trust in both contacts
/// is not enrolled.
///
/// # Errors
/// The device cannot be commissioned, refuses to be set up, or does not answer `person enrol` with a person.
pub fn with_person(scene: &Scene) -> Result<Cow<'_, Scene>, CommissionError> {
    if !scene.enrolled {
        return Ok(Cow::Borrowed(scene));
    }
    let Some(data) = person_data(&on_another_day(scene), scene)? else {
        return Ok(Cow::Borrowed(scene));
    };
    let mut scene = scene.clone();
    let lines = [format!("person {CODE} {data}"), format!("person {CODE}")];
    let lines = lines.map(|line| HostLine { t_s: CHOOSE_AT_S, line });
    scene.host.splice(..0, lines);
    Ok(Cow::Owned(scene))
}

/// The two contacts on another day.
fn on_another_day(scene: &Scene) -> Scene {
    let seed = stream_seed(scene.seed, "enrolment");
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let mut params = scene.params.clone();
    params.finger.resistance_factor *= (RESISTANCE * normal()).exp();
    let [_, _, _, skin, _] = &mut params.sensors.thermistors;
    let kelvin = scene.skin_c + 273.15;
    skin.at_25c_ohm *= (-SKIN_THERMISTOR_K * normal() * skin.beta_k / (kelvin * kelvin)).exp();
    let mut on_day = Scene {
        seed: seed >> 1,
        enrolled: false,
        object_as_half_space: false,
        params,
        infrared: None,
        forces: Vec::new(),
        faults: Vec::new(),
        injections: Vec::new(),
        triggers_s: Vec::new(),
        host: Vec::new(),
        course: None,
        object: first_object(),
        ..scene.clone()
    };
    for (number, (name, t_s)) in CONTACTS.into_iter().enumerate() {
        let lifts_s = t_s + CONTACT_S;
        on_day.forces.extend([
            Force { t_s, force_n: FORCE_N, ramp_s: 0.0 },
            Force { t_s: lifts_s, force_n: 0.0, ramp_s: LIFTING_S },
        ]);
        if number > 0 {
            on_day
                .host
                .push(HostLine { t_s: t_s - CHOSEN_BEFORE_S, line: format!("material {name}") });
        }
        on_day.duration_s = lifts_s + END_AFTER_S;
    }
    on_day.host.push(HostLine {
        t_s: on_day.duration_s - END_AFTER_S + ENROL_AFTER_S,
        line: format!("person enrol {CODE}"),
    });
    on_day
}

/// The half-space of the first material, at the room's temperature.
fn first_object() -> Object {
    let [(name, _), ..] = CONTACTS;
    let [(_, any), ..] = MATERIALS;
    let material = find(name).copied().unwrap_or(any);
    let ObjectConfig { layers, back, .. } = ObjectConfig::half_space(material, 0.0);
    Object { name: name.into(), material, start_c: None, appears_t_s: 0.0, layers, back }
}

/// Why enrolment failed, or what was learnt; `None` if the contacts were not trusted. Computed once.
type SharedData = Arc<OnceLock<Result<Option<String>, CommissionError>>>;

/// What the device of `scene` has learnt of the person on another day, as on the line that stores it.
fn person_data(on_day: &Scene, scene: &Scene) -> Result<Option<String>, CommissionError> {
    static KNOWN: LazyLock<Mutex<HashMap<String, SharedData>>> = LazyLock::new(Mutex::default);
    let data = {
        // A thread that panicked has at most left an entry without data.
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(known.entry(format!("{on_day:?}")).or_default())
    };
    let enrol = || -> Result<Option<String>, CommissionError> {
        let failed = |error: &dyn ToString| SurroundingsError::Failed(error.to_string());
        let settings = settings_for_scene(scene)?;
        let world = World::new(on_day).map_err(|error| failed(&error))?;
        let mut engine = NativeEngine::new(world);
        let outcome = run_with_settings(on_day, &settings, &[], &mut engine, |_| ())
            .map_err(|error| failed(&error))?;
        let exchanges = outcome.exchanges();
        let line = format!("person enrol {CODE}");
        let answer = (exchanges.iter()).find(|exchange| exchange.line == Some(&line));
        let answer = answer.map_or("no answer", |exchange| exchange.answer);
        match answer.split_once("data=") {
            Some((_, data)) => Ok(Some(data.into())),
            None if answer.contains(NOT_ENOUGH) => Ok(None),
            None => Err(failed(&format!("{line}: {answer}")).into()),
        }
    };
    data.get_or_init(enrol).clone()
}
