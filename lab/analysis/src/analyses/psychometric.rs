//! Psychometric functions, fitted to the answers at all levels.

use experiment_statistics::proportion::Proportion;
use experiment_statistics::psychometric::{Fit, Level, Model, Shape};

use super::left_out;
use super::share::CONFIDENCE;
use crate::input::{Task, Trial, finite};
use crate::picture::{Curve, Stroke, color, lines, positive_range};
use crate::report::{Section, Table, cells, numbers, probabilities, words};

/// Largest rate of lapses that is fitted; without a limit it would spoil the slope.
const LAPSE_MAX: f64 = 0.06;
/// Part between chance and certainty at which the threshold is taken: 75 % of a choice of two.
const PART: f64 = 0.5;
/// Relative difference below which levels are the same: a staircase multiplies and divides by its factor.
const SAME_LEVEL: f64 = 1e-6;
const SAMPLES: usize = 400;
/// Expected count of correct or wrong answers at a level below which the distribution of the deviance is a poor approximation.
const EXPECTED_MIN: f64 = 5.0;
/// The same data give the same interval.
const SEED: u64 = 1;

/// Positive level and score of a trial.
fn point(trial: &Trial) -> Option<(f64, bool)> {
    Some((trial.change_k().filter(|level| *level > 0.0)?, trial.record.is_correct?))
}

/// The answers at each level.
fn levels<'a>(trials: impl Iterator<Item = &'a Trial>) -> Vec<Level> {
    let mut counts: Vec<(f64, u32, u32)> = Vec::new();
    for trial in trials {
        let Some((level, is_correct)) = point(trial) else {
            continue;
        };
        let at =
            match counts.iter().position(|(known, ..)| (known / level - 1.0).abs() < SAME_LEVEL) {
                Some(at) => at,
                None => {
                    counts.push((level, 0, 0));
                    counts.len() - 1
                }
            };
        counts[at].1 += u32::from(is_correct);
        counts[at].2 += 1;
    }
    counts.sort_by(|one, other| one.0.total_cmp(&other.0));
    let level = |(level, correct, total): (f64, u32, u32)| {
        Proportion::new(correct, total).ok().map(|answers| Level { level, answers })
    };
    counts.into_iter().filter_map(level).collect()
}

/// Fits for each condition, of all participants together and of each.
pub fn psychometric_fit(task: &Task) -> Section {
    let chance = task.chance.filter(|chance| (0.0..1.0).contains(chance)).unwrap_or(0.5);
    let proportion = chance + PART * (1.0 - chance);
    let mut section = Section::new("psychometric-fit", "Psychometric functions").note(format!(
        "Weibull functions, fitted by maximum likelihood, with chance {chance:.3} and a rate of lapses up to {LAPSE_MAX}. The \
         threshold is the level with {:.1} % correct; its interval of 95 % is that of {SAMPLES} parametric bootstrap samples, of all participants together. p \
         is that of the deviance: a small one says that the function does not describe the answers.",
        100.0 * proportion
    ));
    let mut table = Table::new(
        "psychometric-fit",
        "Fitted functions; n counts answers",
        [
            words("condition"),
            words("participants"),
            words("n"),
            words("levels"),
            numbers("threshold", "K", 4),
            numbers("95 % from", "K", 4),
            numbers("95 % to", "K", 4),
            numbers("slope", "", 2),
            numbers("lapses", "", 3),
            numbers("deviance", "", 2),
            probabilities("p"),
        ],
    );
    let others =
        task.trials().filter(|(_, trial)| trial.change_k().is_some() && point(trial).is_none());
    let others: Vec<_> = others.map(|(participant, _)| participant).collect();
    let what = "trials without a positive level or without a scored answer";
    left_out::count(&mut section, task, &others, what);
    let (mut curves, mut poor) = (Vec::new(), Vec::new());
    for (series, condition) in conditions(task).into_iter().enumerate() {
        let mut groups = vec![("all".to_owned(), (0..task.participants.len()).collect::<Vec<_>>())];
        if task.participants.len() > 1 {
            groups.extend(
                (0..task.participants.len())
                    .map(|one| (task.participants[one].code.clone(), vec![one])),
            );
        }
        for (name, members) in groups {
            let own = task.trials().filter(|(one, trial)| {
                members.contains(one) && self::condition(task, trial).as_ref() == Some(&condition)
            });
            let levels = levels(own.map(|(_, trial)| trial));
            let total: u32 = levels.iter().map(|level| level.answers.total()).sum();
            let model = Model { shape: Shape::Weibull, guess: chance, lapse: 0.0 };
            let fit = model.fit_with_lapse(&levels, LAPSE_MAX);
            let fitted =
                fit.and_then(|fit| fit.threshold(proportion).map(|threshold| (fit, threshold)));
            match &fitted {
                Ok((fit, threshold)) => {
                    let is_all = members.len() == task.participants.len();
                    let bootstrap = is_all
                        .then(|| fit.bootstrap(&levels, proportion, CONFIDENCE, SAMPLES, SEED));
                    if let Some(Err(error)) = &bootstrap {
                        section.lacks(&format!("Interval of {condition}, {name}"), error);
                    }
                    let bootstrap = bootstrap.and_then(Result::ok);
                    let failed = bootstrap.map_or(0, |bootstrap| bootstrap.failed);
                    section.warn((failed > 0).then(|| {
                        format!(
                            "{condition}, {name}: the interval is without {failed} of {SAMPLES} bootstrap samples, which determine no \
                             function."
                        )
                    }));
                    let few = few_answers(fit, &levels);
                    poor.extend(few.map(|few| format!("{condition}, {name}: {few}")));
                    let interval = bootstrap.map(|bootstrap| bootstrap.interval);
                    table.row(cells![
                        condition.clone(),
                        name.clone(),
                        total,
                        levels.len(),
                        threshold.level,
                        interval.map(|interval| interval.low),
                        interval.map(|interval| interval.high),
                        fit.slope,
                        fit.model.lapse,
                        fit.deviance,
                        fit.deviance_p
                    ]);
                }
                Err(error) => section.lacks(&format!("{condition}, {name}"), error),
            }
            if name == "all" {
                curves.extend(drawn(
                    &condition,
                    series,
                    &levels,
                    fitted.as_ref().ok().map(|(fit, _)| fit),
                ));
            }
        }
    }
    section.warn((!poor.is_empty()).then(|| {
        format!(
            "p of the deviance is a poor approximation where fewer than {EXPECTED_MIN} correct or wrong answers are expected at a \
             level ({}).",
            poor.join("; ")
        )
    }));
    if !curves.is_empty() {
        let range =
            positive_range(curves.iter().flat_map(|curve| curve.points.iter().map(|(x, _)| *x)));
        section.draw(
            "Share of correct answers by level (dots) and fitted function (line), all participants",
            lines(range, "change / K", "correct / %", &curves),
        );
    }
    if table.rows.is_empty() && section.not_possible.is_empty() {
        section.lacks("Function", "no trial that counts has a level and an answer that is scored");
    }
    section.add(table);
    section
}

/// Number of levels at which few correct or wrong answers are expected, in words; `None` without such levels or without p.
fn few_answers(fit: &Fit, levels: &[Level]) -> Option<String> {
    let expected = |level: &&Level| {
        let p = fit.probability(level.level).unwrap_or(0.0);
        f64::from(level.answers.total()) * p.min(1.0 - p)
    };
    let few = levels.iter().filter(|level| expected(level) < EXPECTED_MIN).count();
    (fit.deviance_p.is_some() && few > 0).then(|| format!("{few} of {} levels", levels.len()))
}

/// What a function is fitted for: a staircase, or what the factors say.
fn condition(task: &Task, trial: &Trial) -> Option<String> {
    trial.change_k()?;
    Some(match trial.staircase.and_then(|index| task.staircases.get(index)) {
        Some((name, _)) => name.clone(),
        None => trial.record.part.clone(),
    })
}

fn conditions(task: &Task) -> Vec<String> {
    crate::cells::distinct(task.trials().filter_map(|(_, trial)| condition(task, trial)))
}

fn drawn(name: &str, series: usize, levels: &[Level], fit: Option<&Fit>) -> Vec<Curve> {
    let dots = levels.iter().map(|level| (level.level, 100.0 * level.answers.value()));
    let last = levels.last().map_or(0.0, |level| level.level);
    let at = |step: u32| {
        let level = last * f64::from(step) / 200.0;
        let p = fit?.probability(level).ok().and_then(finite)?;
        Some((level, 100.0 * p))
    };
    let mut curves = vec![
        Curve {
            name: name.into(),
            color: color(series),
            stroke: Stroke::Dots,
            points: dots.collect(),
        },
        Curve {
            name: "its function".into(),
            color: color(series),
            stroke: Stroke::Solid(2),
            points: (1..=200).filter_map(at).collect(),
        },
    ];
    curves.retain(|curve| !curve.points.is_empty());
    curves
}
