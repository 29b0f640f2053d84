//! Skin thermistors on fingers that touch samples.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use thermal_client::client::{Client, Telemetry};
use thermal_client::link::{Link, LinkError, ReceivedLine};
use thermal_device::StateName;
use thermal_participant::{Bench, BenchOptions, HandParams, Happening, SimulatedEvent, SkinParams};
use thermal_plant::finger::FingerParams;
use thermal_plant::object::ObjectConfig;
use thermal_plant::sensors::{Channel, SensorParams};
use thermal_plant::{Params, PlantConfig, SampleTouch};
use thermal_session::dataset::Recorder;
use thermal_session::record::TrialRecord;
use thermal_session::{Decision, Executor, People, Plan, Response, Schedule, Session, Update};
use thermal_sim::scene::{ActiveFault, FaultKind, Sensor};

use crate::run::{folder, run, session};

const SKIN_C: f64 = 33.0;
const ROOM_C: f64 = 24.0;
/// Time from the tone to the landing of the hand below, s.
const REACH_S: f64 = 0.7;

/// Largest error of a fall by the thermistor's lag of 0.3 s, the non-linearity of the converter and steps of 1 mK, K.
const SENSOR_K: f64 = 0.008;

/// A hand that does the same in all trials, and a skin that is at the temperature of the rest.
fn steady(session: &Session) -> BenchOptions {
    BenchOptions {
        hand: HandParams { reach_s: (REACH_S, 0.0), ..HandParams::STEADY },
        skin: SkinParams { drift_k: 0.0, ..SkinParams::EQUAL },
        room_c: ROOM_C,
        ..BenchOptions::of_session(session)
    }
}

/// Mean fall of the skin under the contact over the last half second of a hold that the tone ends `hold_s` after the landing, K,
/// by the plant alone: half-space finger, and the force 1.75 N (1 - exp(-t / 0.275 s)) of the steady hand.
fn true_fall_k(session: &Session, material: &str, hold_s: f64) -> f64 {
    let material = session.material(material).expect("a material");
    let mut params = Params::nominal();
    params.finger = FingerParams::homogeneous();
    let mut touch = SampleTouch::new(&PlantConfig {
        skin_c: SKIN_C,
        room_c: ROOM_C,
        object: ObjectConfig::half_space(material, ROOM_C),
        start_s: 0.0,
        appears_s: 0.0,
        duration_s: 120.0,
        seed: 1,
        params,
    })
    .expect("a plant");
    let (steps, last) = ((hold_s * 1e3).round() as u32, 500);
    let mut sum_k = 0.0;
    for ms in 0..steps {
        let force_n = -1.75 * (-f64::from(ms) * 1e-3 / 0.275).exp_m1();
        touch.set_force(force_n.max(0.03));
        touch.step();
        if ms >= steps - last {
            sum_k += SKIN_C - touch.skin_c();
        }
    }
    sum_k / f64::from(last)
}

#[test]
fn the_recorded_fall_on_a_sample_is_the_plants_times_the_share_of_the_edge() {
    let session = session("p2-skin-temperature-fall.toml", &[]);
    let records = run("p2-falls", &session, steady(&session), 8).records;
    let mut materials = Vec::new();
    for record in &records {
        let [first, second, side] = &record.levels[..] else {
            panic!("{:?}", record.levels);
        };
        let places = if side == "first-left" { [first, second] } else { [second, first] };
        let cue_s = record.touch_cue_s.expect("a tone");
        let hold_s = record.lift_s.expect("an end") - cue_s - REACH_S;
        for (station, material) in record.stations.iter().zip(places) {
            assert_eq!(station.presented, format!("sample of {material}"));
            assert_eq!(station.land_s, Some(cue_s));
            let before_c = station.skin_before_c.expect("a skin before");
            assert!((before_c - SKIN_C).abs() < 0.03, "{before_c} C");
            let fall_k = station.skin_fall_k.expect("a fall");
            let at_edge_k = BenchOptions::EDGE_SHARE * true_fall_k(&session, material, hold_s);
            // The leads of the thermistor bring it some way towards the room, as if the fall were smaller.
            let leads = SensorParams::NOMINAL.thermistors[Channel::Skin as usize].lead_share;
            let expected_k = (1.0 - leads) * at_edge_k;
            assert!(
                (fall_k - expected_k).abs() < SENSOR_K,
                "{material}: {fall_k} K recorded, {expected_k} K in the plant"
            );
            // No display measures anything at a sample.
            assert_eq!((station.setpoint_c, station.force_mean_n), (None, None));
            materials.push(material.clone());
        }
        assert_eq!(record.room_c.map(f64::round), Some(ROOM_C));
    }
    materials.sort();
    materials.dedup();
    assert!(materials.len() >= 5, "{materials:?}");
}

#[test]
fn another_thermistor_on_the_finger_at_a_display_sees_what_its_own_sees() {
    let on_display = ("index = { sample = \"material\" }", "index = { display = \"material\" }");
    let falls = ["skin_sensor = 0", "skin_sensor = 1"].map(|sensor| {
        let session =
            session("p6-skin-temperature.toml", &[on_display, ("skin_sensor = 0", sensor)]);
        let records = run(&format!("p6-{sensor}"), &session, steady(&session), 3).records;
        let falls = records.iter().map(|record| record.stations[0].skin_fall_k.expect("a fall"));
        falls.collect::<Vec<_>>()
    });
    for (own_k, other_k) in falls[0].iter().zip(&falls[1]) {
        assert!((own_k - other_k).abs() < 0.01, "{own_k} K, {other_k} K");
    }
    assert!(falls[0].iter().any(|fall_k| *fall_k > 0.5), "{falls:?}");
}

/// What is said on the line to the device, and its telemetry with the finger.
#[derive(Clone, Default)]
struct Heard {
    sent: Rc<RefCell<String>>,
    telemetry: Rc<RefCell<Vec<(u8, Telemetry)>>>,
}

struct HeardLink<L> {
    link: L,
    heard: Heard,
}

impl<L: Link> Link for HeardLink<L> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.heard.sent.borrow_mut().push_str(&String::from_utf8_lossy(bytes));
        self.link.send(bytes)
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        self.link.receive(timeout)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }
}

struct HeardPeople<P> {
    people: P,
    heard: Heard,
}

impl<P: People> People for HeardPeople<P> {
    fn inform(&mut self, update: &Update) {
        if let Update::Telemetry(line) = update {
            let heard = (line.finger.unwrap_or(0), line.telemetry);
            self.heard.telemetry.borrow_mut().push(heard);
        }
        self.people.inform(update);
    }

    fn response(&mut self) -> Option<Response> {
        self.people.response()
    }

    fn decision(&mut self) -> Option<Decision> {
        self.people.decision()
    }
}

/// Runs the first trials of a session, and returns its records with what was heard.
fn listen(name: &str, session: &Session, trials: usize) -> (Vec<TrialRecord>, Heard) {
    let (code, seed) = ("01", 1);
    let mut plan = Plan::new(session, code, seed).expect("a plan");
    plan.trials.truncate(trials);
    let bench = Bench::new(session, &plan, code, seed, steady(session)).expect("a bench");
    let mut recorder =
        Recorder::create(&folder(name), session, &plan, (code, seed), true).expect("a recorder");
    let heard = Heard::default();
    let mut people = HeardPeople { people: bench.people(), heard: heard.clone() };
    let link = HeardLink { link: bench.link(), heard: heard.clone() };
    Executor::new(session, Client::new(link), &mut people, &mut recorder)
        .run(&plan, Schedule::new(session, &plan))
        .expect("the session ends by itself");
    (recorder.records().to_vec(), heard)
}

#[test]
fn a_device_that_only_measures_the_skin_is_never_armed() {
    for (file, trials) in [("p2-skin-temperature-fall.toml", 4), ("p6-skin-temperature.toml", 4)] {
        let (records, heard) = listen(&format!("unarmed-{file}"), &session(file, &[]), trials);
        assert!(records.iter().all(|record| record.void.is_none()), "{file}");
        let sent = heard.sent.borrow();
        for drives in ["arm", "start", "hold", "play", "pulse", "tune"] {
            let is_sent = sent.split_whitespace().any(|word| word == drives);
            assert!(!is_sent, "{file}: {drives} was sent");
        }
        let telemetry = heard.telemetry.borrow();
        assert!(telemetry.len() > 100, "{file}: {} lines", telemetry.len());
        for (_, line) in telemetry.iter() {
            assert_eq!(line.state, StateName::Off, "{file}");
            assert!(line.demand_a.is_none_or(|demand_a| demand_a == 0.0));
        }
    }
}

#[test]
fn a_finger_that_only_measures_stays_off_while_another_one_is_driven() {
    let session = session(
        "p5-real-and-simulated.toml",
        &[("finger = \"left index\"", "finger = \"left index\"\nskin_sensor = 1")],
    );
    let (records, heard) = listen("mixed", &session, 4);
    assert!(records.iter().all(|record| record.void.is_none()));
    let telemetry = heard.telemetry.borrow();
    let of_finger = |finger| {
        let lines = telemetry.iter().filter(move |(of, _)| *of == finger);
        lines.map(|(_, telemetry)| telemetry)
    };
    assert!(of_finger(0).any(|line| line.state == StateName::Contact));
    assert!(of_finger(1).count() > 100);
    for line in of_finger(1) {
        assert_eq!(line.state, StateName::Off);
        assert!(line.demand_a.is_none_or(|demand_a| demand_a == 0.0));
    }
}

#[test]
fn the_gate_waits_for_the_skin_at_a_sample() {
    let session =
        session("p2-skin-temperature-fall.toml", &[("timeout_s = 180.0", "timeout_s = 10.0")]);
    let event = SimulatedEvent { trial: 2, attempt: Some(1), what: Happening::SkinOff(2.0) };
    let options = BenchOptions { events: vec![event], ..steady(&session) };
    let records = run("p2-gate", &session, options, 3).records;
    let rested_s: Vec<f64> = (records.iter())
        .map(|record| record.touch_cue_s.expect("a tone") - record.begin_s)
        .collect();
    // The operator waits once more for the skin, and then goes on.
    assert!(
        rested_s[0] < 5.0 && rested_s[1] > 20.0 && rested_s[2] < 5.0,
        "{rested_s:?} s from the begin to the tone"
    );
}

#[test]
fn a_finger_that_trips_while_it_only_measures_makes_the_trial_void() {
    let session = session("p2-skin-temperature-fall.toml", &[]);
    let event = SimulatedEvent {
        trial: 2,
        attempt: Some(1),
        what: Happening::FaultAfterLanding {
            fault: ActiveFault {
                sensor: Sensor::Skin,
                ..ActiveFault::from(FaultKind::ThermistorOpen)
            },
            from_s: 1.0,
            for_s: 0.5,
        },
    };
    let options = BenchOptions { events: vec![event], ..steady(&session) };
    let records = run("p2-trip", &session, options, 3).records;
    let voids: Vec<_> =
        (records.iter()).filter_map(|record| Some((record.trial, record.void.clone()?))).collect();
    assert_eq!(voids.len(), 1, "{voids:?}");
    assert!(voids[0].0 == 2 && voids[0].1.contains("tripped: skin-open"), "{voids:?}");
    assert_eq!(records.len(), 4);
}
