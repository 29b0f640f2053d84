//! Every screen with a scripted worker, to be looked at: no device, no simulation.
//!
//! `cargo run --example window-demo -p thermal-window --features native -- SCREEN`, where SCREEN is one of those below.

use std::convert::Infallible;
use std::env;
use std::thread;
use std::time::Duration;

use thermal_client::client::{ReceivedTelemetry, Telemetry};
use thermal_device::StateName;
use thermal_device::safety::Fault;
use thermal_session::{
    AnswerKind, ContactRule, Cue, Decision, OperatorQuestion, People, Phase, PlannedTrial,
    Presented, Procedure, Question, Rest, RestPlace, Station, TrialRules, Update,
};
use thermal_window::{
    MonitorPeople, Order, SessionView, StopFlag, Tones, WindowOptions, WindowPeople, run_window,
};

const SCREENS: [&str; 11] = [
    "monitor",
    "tripped",
    "rest",
    "ready",
    "skin",
    "choice",
    "many",
    "numbers",
    "cue",
    "force",
    "instruction",
];
/// Interval of the scripted telemetry, ms.
const INTERVAL_MS: u32 = 10;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let screen = env::args().nth(1).unwrap_or_default();
    if !SCREENS.contains(&screen.as_str()) {
        return Err(format!("which screen? {}", SCREENS.join(", ")).into());
    }
    let is_monitor = ["monitor", "tripped"].contains(&screen.as_str());
    let options = WindowOptions {
        title: "thermal-lab: demonstration".into(),
        session: (!is_monitor).then(session_view),
        stop: StopFlag::default(),
        tones: Some(Tones::start()),
    };
    let shown = run_window(options, move |people| -> Result<(), Infallible> {
        script(people, &screen);
        Ok(())
    })?;
    let latency = shown.latency;
    println!(
        "{} frames, {:?} ms median, {:?} ms 99 %, {} ms at most",
        latency.frames(),
        latency.percentile_ms(50),
        latency.percentile_ms(99),
        latency.longest_ms()
    );
    Ok(())
}

fn session_view() -> SessionView {
    let station = |name: &str| Station {
        name: name.into(),
        finger: format!("{name} index finger"),
        skin_sensor: None,
    };
    SessionView {
        title: "P5: real against simulated materials".into(),
        stations: ["left", "right"].map(station).into(),
        rest: Some(Rest {
            place: RestPlace::Pad,
            skin_c: 34.0,
            within_k: 0.3,
            for_s: 5.0,
            timeout_s: 120.0,
        }),
        rules: TrialRules {
            procedure: Procedure::Touch { reach_s: 5.0, contact: ContactRule::Free, max_s: 10.0 },
            land_s: 3.0,
            answer_s: 20.0,
            feedback: false,
        },
        break_s: 60.0,
        warnings: Vec::new(),
    }
}

fn trial() -> Update {
    Update::Trial {
        trial: PlannedTrial {
            number: 23,
            part: "main".into(),
            block: 2,
            break_before: false,
            levels: vec!["copper".into(), "granite".into()],
            presented: vec![
                Presented::Sample { material: "copper".into() },
                Presented::Material { device_finger: 0, material: "granite".into() },
            ],
            staircase: None,
            target_force_n: Some(1.0),
            correct: Some("left".into()),
        },
        attempt: 2,
        of: 64,
    }
}

fn begin(people: &mut WindowPeople, screen: &str) {
    let question = |ask: &str, kind| Update::Ask(Question { ask: ask.into(), kind });
    let words = |words: &[&str]| AnswerKind::OneOf(words.iter().map(ToString::to_string).collect());
    people.inform(&Update::Notice(
        "connected: thermal-display 0.2.0, 1 finger (demonstration)".into(),
    ));
    if ["monitor", "tripped"].contains(&screen) {
        return;
    }
    people.inform(&trial());
    let updates = match screen {
        "rest" => vec![Update::Phase(Phase::Rest)],
        "ready" => vec![
            Update::Phase(Phase::Rest),
            Update::Decide(OperatorQuestion::Ready(
                "Put the sample of copper to the left. The right finger goes to the display.".into(),
            )),
        ],
        "skin" => vec![
            Update::Phase(Phase::Rest),
            Update::Decide(OperatorQuestion::SkinNotReady { skin_c: Some(32.41), wanted_c: 34.0 }),
        ],
        "choice" => vec![
            Update::Phase(Phase::Respond),
            question("Which side felt colder?", words(&["left", "right"])),
        ],
        "many" => vec![
            Update::Phase(Phase::Respond),
            question("What did you touch?", words(&["copper", "stainless steel", "granite", "ABS", "foam"])),
        ],
        "numbers" => vec![
            Update::Phase(Phase::Respond),
            question("How cold did each finger feel, from 0 (not at all) to 100?", AnswerKind::NumberPerStation(0.0, 100.0)),
        ],
        "cue" => vec![Update::Phase(Phase::Contact), Update::Cue(Cue::Touch)],
        "force" => vec![Update::Phase(Phase::Contact), Update::TargetForce(Some(1.0))],
        _ => vec![Update::Instruction(
            "You will touch two things at the same time, one with each index finger.\n\nAfter each touch, \
             say which of them felt colder. Lift your fingers and touch again as often as you like, but do not \
             stroke them.\n\nRest your hands on the pad until you hear the first tone."
                .into(),
        )],
    };
    for update in updates {
        people.inform(&update);
    }
}

/// Telemetry with lines like those of a display that is touched, until the operator stops.
fn script(people: &mut WindowPeople, screen: &str) {
    begin(people, screen);
    for tick in (0..).step_by(INTERVAL_MS as usize) {
        let t_s = f64::from(tick) * 1e-3;
        people.inform(&Update::Telemetry(line(tick, t_s, screen)));
        if people.response().is_some() {
            people.inform(&Update::Notice("answered".into()));
            people.inform(&Update::Answered(None));
        }
        if screen == "monitor" || screen == "tripped" {
            match people.order() {
                Some(Order::Off) => people.inform(&Update::Notice("bridge off".into())),
                Some(order) => people.inform(&Update::Notice(format!("`{}`: ok", order.word()))),
                None => {}
            }
            if people.is_closing() {
                break;
            }
        } else if let Some(decision) = people.decision() {
            people.inform(&Update::Notice(format!("decided: {decision:?}")));
            if decision == Decision::Stop {
                people.inform(&Update::Ended(Some(
                    "the operator has stopped; the bridge is off".into(),
                )));
                break;
            }
        }
        thread::sleep(Duration::from_millis(INTERVAL_MS.into()));
    }
}

fn line(tick: u32, t_s: f64, screen: &str) -> ReceivedTelemetry {
    let cycle_s = t_s % 12.0;
    let touches = (4.0..9.0).contains(&cycle_s);
    let fall_k = if touches { 6.0 * (1.0 - (-(cycle_s - 4.0) / 1.2).exp()) } else { 0.0 };
    let wobble = 0.05 * (7.0 * t_s).sin();
    let state = match (screen, touches) {
        ("tripped", _) => StateName::Tripped(Fault::SinkHot),
        (_, true) => StateName::Contact,
        (_, false) => StateName::Preset,
    };
    let force_n = if screen == "force" {
        1.0 + 0.3 * (-t_s / 3.0).exp() + 0.04 * (5.0 * t_s).sin()
    } else if touches {
        1.6 + wobble
    } else {
        0.0
    };
    ReceivedTelemetry {
        finger: None,
        telemetry: Telemetry {
            setpoint_c: Some(32.0 - fall_k),
            display_c: Some(32.0 - fall_k + wobble),
            sink_c: Some(27.4),
            skin_c: Some(33.9 - 0.3 * fall_k),
            room_c: Some(23.8),
            force_n: Some(force_n),
            demand_a: Some(if touches { 2.0 } else { -0.6 }),
            current_a: Some(if touches { 2.0 + wobble } else { 0.6 + wobble }),
            ..Telemetry::new(tick, state)
        },
        at: Duration::from_millis(tick.into()),
        lost_before: u32::from(tick == 5000),
    }
}
