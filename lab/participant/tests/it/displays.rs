//! Sessions with the simulated device.

use std::fs;
use std::path::Path;

use thermal_participant::{
    BenchOptions, HandParams, Happening, ObserverParams, SimulatedEvent, SkinParams,
};
use thermal_session::{Decision, DoseReached, Phase, Plan, Session};
use thermal_sim::scene::{ActiveFault, FaultKind};

use crate::run::{run, session};

fn noise_free() -> BenchOptions {
    BenchOptions {
        observer: Some(ObserverParams::NOISE_FREE),
        hand: HandParams::STEADY,
        skin: SkinParams::EQUAL,
        ..BenchOptions::default()
    }
}

#[test]
fn without_noise_real_and_simulated_materials_are_told_apart() {
    let ran = run("p5", &session("p5-real-and-simulated.toml", &[]), noise_free(), 16);
    let (correct, all) = ran.correct();
    assert_eq!(
        (correct, all),
        (12, 12),
        "{:?}",
        ran.records.iter().filter_map(|r| r.void.clone()).collect::<Vec<_>>()
    );
    assert!(ran.records.iter().all(|record| record.void.is_none()));
}

#[test]
fn trips_and_operators_void_trials_which_are_repeated() {
    let event = |trial, what| SimulatedEvent { trial, attempt: Some(1), what };
    let options = BenchOptions {
        events: vec![
            event(
                2,
                Happening::FaultAfterLanding {
                    fault: ActiveFault::from(FaultKind::ThermistorOpen),
                    from_s: 1.0,
                    for_s: 0.5,
                },
            ),
            event(3, Happening::Decides(Phase::Contact, Decision::Void)),
            event(4, Happening::DoesNotTouch),
            event(5, Happening::DoesNotAnswer),
        ],
        ..noise_free()
    };
    let ran = run("p5-voids", &session("p5-real-and-simulated.toml", &[]), options, 6);
    let voids: Vec<_> = (ran.records.iter())
        .filter_map(|record| Some((record.trial, record.void.clone()?)))
        .collect();
    assert_eq!(
        voids.iter().map(|(trial, _)| *trial).collect::<Vec<_>>(),
        [2, 3, 4, 5],
        "{voids:?}"
    );
    assert!(voids[0].1.contains("tripped"), "{voids:?}");
    assert_eq!(ran.records.len(), 10);
}

/// A device that stays as it is from trial to trial, with a skin that is the same in all of them.
fn kept_device(events: Vec<SimulatedEvent>) -> BenchOptions {
    BenchOptions { keeps_device: true, events, ..noise_free() }
}

#[test]
fn a_device_that_trips_stays_tripped_until_the_operator_clears_it_and_the_session_goes_on() {
    let event = SimulatedEvent {
        trial: 2,
        attempt: Some(1),
        what: Happening::FaultAfterLanding {
            fault: ActiveFault::from(FaultKind::ThermistorOpen),
            from_s: 1.0,
            for_s: 0.5,
        },
    };
    let session = session("p5-real-and-simulated.toml", &[]);
    let ran = run("p5-kept", &session, kept_device(vec![event]), 20);
    let voids: Vec<_> = (ran.records.iter())
        .filter_map(|record| Some((record.trial, record.void.clone()?)))
        .collect();
    assert_eq!(voids.len(), 1, "{voids:?}");
    assert!(voids[0].0 == 2 && voids[0].1.contains("tripped"), "{voids:?}");
    assert_eq!(ran.records.len(), 21);
}

/// Without the wait it would lie there at the tone to touch, in each attempt.
#[test]
fn a_finger_that_lies_on_the_display_when_a_trial_begins_is_named_and_its_lift_is_waited_for() {
    let events = vec![SimulatedEvent { trial: 2, attempt: None, what: Happening::LiesOnDisplay }];
    let session = session("p5-real-and-simulated.toml", &[]);
    let ran = run("p5-lies", &session, kept_device(events), 3);
    let trials: Vec<_> = ran.records.iter().map(|record| (record.trial, &record.void)).collect();
    assert_eq!(trials, [(1, &None), (2, &None), (3, &None)]);
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("p5-lies");
    let log = fs::read_to_string(root.join("sourcedata/sub-01/task-p5/log.jsonl")).expect("a log");
    assert_eq!(log.matches("a finger lies on display 0").count(), 1, "{log}");
}

#[test]
fn a_finger_that_stays_on_the_display_is_not_disturbed_between_two_trials() {
    let session = session("p9-change-threshold.toml", &[]);
    let ran = run("p9-kept", &session, kept_device(Vec::new()), 12);
    let voids: Vec<_> = ran.records.iter().filter_map(|record| record.void.clone()).collect();
    assert!(voids.is_empty(), "{voids:?}");
    // Without a new self-test, way to the base and rest, which take 20 s.
    let length_s = |index: usize| ran.records[index].end_s - ran.records[index].begin_s;
    let longest_s = (1..12).map(length_s).fold(0.0, f64::max);
    assert!(longest_s < length_s(0) - 8.0, "{longest_s} s after {} s", length_s(0));
}

#[test]
fn thresholds_come_down_to_the_noise_of_the_observer() {
    let ran = run("p9", &session("p9-change-threshold.toml", &[]), BenchOptions::default(), 60);
    let (correct, all) = ran.correct();
    assert!(ran.records.iter().all(|record| record.void.is_none()), "{:?}", ran.records[0].void);
    assert!(correct * 2 > all, "{correct} of {all}");
}

#[test]
fn a_display_that_assumes_the_finger_feels_like_the_sample() {
    let file = "p5-real-and-simulated-contact-model.toml";
    let ran = run("p5-contact", &session(file, &[]), noise_free(), 16);
    let identical = (ran.observations.iter()).filter(|felt| {
        let words = |station: usize| felt.presented[station].rsplit(' ').next();
        words(0) == words(1)
    });
    let mut pairs = 0;
    for felt in identical {
        let [Some(left_k), Some(right_k)] = felt.falls_k[..] else {
            panic!("both are felt: {felt:?}");
        };
        assert!((left_k - right_k).abs() < 0.03, "{felt:?}");
        pairs += 1;
    }
    assert_eq!(pairs, 4);
}

#[test]
fn three_displays_at_one_hand() {
    let ran = run("p3", &session("p3-localisation-displays.toml", &[]), noise_free(), 6);
    let (correct, all) = ran.correct();
    assert_eq!((correct, all), (6, 6), "{:?}", ran.observations);
}

/// Holds at 42 °C: each of 11 s at most (1 s to reach, 2 s to land, 8 s of contact) gives 2.75 s at 43 °C, and a device trips at 30 s.
const WARM_HOLDS: &str = r#"format = 1
title = "Warm holds"
task = "dose"
cite = "own"
instruction = "Rate."
[device]
law = "model"
[stations.index]
finger = "right index"
[present]
index = { hold_c = "warm_c" }
[trial]
reach_s = 1
land_s = 2
contact = "hold"
max_s = 8
answer = { ask = "How warm?", number_per_station = [0, 100] }
[design]
factors.warm_c = [41.99, 42]
repeat = 7
break_s = 0
"#;

#[test]
fn the_dose_is_known_before_the_first_trial_and_is_kept_from_trial_to_trial() {
    let session = Session::parse(WARM_HOLDS, Path::new("warm.toml")).expect("a valid session");
    let plan = Plan::new(&session, "01", 1).expect("a plan");
    let reached = DoseReached::in_plan(&session, &plan).expect("14 times 2.75 s are 38.5 s");
    assert_eq!((reached.trial, reached.device_finger), (11, 0));
    assert!((reached.plan_min - 14.0 * 11.0 * 0.25 / 60.0).abs() < 0.01, "{reached:?}");
    let ran = run("dose", &session, noise_free(), 14);
    let voids: Vec<_> = ran.records.iter().filter(|record| record.void.is_some()).collect();
    let (first, last) = (voids.first().expect("a trip"), ran.records.last().expect("records"));
    assert_eq!(first.void.as_deref(), Some("the device tripped: dose"));
    // A trial is shorter than its longest time, so the trip comes later than the plan says.
    assert!((11..=14).contains(&first.trial), "{}", first.trial);
    // The device stays off until a whole trial has decayed, so that the repeated ones are answered.
    assert_eq!(last.void, None);
    let answered = ran.records.iter().filter(|record| record.void.is_none()).count();
    assert_eq!(answered, 14, "{voids:?}");
}
