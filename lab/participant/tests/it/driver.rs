//! Calls link and people as the executor does, without a data set.

use std::time::Duration;

use thermal_client::link::Link;
use thermal_participant::{Bench, Observation};
use thermal_session::{
    Answer, AnswerKind, ContactRule, CorrectAnswer, Cue, Design, OperatorQuestion, People, Phase,
    Plan, PlannedTrial, Presented, Procedure, Question, Response, Score, Session, Station,
    TrialRules, Update, VoidRules,
};

const POLL: Duration = Duration::from_millis(20);
const REST: Duration = Duration::from_secs(2);

/// A session on samples whose stations have these names, with these answers.
pub fn session(stations: &[&str], answers: &[&str]) -> Session {
    Session {
        title: "Test".into(),
        task: "test".into(),
        cite: String::new(),
        instruction: String::new(),
        device: None,
        stations: (stations.iter())
            .map(|name| Station {
                name: (*name).into(),
                finger: "index".into(),
            })
            .collect(),
        rest: None,
        trial: TrialRules {
            procedure: Procedure::Touch {
                reach_s: 0.0,
                contact: ContactRule::Free,
                max_s: 10.0,
            },
            land_s: 5.0,
            answer_s: 10.0,
            feedback: false,
        },
        answer: Some(Answer {
            ask: "?".into(),
            kind: AnswerKind::OneOf(answers.iter().map(|word| (*word).into()).collect()),
        }),
        design: Design {},
        staircases: Vec::new(),
        break_s: 60.0,
        voids: VoidRules {
            display_off_preset_k: 0.3,
            force_max_n: 5.0,
            contact_min_s: 0.5,
            force_off_target: None,
            landings_apart_s: None,
            attempts_max: 3,
        },
        score: Score {
            correct: CorrectAnswer::ColderStation,
            chance: Some(0.5),
            threshold: None,
            analyses: Vec::new(),
        },
        text: String::new(),
    }
}

/// A trial with a sample at each station.
pub fn sample_trial(number: u32, materials: &[&str]) -> PlannedTrial {
    PlannedTrial {
        number,
        part: "test".into(),
        block: 1,
        break_before: false,
        levels: Vec::new(),
        presented: (materials.iter())
            .map(|material| Presented::Sample {
                material: (*material).into(),
            })
            .collect(),
        staircase: None,
        target_force_n: None,
        correct: None,
    }
}

/// A plan of trials.
pub fn plan(trials: Vec<PlannedTrial>) -> Plan {
    Plan {
        factors: Vec::new(),
        trials,
    }
}

/// Runs a trial on samples, and returns the answer.
pub fn touch_samples(bench: &Bench, trial: &PlannedTrial, attempt: u32, of: usize) -> Option<Response> {
    let (mut link, mut people) = (bench.link(), bench.people());
    people.inform(&Update::Trial {
        trial: trial.clone(),
        attempt,
        of,
    });
    people.inform(&Update::Decide(OperatorQuestion::Ready("samples".into())));
    while people.decision().is_none() {
        link.receive(POLL).expect("time passes");
    }
    for (phase, wait) in [
        (Phase::Rest, REST),
        (Phase::Prepare, POLL),
        (Phase::Reach, POLL),
    ] {
        people.inform(&Update::Phase(phase));
        link.receive(wait).expect("time passes");
    }
    people.inform(&Update::Cue(Cue::Touch));
    people.inform(&Update::Phase(Phase::Contact));
    people.inform(&Update::Ask(Question {
        ask: "?".into(),
        kind: AnswerKind::OneOf(Vec::new()),
    }));
    let end = link.now() + Duration::from_secs(12);
    let mut response = None;
    while response.is_none() && link.now() < end {
        link.receive(POLL).expect("time passes");
        response = people.response();
    }
    people.inform(&Update::Answered(response.clone()));
    people.inform(&Update::Phase(Phase::Return));
    link.receive(Duration::from_millis(500)).expect("time passes");
    people.inform(&Update::TrialEnded { void: None });
    response
}

/// Runs all trials on samples.
pub fn run_samples(bench: &Bench, plan: &Plan) -> Vec<Observation> {
    for trial in &plan.trials {
        touch_samples(bench, trial, 1, plan.trials.len());
    }
    bench.observations()
}
