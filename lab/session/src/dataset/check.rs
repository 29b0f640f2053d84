//! Whether one session can have written the records of a log.

use std::collections::BTreeMap;

use super::log::{Entry, LogLine};
use crate::record::TrialRecord;
use crate::{AnswerKind, Plan, PlannedTrial, Session};

/// Largest overlap of two trials, s: times are recorded in steps of 0.1 ms.
const OVERLAP_MAX_S: f64 = 1e-3;

/// What contradicts session file, plan or another record: number of the line, from 1, and the contradiction.
pub(super) fn contradictions(
    session: &Session,
    plan: &Plan,
    lines: &[LogLine],
) -> Vec<(usize, String)> {
    let planned: BTreeMap<u32, &PlannedTrial> =
        plan.trials.iter().map(|trial| (trial.number, trial)).collect();
    let mut found = Vec::new();
    let mut before = Before::default();
    for (number, line) in (1..).zip(lines) {
        let Entry::Record { record, .. } = &line.entry else {
            continue;
        };
        let of_plan = match planned.get(&record.trial) {
            Some(planned) => of_plan(planned, record),
            None => Some(format!("the plan has {} trials", planned.len())),
        };
        let problems =
            [of_order(&before, record), of_plan, of_answer(session, record), of_score(record)];
        let which = format!("trial {}, attempt {}", record.trial, record.attempt);
        found.extend(problems.into_iter().flatten().map(|why| (number, format!("{which}: {why}"))));
        before.add(number, record);
    }
    found
}

/// The records before one, with their lines.
#[derive(Default)]
struct Before<'a> {
    last: Option<(usize, &'a TrialRecord)>,
    /// The line of each attempt at a trial.
    attempts: BTreeMap<(u32, u32), usize>,
    /// The last attempt at each trial, with its line.
    trials: BTreeMap<u32, (usize, &'a TrialRecord)>,
}

impl<'a> Before<'a> {
    fn add(&mut self, line: usize, record: &'a TrialRecord) {
        self.last = Some((line, record));
        self.attempts.entry((record.trial, record.attempt)).or_insert(line);
        self.trials.insert(record.trial, (line, record));
    }
}

/// What contradicts the records before.
fn of_order(before: &Before<'_>, record: &TrialRecord) -> Option<String> {
    if let Some(line) = before.attempts.get(&(record.trial, record.attempt)) {
        return Some(format!("it is recorded twice, first in line {line}"));
    }
    let (attempts, counts) = match before.trials.get(&record.trial) {
        Some((line, other)) => (other.attempt, other.void.is_none().then_some(line)),
        None => (0, None),
    };
    if let Some(line) = counts {
        return Some(format!("attempt {attempts}, of line {line}, counts already"));
    }
    if record.attempt != attempts + 1 {
        return Some(format!("it follows {attempts} attempt(s)"));
    }
    if record.end_s < record.begin_s {
        return Some(format!(
            "it ends at {} s, before its begin at {} s",
            record.end_s, record.begin_s
        ));
    }
    let (line, last) = before.last?;
    (record.begin_s < last.end_s - OVERLAP_MAX_S).then(|| {
        format!(
            "it begins at {} s, before the trial of line {line} has ended, at {} s",
            record.begin_s, last.end_s
        )
    })
}

/// What contradicts the plan.
fn of_plan(planned: &PlannedTrial, record: &TrialRecord) -> Option<String> {
    if record.levels != planned.levels || record.part != planned.part {
        return Some(format!(
            "it is of {} {:?}; by the plan it is of {} {:?}",
            record.part, record.levels, planned.part, planned.levels
        ));
    }
    (record.expected != planned.correct).then(|| {
        format!(
            "the correct answer is {}; by the plan it is {}",
            word(record.expected.as_deref()),
            word(planned.correct.as_deref())
        )
    })
}

/// Whether the answer is none that the participant can have given.
fn of_answer(session: &Session, record: &TrialRecord) -> Option<String> {
    let answer = record.answer.as_deref()?;
    let allowed = match session.answer.as_ref().map(|answer| &answer.kind) {
        Some(AnswerKind::OneOf(words)) if words.iter().any(|word| word == answer) => return None,
        Some(AnswerKind::OneOf(words)) => format!("allows {}", words.join(", ")),
        Some(AnswerKind::NumberPerStation(least, most)) => {
            let is_allowed = |number: &str| {
                number.parse().is_ok_and(|number: f64| (*least..=*most).contains(&number))
            };
            if answer.split(';').all(is_allowed) {
                return None;
            }
            format!("allows numbers from {least} to {most}, joined by ;")
        }
        None => "asks for none".into(),
    };
    Some(format!("the answer is {}; session.toml {allowed}", word(Some(answer))))
}

/// Whether the score contradicts the answer.
fn of_score(record: &TrialRecord) -> Option<String> {
    let (answer, expected) = (record.answer.as_deref(), record.expected.as_deref());
    let is_correct = answer.zip(expected).map(|(answer, expected)| answer == expected);
    (record.is_correct != is_correct).then(|| {
        let score = match record.is_correct {
            Some(true) => "correct",
            Some(false) => "wrong",
            None => "not scored",
        };
        format!(
            "the answer {} is recorded as {score}, and the correct one is {}",
            word(answer),
            word(expected)
        )
    })
}

fn word(answer: Option<&str>) -> String {
    answer.map_or("none".into(), |answer| format!("'{answer}'"))
}
