//! Staircases: tracks and thresholds.

use experiment_statistics::t_test::one_sample;

use super::left_out;
use super::share::CONFIDENCE;
use crate::input::{Task, Trial, finite};
use crate::picture::{Curve, Stroke, color, lines, positive_range};
use crate::report::{Section, Table, cells, numbers, words};

/// The track of a participant on a staircase.
struct Track<'a> {
    participant: &'a str,
    trials: Vec<(f64, bool)>,
}

fn track<'a>(code: &'a str, trials: &[Trial], staircase: usize) -> Track<'a> {
    let own = trials.iter().filter(|trial| trial.staircase == Some(staircase));
    Track { participant: code, trials: own.filter_map(step).collect() }
}

/// Level and score of a trial of a staircase.
fn step(trial: &Trial) -> Option<(f64, bool)> {
    let level_k = trial.record.staircase_level_k.and_then(finite)?;
    Some((level_k, trial.record.is_correct?))
}

/// Tracks and thresholds by participant, and their mean.
pub fn staircase(task: &Task) -> Section {
    let mut section = Section::new("staircase", "Staircases").note(
        "The threshold is the geometric mean of the last reversals that the session file counts; two correct answers down and one \
         wrong one up converges to 70.7 % correct. The mean over participants is geometric, and its interval is that of t on the \
         logarithms.",
    );
    if task.staircases.is_empty() {
        section.lacks("Thresholds", "the session has no staircase");
        return section;
    }
    let mut table = Table::new(
        "staircases",
        "Thresholds; n counts trials",
        [
            words("staircase"),
            words("participant"),
            words("n"),
            words("reversals"),
            numbers("threshold", "K", 4),
            numbers("95 % from", "K", 4),
            numbers("95 % to", "K", 4),
        ],
    );
    let unscored =
        task.trials().filter(|(_, trial)| trial.staircase.is_some() && step(trial).is_none());
    let unscored: Vec<_> = unscored.map(|(participant, _)| participant).collect();
    let what = "trials of staircases without a level or a scored answer";
    left_out::count(&mut section, task, &unscored, what);
    for (index, (name, initial)) in task.staircases.iter().enumerate() {
        let mut curves = Vec::new();
        let mut wrong_answers = Vec::new();
        let mut logarithms = Vec::new();
        for (series, participant) in task.participants.iter().enumerate() {
            let track = track(&participant.code, &participant.trials, index);
            if track.trials.is_empty() {
                section.lacks(&format!("{name}, {}", participant.code), "no trial of it counts");
                continue;
            }
            let mut replayed = initial.clone();
            for (_, is_correct) in &track.trials {
                replayed.answered(*is_correct);
            }
            let threshold_k = replayed.threshold().and_then(finite);
            if threshold_k.is_none() {
                section.lacks(
                    &format!("{name}, {}", participant.code),
                    "it has not ended with enough reversals",
                );
            }
            logarithms.extend(threshold_k.filter(|threshold| *threshold > 0.0).map(f64::ln));
            table.row(cells![
                name.clone(),
                track.participant,
                track.trials.len(),
                replayed.reversals().len(),
                threshold_k,
                None::<f64>,
                None::<f64>
            ]);
            curves.push(Curve {
                name: track.participant.into(),
                color: color(series),
                stroke: Stroke::Solid(2),
                points: steps(&track.trials),
            });
            wrong_answers.extend(wrong(&track.trials));
        }
        if let Ok(test) = one_sample(&logarithms, 0.0) {
            let interval = test.interval(CONFIDENCE).ok();
            table.row(cells![
                name.clone(),
                format!("geometric mean of {}", logarithms.len()),
                None::<u32>,
                None::<u32>,
                test.difference.exp(),
                interval.map(|interval| interval.low.exp()),
                interval.map(|interval| interval.high.exp())
            ]);
        }
        if !curves.is_empty() {
            curves.push(Curve {
                name: "wrong answers".into(),
                color: color(7),
                stroke: Stroke::Dots,
                points: wrong_answers,
            });
            let trials = positive_range(
                curves.iter().flat_map(|curve| curve.points.iter().map(|(x, _)| *x)),
            );
            section.draw(
                format!("{name}: level by trial (lines) and wrong answers (dots); −1 is 0.1 K"),
                lines(trials, "trial of the staircase", "log10 of level / K", &logarithmic(curves)),
            );
        }
    }
    section.add(table);
    section
}

fn steps(trials: &[(f64, bool)]) -> Vec<(f64, f64)> {
    (1..).zip(trials).map(|(number, (level_k, _))| (f64::from(number), *level_k)).collect()
}

fn wrong(trials: &[(f64, bool)]) -> Vec<(f64, f64)> {
    let numbered = (1..).zip(trials);
    let wrong = numbered.filter(|(_, (_, is_correct))| !is_correct);
    wrong.map(|(number, (level_k, _))| (f64::from(number), *level_k)).collect()
}

/// Levels change by factors, so that their logarithms have equal steps.
fn logarithmic(mut curves: Vec<Curve>) -> Vec<Curve> {
    for curve in &mut curves {
        curve.points.retain(|(_, level)| *level > 0.0);
        for (_, level) in &mut curve.points {
            *level = level.log10();
        }
    }
    curves
}
