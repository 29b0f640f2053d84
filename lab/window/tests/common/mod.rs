//! Updates as an executor sends them.

use std::time::Duration;

use thermal_client::client::{ReceivedTelemetry, Telemetry};
use thermal_device::StateName;
use thermal_session::{
    AnswerKind, ContactRule, OperatorQuestion, PlannedTrial, Presented, Procedure, Question, Rest,
    RestPlace, Station, TrialRules, Update,
};
use thermal_window::SessionView;

pub fn session_view() -> SessionView {
    let station = |name: &str| Station {
        name: name.into(),
        finger: format!("{name} index finger"),
        skin_sensor: None,
    };
    SessionView {
        title: "real against simulated".into(),
        stations: ["left", "right"].map(station).into(),
        rest: Some(Rest {
            place: RestPlace::Pad,
            skin_c: 34.0,
            within_k: 0.3,
            for_s: 5.0,
            timeout_s: 120.0,
        }),
        rules: TrialRules {
            target_force_n: None,
            procedure: Procedure::Touch { reach_s: 5.0, contact: ContactRule::Free, max_s: 10.0 },
            land_s: 3.0,
            answer_s: 20.0,
            feedback: false,
        },
        break_s: 60.0,
        warnings: Vec::new(),
    }
}

pub fn trial() -> Update {
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
            target_force_n: None,
            correct: Some("left".into()),
        },
        attempt: 1,
        of: 64,
    }
}

pub fn telemetry(tick: u32, state: StateName, skin_c: f64) -> Update {
    Update::Telemetry(ReceivedTelemetry {
        finger: None,
        telemetry: Telemetry {
            setpoint_c: Some(28.125),
            display_c: Some(28.25),
            sink_c: Some(27.5),
            skin_c: Some(skin_c),
            room_c: Some(23.75),
            force_n: Some(1.625),
            demand_a: Some(2.375),
            current_a: Some(2.5),
            ..Telemetry::new(tick, state)
        },
        at: Duration::from_millis(tick.into()),
        lost_before: 0,
    })
}

pub fn choice() -> Update {
    Update::Ask(Question {
        ask: "Which side felt colder?".into(),
        kind: AnswerKind::OneOf(vec!["left".into(), "right".into()]),
    })
}

pub fn numbers() -> Update {
    Update::Ask(Question {
        ask: "How cold?".into(),
        kind: AnswerKind::NumberPerStation(0.0, 100.0),
    })
}

pub fn operator_questions() -> [OperatorQuestion; 4] {
    [
        OperatorQuestion::Ready("Put copper to the left.".into()),
        OperatorQuestion::SkinNotReady { skin_c: Some(32.5), wanted_c: 34.0 },
        OperatorQuestion::Tripped {
            fault: "sink-hot".into(),
            explanation: "the sink was too warm".into(),
        },
        OperatorQuestion::BreakOver,
    ]
}
