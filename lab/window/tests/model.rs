//! Model, keys and what the windows do with it, without a toolkit.

mod common;

use std::thread;
use std::time::{Duration, Instant};

use common::{choice, numbers, operator_questions, session_view, telemetry, trial};
use thermal_client::client::ReceivedEvent;
use thermal_device::StateName;
use thermal_device::events::{DeviceEvent, DeviceEventKind};
use thermal_device::safety::Fault;
use thermal_session::{Cue, Decision, OperatorQuestion, People, Phase, Response, Update};
use thermal_window::{
    Action, End, Key, Model, MonitorPeople, Order, StopFlag, WindowKind, WindowPeople, action,
};

const WINDOWS: [WindowKind; 2] = [WindowKind::Operator, WindowKind::Participant];

fn s(seconds: f64) -> Duration {
    Duration::from_secs_f64(seconds)
}

/// A model of a session in a trial, after these updates.
fn after(updates: &[Update]) -> Model {
    let mut model = Model::new(Some(session_view()));
    model.fold(&trial(), s(0.0));
    for update in updates {
        model.fold(update, s(1.0));
    }
    model
}

/// One model for every kind of state that the windows can be in.
fn all_situations() -> Vec<Model> {
    let phases = [
        Phase::Connect,
        Phase::Rest,
        Phase::Prepare,
        Phase::Reach,
        Phase::Contact,
        Phase::Respond,
        Phase::Return,
        Phase::Break,
        Phase::End,
    ];
    let mut all = vec![Model::new(None), Model::new(Some(session_view()))];
    all.extend(phases.map(|phase| after(&[Update::Phase(phase)])));
    all.extend(operator_questions().map(|question| after(&[Update::Decide(question)])));
    all.push(after(&[choice()]));
    all.push(after(&[numbers()]));
    all.push(after(&[Update::Cue(Cue::Touch)]));
    all.push(after(&[Update::TargetForce(Some(1.0))]));
    all.push(after(&[telemetry(1, StateName::Tripped(Fault::Dose), 33.0)]));
    all.push(after(&[Update::Ended(None)]));
    all
}

#[test]
fn the_key_of_the_stop_stops_in_every_situation_and_in_both_windows() {
    for model in all_situations() {
        for window in WINDOWS {
            assert_eq!(action(Key::Escape, window, &model), Some(Action::Stop));
        }
    }
}

fn participant_keys() -> impl Iterator<Item = Key> {
    let digits = (0..=9).map(Key::Digit);
    digits.chain([
        Key::Left,
        Key::Right,
        Key::Up,
        Key::Down,
        Key::Enter,
        Key::Tab,
        Key::Backspace,
        Key::Point,
        Key::Minus,
    ])
}

#[test]
fn the_participants_keys_never_stop_or_decide() {
    for model in all_situations() {
        for (window, key) in
            WINDOWS.into_iter().flat_map(|window| participant_keys().map(move |key| (window, key)))
        {
            let action = action(key, window, &model);
            let is_answer = matches!(action, None | Some(Action::Respond(_) | Action::Enter(_)));
            assert!(is_answer, "{key:?} {action:?}");
        }
    }
}

#[test]
fn the_operators_keys_never_answer() {
    let letters = ('a'..='z').map(Key::Letter).chain([Key::Escape, Key::F11]);
    for (model, key) in
        all_situations().iter().flat_map(|model| letters.clone().map(move |key| (model, key)))
    {
        for window in WINDOWS {
            let action = action(key, window, model);
            let answers = matches!(action, Some(Action::Respond(_) | Action::Enter(_)));
            assert!(!answers, "{key:?} {action:?}");
        }
    }
}

#[test]
fn in_the_participants_window_no_key_goes_on_after_a_trip_or_without_the_skin() {
    for question in operator_questions() {
        let is_harmless =
            matches!(question, OperatorQuestion::Ready(_) | OperatorQuestion::BreakOver);
        let model = after(&[Update::Decide(question)]);
        let go_on = Some(Action::Decide(Decision::Continue));
        let key = Key::Letter('c');
        assert_eq!(action(key, WindowKind::Operator, &model), go_on);
        let in_participants = action(key, WindowKind::Participant, &model);
        assert_eq!(in_participants, go_on.filter(|_| is_harmless));
    }
}

#[test]
fn orders_are_given_to_a_monitored_device_only() {
    let key = Key::Letter('a');
    let monitored = Model::new(None);
    assert_eq!(action(key, WindowKind::Operator, &monitored), Some(Action::Order(Order::Arm)));
    for model in all_situations().iter().filter(|model| model.session().is_some()) {
        assert_eq!(action(key, WindowKind::Operator, model), None);
    }
}

#[test]
fn arrows_and_digits_choose_the_answers() {
    let model = after(&[choice()]);
    let answer = |key| action(key, WindowKind::Participant, &model);
    let choice = |index| Some(Action::Respond(Response::Choice(index)));
    assert_eq!(answer(Key::Left), choice(0));
    assert_eq!(answer(Key::Right), choice(1));
    assert_eq!(answer(Key::Digit(1)), choice(0));
    assert_eq!(answer(Key::Digit(2)), choice(1));
    for none in [Key::Digit(0), Key::Digit(3), Key::Up, Key::Enter] {
        assert_eq!(answer(none), None);
    }
}

#[test]
fn the_gate_of_the_skin_counts_how_long_it_holds() {
    let mut model = after(&[Update::Phase(Phase::Rest)]);
    for (tick, skin_c) in [(0, 30.0), (2000, 34.1), (4000, 34.1), (6000, 34.0)] {
        model.fold(&telemetry(tick, StateName::Armed, skin_c), s(f64::from(tick) * 1e-3));
    }
    let gate = model.gate(s(6.0)).unwrap();
    assert!((gate.reached - 0.8).abs() < 1e-3, "{gate:?}");
    assert!(gate.value.unwrap().starts_with("34.00 °C; wanted 34.00 ± 0.30"));
    model.fold(&telemetry(8000, StateName::Armed, 33.0), s(8.0));
    assert!(model.gate(s(8.0)).unwrap().reached < 1e-6);
}

/// Telemetry of a finger.
fn of_finger(finger: u8, tick: u32, skin_c: f64) -> Update {
    let Update::Telemetry(mut line) = telemetry(tick, StateName::Off, skin_c) else {
        unreachable!()
    };
    line.finger = Some(finger);
    Update::Telemetry(line)
}

#[test]
fn the_gate_of_the_skin_is_by_the_thermistors_of_the_running_trial() {
    let mut session = session_view();
    // The display of the right station is finger 0, and measures by its own thermistor.
    session.stations[0].skin_sensor = Some(1);
    let mut model = Model::new(Some(session));
    let Update::Trial { mut trial, attempt, of } = trial() else { unreachable!() };
    let reached = |model: &mut Model, from_s: u32, skins_c: &[(u8, f64)]| {
        model.fold(&Update::Phase(Phase::Rest), s(f64::from(from_s)));
        for second in from_s..=from_s + 4 {
            for (finger, skin_c) in skins_c {
                let line = of_finger(*finger, second * 1000, *skin_c);
                model.fold(&line, s(f64::from(second)));
            }
        }
        model.gate(s(f64::from(from_s + 4))).unwrap().reached
    };
    let begin = |trial: &_| Update::Trial { trial: Clone::clone(trial), attempt, of };
    model.fold(&begin(&trial), s(0.0));
    // A third finger that has reported is on nobody; each of the two others counts.
    let of_both = reached(&mut model, 0, &[(2, 24.0), (1, 34.0), (0, 34.0)]);
    assert!(of_both > 0.7, "{of_both}");
    let of_sample = reached(&mut model, 10, &[(1, 24.0), (0, 34.0)]);
    assert!(of_sample < 1e-6, "{of_sample}");
    // Where nothing is presented, nobody waits for the thermistor.
    trial.presented[0] = thermal_session::Presented::Nothing;
    model.fold(&begin(&trial), s(20.0));
    let of_display = reached(&mut model, 20, &[(1, 24.0), (0, 34.0)]);
    assert!(of_display > 0.7, "{of_display}");
    assert_eq!(model.placement()[0], "left: nothing, under the left index finger");
}

#[test]
fn after_the_landing_the_gate_is_the_end_of_the_contact() {
    let mut model = after(&[Update::Phase(Phase::Contact)]);
    assert_eq!(model.gate(s(2.0)).unwrap().what, "landing");
    let event = ReceivedEvent {
        finger: None,
        event: DeviceEvent { tick: 0, microseconds: 0, kind: DeviceEventKind::Land },
        at: s(2.5),
    };
    model.fold(&Update::Event(event), s(2.5));
    let gate = model.gate(s(4.5)).unwrap();
    assert_eq!((gate.what, gate.left.unwrap().0), ("contact", s(8.0)));
}

#[test]
fn a_trial_says_what_is_placed_where() {
    assert_eq!(
        after(&[]).placement(),
        [
            "left: sample of copper, under the left index finger",
            "right: display 0 as granite, under the right index finger"
        ]
    );
}

#[test]
fn a_void_trial_and_the_end_are_in_the_log() {
    let mut model = after(&[Update::TrialEnded { void: Some("too late".into()) }]);
    assert_eq!(model.notices().back().unwrap().text, "trial 23 is void: too late");
    model.fold(&Update::Ended(Some("stopped".into())), s(3.0));
    assert_eq!(model.end(), Some(&End::Broken("stopped".into())));
    assert!(model.participant().ended && model.question().is_none());
}

#[test]
fn lost_lines_and_silence_are_counted() {
    let mut model = Model::new(None);
    let Update::Telemetry(mut line) = telemetry(5, StateName::Armed, 33.0) else { unreachable!() };
    line.lost_before = 3;
    model.fold(&Update::Telemetry(line), s(1.0));
    assert_eq!((model.link().received, model.link().lost), (1, 3));
    assert_eq!(model.link().silent_for(s(4.0)), Some(s(3.0)));
}

#[test]
fn the_trace_is_twenty_seconds_and_begins_anew_when_the_device_restarts() {
    let mut model = Model::new(None);
    for tick in 0..60_000 {
        model.fold(&telemetry(tick, StateName::Armed, 33.0), s(f64::from(tick) * 1e-3));
    }
    let trace = &model.fingers()[&0].trace;
    assert_eq!(trace.samples().count(), 4001);
    model.fold(&telemetry(7, StateName::Off, 33.0), s(61.0));
    assert_eq!(model.fingers()[&0].trace.samples().count(), 1);
}

#[test]
fn a_flood_of_updates_neither_waits_nor_grows() {
    let (mut people, window_side) =
        WindowPeople::new(Some(session_view()), StopFlag::default(), None);
    people.inform(&trial());
    people.inform(&Update::TargetForce(Some(1.0)));
    let reader = thread::spawn(move || {
        let end = Instant::now() + Duration::from_millis(400);
        while Instant::now() < end {
            // As a window that draws.
            thread::sleep(Duration::from_millis(5));
            let _copy = window_side.snapshot();
        }
        window_side
    });
    let mut longest = Duration::ZERO;
    for tick in 0..100_000 {
        let begin = Instant::now();
        people.inform(&telemetry(tick, StateName::Contact, 33.0));
        people.inform(&Update::Notice(format!("notice {tick}")));
        longest = longest.max(begin.elapsed());
    }
    let window_side = reader.join().unwrap();
    let (model, _) = window_side.snapshot();
    assert_eq!(model.notices().len(), 200);
    assert!(model.fingers()[&0].trace.samples().count() <= 4001);
    assert!(model.participant().follow.as_ref().unwrap().forces.len() <= 2000);
    // Generous, for a machine that is busy: what may not be is that one waits for a frame to be drawn.
    assert!(longest < Duration::from_millis(500), "{longest:?}");
}

#[test]
fn without_a_window_that_looks_nothing_waits() {
    let (mut people, _desk) = WindowPeople::new(None, StopFlag::default(), None);
    for tick in 0..10_000 {
        people.inform(&telemetry(tick, StateName::Armed, 33.0));
    }
    assert_eq!((people.response(), people.decision(), people.order()), (None, None, None));
}

#[test]
fn the_first_answer_counts_and_none_from_before_the_question() {
    let (mut people, window_side) =
        WindowPeople::new(Some(session_view()), StopFlag::default(), None);
    window_side.respond(Response::Choice(0));
    people.inform(&choice());
    assert_eq!(people.response(), None);
    window_side.respond(Response::Choice(1));
    window_side.respond(Response::Choice(0));
    assert_eq!(people.response(), Some(Response::Choice(1)));
    assert_eq!(people.response(), None);
}

#[test]
fn a_decision_is_for_the_question_that_was_shown() {
    let (mut people, window_side) =
        WindowPeople::new(Some(session_view()), StopFlag::default(), None);
    let [ready, skin, ..] = operator_questions();
    people.inform(&Update::Decide(ready));
    window_side.decide(Decision::Continue);
    people.inform(&Update::Decide(skin));
    assert_eq!(people.decision(), None);
    window_side.decide(Decision::Wait);
    assert_eq!(people.decision(), Some(Decision::Wait));
    window_side.decide(Decision::Continue);
    assert_eq!(people.decision(), None);
}

#[test]
fn the_stop_ends_a_session_and_interrupts_the_link() {
    let stop = StopFlag::default();
    let (mut people, window_side) = WindowPeople::new(Some(session_view()), stop.clone(), None);
    window_side.press_stop();
    assert_eq!(people.decision(), Some(Decision::Stop));
    assert_eq!(people.decision(), Some(Decision::Stop));
    assert!(stop.interrupts_link().load(std::sync::atomic::Ordering::SeqCst));
}

#[test]
fn the_stop_of_a_monitor_comes_before_other_orders_and_the_monitor_goes_on() {
    let (mut people, window_side) = WindowPeople::new(None, StopFlag::default(), None);
    window_side.order(Order::Arm);
    window_side.press_stop();
    assert_eq!(people.order(), Some(Order::Off));
    assert_eq!(people.order(), None);
    assert!(!people.is_closing());
    window_side.order(Order::Arm);
    assert_eq!(people.order(), Some(Order::Arm));
    window_side.close();
    assert!(people.is_closing());
}
