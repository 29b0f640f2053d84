//! What is learnt from contacts of drawn fingers.

use std::collections::BTreeMap;
use std::format;
use std::println;
use std::vec::Vec;

use contact_model::finger::{COMPONENTS, MEAN};
use relaxation_fit::{Back, impedance};

use super::random::Random;
use super::simulation::*;
use crate::{
    Distrust, FluxSensor, Learner, LearnerOutput, PersonPrior, PlaceBeforeContact, Resistance,
    Restart, Trust,
};

const FINGERS: u64 = 40;

pub fn sensor() -> FluxSensor {
    FluxSensor::new((LAG_S * 1e6) as u32, Resistance::from_num(SENSOR_M2K_W * 1e6))
}

/// A learner with that sensor of a finger at this place.
pub fn new_learner(place: PlaceBeforeContact) -> Learner {
    learner_of(place, None)
}

/// A learner with that sensor of a finger at this place, of which this is known.
pub fn learner_of(place: PlaceBeforeContact, person: Option<PersonPrior>) -> Learner {
    let mut learner = Learner::new();
    learner.restart(Restart { place, sensor: sensor(), person });
    learner
}

pub fn learnt(scene: &Scene<'_>, random: &mut Random, phase: usize) -> Vec<LearnerOutput> {
    let mut learner = new_learner(scene.finger.place);
    let inputs = scene.inputs(random, phase);
    inputs.iter().map(|input| *learner.advance(input)).collect()
}

/// The first component of a finger: that of the two which fit its exact impedance best at Laplace variables of 1 to 100 1/s.
pub fn first_component(finger: &Finger) -> f64 {
    let layers: Vec<_> = (finger.layers.iter())
        .map(|layer| relaxation_fit::Layer {
            perfusion_w_m3k: layer.perfusion_w_m3k * finger.flow,
            ..*layer
        })
        .collect();
    let ([mut aa, mut ab, mut bb], [mut ay, mut by]) = ([0.0; 3], [0.0; 2]);
    for sample in 0..=20 {
        let s_1_s = 10f64.powf(f64::from(sample) / 10.0);
        let mean = MEAN.impedance.at(s_1_s);
        let [a, b] = COMPONENTS.map(|component| {
            let terms = MEAN.impedance.relaxations[1..].iter();
            let terms = terms.map(|one| one.gain_m2k_j / (s_1_s + one.rate_1_s));
            let terms = terms.chain([MEAN.impedance.direct_m2k_w]);
            terms.zip(component).map(|(term, part)| term * part).sum::<f64>() / mean
        });
        let y = impedance(&layers, Back::Held, s_1_s) / mean - 1.0;
        (aa, ab, bb) = (aa + a * a, ab + a * b, bb + b * b);
        (ay, by) = (ay + a * y, by + b * y);
    }
    (ay * bb - by * ab) / (aa * bb - ab * ab)
}

/// Value at a share of sorted absolute values.
fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    values[(share * (values.len() - 1) as f64).round() as usize].abs()
}

/// Errors of the contact resistance, relative, and of the first component after 1.5 s of contact: median and 95th percentile.
fn errors(force_n: f64, fingers: u64, with: fn(&mut Random) -> Errors) -> [[f64; 2]; 2] {
    let (mut resistances, mut components) = (Vec::new(), Vec::new());
    for seed in 0..fingers {
        let mut random = Random(seed);
        let finger = Finger::drawn(&mut random);
        let component = first_component(&finger);
        let errors = with(&mut random);
        for object in OBJECTS {
            let scene =
                Scene { finger: &finger, object, force_n, ticks: 1500, errors, reported: &sound };
            let outputs = learnt(&scene, &mut random, (seed % 10) as usize);
            for output in &outputs {
                assert!(
                    !matches!(output.trust, Trust::Mean(_)),
                    "{seed} on {object:?}: {output:?}"
                );
            }
            let last = outputs.last().expect("an output");
            // 480 ms and 1.5 s after landing.
            assert_eq!([outputs[49].trust, last.trust], [Trust::Learning, Trust::Trusted]);
            resistances
                .push(last.resistance_factor.to_num::<f64>() / finger.resistance_factor - 1.0);
            if object.name != "foam" {
                components.push(last.parameters[0].to_num::<f64>() - component);
            }
        }
    }
    [&mut resistances, &mut components]
        .map(|values| [0.5, 0.95].map(|share| quantile(values, share)))
}

#[test]
fn finger_and_contact_are_learnt_and_no_finger_is_distrusted() {
    type Drawn = fn(&mut Random) -> Errors;
    let perfect: Drawn = |_| Errors::NONE;
    // Largest median and 95th percentile of the errors of resistance and component.
    for (force_n, fingers, with, limits) in [
        (2.0, FINGERS, perfect, [[0.007, 0.043], [0.035, 0.20]]),
        (2.0, FINGERS, Errors::drawn, [[0.019, 0.049], [0.11, 0.38]]),
        (0.5, 10, Errors::drawn, [[0.021, 0.043], [0.15, 0.37]]),
        (0.25, 10, Errors::drawn, [[0.024, 0.042], [0.16, 0.43]]),
        (0.1, 10, Errors::drawn, [[0.029, 0.11], [0.38, 0.83]]),
    ] {
        let found = errors(force_n, fingers, with);
        println!("{force_n} N: resistance {:.4?}, component {:.3?}", found[0], found[1]);
        for (found, limit) in found.iter().flatten().zip(limits.iter().flatten()) {
            assert!(found <= limit, "{force_n} N: {found}, at most {limit}");
        }
    }
}

/// The force that [`crate::trust`] takes for light.
#[test]
fn force_of_0_5_n_is_not_light_and_0_45_n_is() {
    let limit = f64::from(crate::trust::LIGHT_RESISTANCE_M2K_W);
    assert!(display_resistance_m2k_w(0.5) < limit && limit < display_resistance_m2k_w(0.45));
}

/// The finger in a glove of cotton.
fn in_cotton(finger: &mut Finger) {
    let cotton = relaxation_fit::Layer {
        thickness_m: 1e-3,
        conductivity_w_mk: 0.05,
        capacity_j_m3k: 2e5,
        perfusion_w_m3k: 0.0,
    };
    finger.layers.insert(0, cotton);
}

/// A way of being fooled.
struct Fault {
    name: &'static str,
    change: fn(&mut Finger),
    /// What the sensor reports for a flux in a tick.
    reported: fn(f64, usize) -> f64,
    /// First tick of the contact in which the flux is wrong.
    from_tick: usize,
    /// Distrust that follows on all objects but foam; none if there are several.
    distrust: Option<Distrust>,
    /// Most ticks to that distrust.
    within_ticks: usize,
    /// Of [`FOOLED`] fingers on five objects, how many contacts must be distrusted.
    contacts: usize,
    /// The same on foam, where little flux flows.
    on_foam: usize,
}

/// Fingers of each fault.
const FOOLED: u64 = 8;

const NO_CHANGE: fn(&mut Finger) = |_| {};

const FAULTS: [Fault; 8] = [
    Fault {
        name: "dead sensor",
        change: NO_CHANGE,
        reported: |_, _| 0.0,
        from_tick: 0,
        distrust: Some(Distrust::Sensor),
        within_ticks: 50,
        contacts: 40,
        on_foam: 8,
    },
    Fault {
        name: "sensor that dies",
        change: NO_CHANGE,
        reported: |flux, tick| if tick < 700 { flux } else { 0.0 },
        from_tick: 700,
        distrust: Some(Distrust::Contact),
        within_ticks: 60,
        contacts: 40,
        on_foam: 4,
    },
    Fault {
        name: "reversed sensor",
        change: NO_CHANGE,
        reported: |flux, _| -flux,
        from_tick: 0,
        distrust: Some(Distrust::Sensor),
        within_ticks: 60,
        contacts: 40,
        on_foam: 8,
    },
    Fault {
        name: "gain of a half",
        change: NO_CHANGE,
        reported: |flux, _| 0.5 * flux,
        from_tick: 0,
        distrust: None,
        within_ticks: 300,
        contacts: 40,
        on_foam: 0,
    },
    Fault {
        name: "paper",
        change: |finger| finger.resistance_factor = 4.0,
        reported: sound,
        from_tick: 0,
        distrust: Some(Distrust::Between),
        within_ticks: 50,
        contacts: 40,
        on_foam: 0,
    },
    Fault {
        name: "glove of cotton",
        change: in_cotton,
        reported: sound,
        from_tick: 0,
        distrust: None,
        within_ticks: 60,
        contacts: 40,
        on_foam: 0,
    },
    Fault {
        name: "wet",
        change: |finger| finger.resistance_factor = 0.2,
        reported: sound,
        from_tick: 0,
        distrust: Some(Distrust::Wet),
        within_ticks: 50,
        contacts: 40,
        on_foam: 2,
    },
    Fault {
        name: "lifted while the force stays",
        change: NO_CHANGE,
        reported: |flux, tick| if tick < 700 { flux } else { 0.3 * flux },
        from_tick: 700,
        distrust: Some(Distrust::Contact),
        within_ticks: 60,
        contacts: 40,
        on_foam: 0,
    },
];

impl Fault {
    /// The distrust on an object, and the tick after the fault in which it came.
    fn distrust(
        &self,
        finger: &Finger,
        (object, force_n, ticks): (Object, f64, usize),
        random: &mut Random,
    ) -> Option<(Distrust, usize)> {
        let mut finger = finger.clone();
        (self.change)(&mut finger);
        let scene = Scene {
            finger: &finger,
            object,
            force_n,
            ticks,
            errors: Errors::drawn(random),
            reported: &self.reported,
        };
        let outputs = learnt(&scene, random, 0);
        (outputs.iter().enumerate()).find_map(|(window, output)| match output.trust {
            Trust::Mean(why) => Some((why, 10 * (window - 1) - self.from_tick)),
            _ => None,
        })
    }
}

impl Fault {
    /// Of [`FOOLED`] fingers on five objects, contacts that are distrusted and ticks to the last distrust; and contacts on foam.
    fn distrusted(&self) -> (usize, usize, usize) {
        let (mut ticks, mut contacts, mut on_foam, mut reasons) = (0, 0, 0, BTreeMap::new());
        for seed in 0..FOOLED {
            let mut random = Random(1000 + seed);
            let finger = Finger::drawn(&mut random);
            for object in OBJECTS {
                let found = self.distrust(&finger, (object, 2.0, 1500), &mut random);
                if object.name == "foam" {
                    on_foam += usize::from(found.is_some());
                    continue;
                }
                let Some((distrust, tick)) = found else {
                    continue;
                };
                contacts += 1;
                ticks = ticks.max(tick);
                *reasons.entry(format!("{distrust:?}")).or_insert(0) += 1;
                if let Some(expected) = self.distrust {
                    assert_eq!(distrust, expected, "{}, finger {seed}, {object:?}", self.name);
                }
            }
        }
        println!(
            "{}: {contacts} of 40 within {ticks} ms, {reasons:?}; on foam {on_foam} of {FOOLED}",
            self.name
        );
        (contacts, ticks, on_foam)
    }
}

#[test]
fn what_is_no_finger_on_the_display_is_distrusted() {
    for fault in &FAULTS {
        let (contacts, ticks, on_foam) = fault.distrusted();
        assert!(contacts >= fault.contacts, "{}: {contacts}", fault.name);
        assert!(ticks <= fault.within_ticks, "{}: {ticks} ms", fault.name);
        assert!(on_foam >= fault.on_foam, "{}: {on_foam} on foam", fault.name);
    }
}

/// On foam 2 s after landing the model's error is 0.13 K, and a wrong flux changes the measurement by no more. Innovations stay small, and
/// the measurement hardly depends on a parameter; but the fit ends at a limit of the first component, with a skin thermistor that is far off.
#[test]
fn small_flux_that_becomes_wrong_late_in_a_contact_is_distrusted() {
    type Reported = fn(f64, usize) -> f64;
    let reversed: Reported = |flux, tick| if tick < 2000 { flux } else { -flux };
    let missing: Reported = |flux, tick| if tick < 2000 { flux } else { 0.0 };
    let foam = OBJECTS.into_iter().find(|object| object.name == "foam");
    for (name, reported, contacts, within_ticks) in
        [("reversed", reversed, 8, 4_500), ("missing", missing, 5, 18_000)]
    {
        let fault = Fault {
            name,
            change: NO_CHANGE,
            reported,
            from_tick: 2000,
            distrust: None,
            within_ticks,
            contacts,
            on_foam: 0,
        };
        let mut found = Vec::new();
        for seed in 0..FOOLED {
            let mut random = Random(3000 + seed);
            let finger = Finger::drawn(&mut random);
            let contact = (foam.expect("foam"), 2.0, 20_000);
            found.extend(fault.distrust(&finger, contact, &mut random));
        }
        println!("foam, {name} after 2 s: {found:?}");
        assert!(found.len() >= contacts, "{name}: {found:?}");
        for (why, tick) in &found {
            assert!(matches!(why, Distrust::Contact | Distrust::Unexplained));
            assert!(*tick <= within_ticks, "{name}: {found:?}");
        }
    }
}

/// Errors of the sensor that look like another finger: the caller must check for them without one. Distrusted are so many of 40
/// contacts at most, and none on foam.
#[test]
fn a_wrong_gain_or_zero_is_hardly_distrusted() {
    let gain: fn(f64, usize) -> f64 = |flux, _| 0.8 * flux;
    for (name, reported, most) in
        [("gain of 0.8", gain, 3), ("zero of 50 W/m2", |flux, _| flux + 50.0, 0)]
    {
        let fault = Fault {
            name,
            change: NO_CHANGE,
            reported,
            from_tick: 0,
            distrust: None,
            within_ticks: 1500,
            contacts: 0,
            on_foam: 0,
        };
        let (contacts, _, on_foam) = fault.distrusted();
        assert!(contacts <= most && on_foam == 0, "{name}: {contacts}, {on_foam}");
    }
}

/// A light force, under which the contact resistance hides much of what is wrong.
#[test]
fn wrong_flux_is_distrusted_under_light_force() {
    for (name, within_ticks) in
        [("dead sensor", 60), ("sensor that dies", 60), ("reversed sensor", 60), ("paper", 200)]
    {
        let fault = FAULTS.iter().find(|fault| fault.name == name).expect("a fault");
        let mut ticks = 0;
        for seed in 0..FOOLED {
            let mut random = Random(2000 + seed);
            let finger = Finger::drawn(&mut random);
            for object in OBJECTS.into_iter().filter(|object| object.name != "foam") {
                let found = fault.distrust(&finger, (object, 0.1, 1500), &mut random);
                let (_, tick) =
                    found.unwrap_or_else(|| panic!("{name}, finger {seed}, {object:?}"));
                ticks = ticks.max(tick);
            }
        }
        println!("0.1 N, {name}: within {ticks} ms");
        assert!(ticks <= within_ticks, "{name}: {ticks} ms");
    }
}
