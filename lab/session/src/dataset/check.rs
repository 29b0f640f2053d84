//! Whether one session can have written the records of a log.

use super::log::{Entry, LogLine};
use crate::Plan;
use crate::record::TrialRecord;

/// Largest overlap of two trials, s: times are recorded in steps of 0.1 ms.
const OVERLAP_MAX_S: f64 = 1e-3;

/// What contradicts a plan or another record: number of the line, from 1, and the contradiction.
pub(super) fn contradictions(plan: &Plan, lines: &[LogLine]) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut before: Vec<(usize, &TrialRecord)> = Vec::new();
    for (number, line) in (1..).zip(lines) {
        let Entry::Record { record, .. } = &line.entry else {
            continue;
        };
        let problems = [of_order(&before, record), of_plan(plan, record), of_answer(record)];
        let which = format!("trial {}, attempt {}", record.trial, record.attempt);
        found.extend(problems.into_iter().flatten().map(|why| (number, format!("{which}: {why}"))));
        before.push((number, record));
    }
    found
}

/// What contradicts the records before, whose lines are given.
fn of_order(before: &[(usize, &TrialRecord)], record: &TrialRecord) -> Option<String> {
    let is_same =
        |other: &TrialRecord| (other.trial, other.attempt) == (record.trial, record.attempt);
    if let Some((line, _)) = before.iter().find(|(_, other)| is_same(other)) {
        return Some(format!("it is recorded twice, first in line {line}"));
    }
    if record.end_s < record.begin_s {
        return Some(format!(
            "it ends at {} s, before its begin at {} s",
            record.end_s, record.begin_s
        ));
    }
    let (line, last) = before.last()?;
    (record.begin_s < last.end_s - OVERLAP_MAX_S).then(|| {
        format!(
            "it begins at {} s, before the trial of line {line} has ended, at {} s",
            record.begin_s, last.end_s
        )
    })
}

/// What contradicts the plan.
fn of_plan(plan: &Plan, record: &TrialRecord) -> Option<String> {
    let Some(planned) = plan.trials.iter().find(|trial| trial.number == record.trial) else {
        return Some(format!("the plan has {} trials", plan.trials.len()));
    };
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

/// Whether the score contradicts the answer.
fn of_answer(record: &TrialRecord) -> Option<String> {
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
