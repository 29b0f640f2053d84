//! Discrimination of two materials.

use experiment_statistics::sensitivity::d_prime;

use thermal_thesis::published::PublishedPair;

use super::design::{Contrast, Design};
use super::share::{READING, Share, TOO_FEW, columns, picture, verdict};
use super::{NO_ANSWERS, left_out};
use crate::cells::distinct;
use crate::input::{Stimulus, Task, Trial};
use crate::report::{Column, Section, Table, cells, numbers, words};

/// An answer to two different materials.
pub struct Answer<'a> {
    pub participant: usize,
    pub part: &'a str,
    /// The two materials, that of the larger contact coefficient first.
    pub pair: [&'a str; 2],
    /// Ratio of their contact coefficients, at least 1.
    pub ratio: Option<f64>,
    /// `R/S > 1` if the sample has the larger contact coefficient, `R/S < 1` if the simulated material has; `None` unless one
    /// of the two is a sample and the other simulated.
    pub mode: Option<&'static str>,
    pub is_correct: bool,
}

/// Names of the modes, real over simulated contact coefficient.
const MODES: [&str; 2] = ["R/S > 1", "R/S < 1"];

/// Between the names of the materials of a pair.
pub const BETWEEN: &str = " / ";

impl Answer<'_> {
    fn name(&self) -> String {
        self.pair.join(BETWEEN)
    }
}

/// The two different materials of a trial, that of the larger contact coefficient first.
fn pair_of<'a>(task: &Task, trial: &'a Trial) -> Option<[&'a str; 2]> {
    let materials = trial.stimuli().map(|stimulus| stimulus.material);
    task.sorted(materials.collect::<Vec<_>>()).try_into().ok()
}

/// Names of the pairs that were presented, whether they were answered or not.
fn presented(task: &Task) -> Vec<String> {
    let pairs = task.trials().filter_map(|(_, trial)| pair_of(task, trial));
    distinct(pairs.map(|pair| pair.join(BETWEEN)))
}

/// Says how many trials with two different materials have no scored answer.
fn say_unscored(section: &mut Section, task: &Task) {
    let unscored = task
        .trials()
        .filter(|(_, trial)| trial.record.is_correct.is_none() && pair_of(task, trial).is_some());
    let unscored: Vec<_> = unscored.map(|(participant, _)| participant).collect();
    left_out::count(section, task, &unscored, "trials with two materials and no scored answer");
}

/// The scored answers to two different materials.
pub fn answers(task: &Task) -> Vec<Answer<'_>> {
    let all = task.trials();
    all.filter_map(|(participant, trial)| answer(task, participant, trial)).collect()
}

fn answer<'a>(task: &'a Task, participant: usize, trial: &'a Trial) -> Option<Answer<'a>> {
    let stimuli: Vec<Stimulus<'_>> = trial.stimuli().collect();
    let [colder, warmer] = pair_of(task, trial)?;
    let of_both = task.effusivity(colder).zip(task.effusivity(warmer));
    let ratio = of_both.map(|(one, other)| one / other);
    let mode = match stimuli[..] {
        [one, other] if one.is_simulated != other.is_simulated => {
            let sample = if one.is_simulated { other } else { one };
            Some(MODES[usize::from(sample.material != colder)])
        }
        _ => None,
    };
    Some(Answer {
        participant,
        part: &trial.record.part,
        pair: [colder, warmer],
        ratio: ratio.filter(|ratio| ratio.is_finite()),
        mode,
        is_correct: trial.record.is_correct?,
    })
}

/// The pairs by the place of their materials.
fn names(task: &Task, answers: &[Answer<'_>]) -> Vec<(String, Option<f64>)> {
    let materials = task.sorted(answers.iter().flat_map(|answer| answer.pair));
    let place = |name: &str| materials.iter().position(|one| *one == name);
    let mut pairs = distinct(answers.iter().map(|answer| (answer.pair, answer.ratio)));
    pairs.sort_by_key(|(pair, _)| pair.map(place));
    pairs.into_iter().map(|(pair, ratio)| (pair.join(BETWEEN), ratio)).collect()
}

/// The answers to a pair, in a mode or in all.
fn share(answers: &[Answer<'_>], pair: &str, mode: Option<&str>) -> Share {
    let of_pair = answers.iter().filter(|answer| answer.name() == pair);
    let of_mode = of_pair.filter(|answer| mode.is_none() || answer.mode == mode);
    Share::new(of_mode.map(|answer| (answer.participant, answer.is_correct)))
}

fn table_columns(mode: bool) -> Vec<Column> {
    let mut all = vec![words("pair")];
    if mode {
        all.push(words("mode"));
    }
    all.push(numbers("ratio of contact coefficients", "", 2));
    all.extend(columns());
    all.extend([words("told apart"), numbers("d' (2AFC)", "", 2)]);
    all
}

/// d' of a choice of two, from the log-linear estimate; `None` where chance is not that of a choice of two.
fn d_prime_of(task: &Task, share: &Share) -> Option<f64> {
    is_choice_of_two(task).then(|| d_prime(2, share.proportion()?.log_linear()).ok()).flatten()
}

const CORRECT: &str = "An answer counts as correct by the contact coefficients of the materials, not by what the display did; \
     trials in which it was limited are counted under \"Trials and measures\".";

fn d_prime_note(task: &Task) -> String {
    let threshold = task.threshold.map_or(String::new(), |threshold| {
        format!(
            "Told apart: \"yes\" from {:.0} % correct on, if so many correct answers reach the criterion, too; \"no\" below; \
             \"{TOO_FEW}\" where the share is reached and the criterion is not, or no number of correct answers reaches it. ",
            100.0 * threshold
        )
    });
    let d_prime = if is_choice_of_two(task) {
        "d' of a choice of two is √2 z(p), with p = (k + ½)/(n + 1), so that 0 and 100 % have one, too."
    } else {
        "d' of a choice of two does not apply: the task is no choice of one of two stimuli."
    };
    threshold + d_prime
}

/// Whether the colder of two stations is named.
fn is_choice_of_two(task: &Task) -> bool {
    let is_station = |answer: &String| task.stations.contains(answer);
    task.chance == Some(0.5) && task.answers.len() == 2 && task.answers.iter().all(is_station)
}

/// Answers by pair.
pub fn pairs(task: &Task) -> Section {
    let answers = answers(task);
    let mut section = Section::new("pairs", "Pairs of materials")
        .note(CORRECT)
        .note(READING)
        .note(d_prime_note(task));
    say_unscored(&mut section, task);
    if answers.is_empty() {
        section.lacks("Pairs", NO_ANSWERS);
        return section;
    }
    add_shares(task, &answers, ("pairs", "Correct answers by pair"), &[], &mut section);
    section
}

/// Answers by pair and by which of the two, sample or simulated material, has the larger contact coefficient.
pub fn by_mode(task: &Task) -> Section {
    let answers = answers(task);
    let mut section = Section::new("pairs-by-mode", "Real against simulated materials")
        .note(
            "R/S > 1: the real material (sample) has the larger contact coefficient and should feel colder; R/S < 1: the \
             simulated one has.",
        )
        .note(CORRECT)
        .note(READING)
        .note(d_prime_note(task));
    say_unscored(&mut section, task);
    let alike: Vec<_> = answers
        .iter()
        .filter(|answer| answer.mode.is_none())
        .map(|answer| answer.participant)
        .collect();
    let what = "answers to two samples or two simulated materials, which have no mode";
    left_out::count(&mut section, task, &alike, what);
    if answers.iter().all(|answer| answer.mode.is_none()) {
        section.lacks("Modes", "no scored trial has a sample and a simulated material that differ");
        return section;
    }
    add_shares(
        task,
        &answers,
        ("pairs-by-mode", "Correct answers by pair and mode"),
        &MODES,
        &mut section,
    );
    section
}

/// Adds table and picture of the answers by pair, and by mode if there are modes.
fn add_shares(
    task: &Task,
    answers: &[Answer<'_>],
    (name, caption): (&str, &str),
    modes: &[&'static str],
    section: &mut Section,
) {
    let mut table =
        Table::new(name, &format!("{caption}; n counts answers"), table_columns(!modes.is_empty()));
    let of_pair = match modes {
        [] => vec![None],
        modes => modes.iter().copied().map(Some).collect(),
    };
    let mut marks = Vec::new();
    for (pair, ratio) in names(task, answers) {
        for (series, mode) in of_pair.iter().enumerate() {
            let share = share(answers, &pair, *mode);
            let mut row = cells![pair.clone()];
            row.extend(mode.map(Into::into));
            row.push(ratio.into());
            row.extend(share.cells(task.chance));
            row.extend(cells![verdict(&share, task), d_prime_of(task, &share)]);
            table.row(row);
            marks.extend(share.mark(&*pair, series));
        }
    }
    let series = if modes.is_empty() { &[""][..] } else { modes };
    section.draw(caption, picture(&marks, series, task.chance, task.threshold));
    section.add(table);
}

/// The answers to a published pair.
pub fn share_of(task: &Task, published: &PublishedPair) -> Share {
    let pair = [&*published.first, &*published.second].join(BETWEEN);
    share(&answers(task), &pair, None)
}

/// Correct answers to what a published result is of, `PAIR, MODE`, %.
pub fn measured(task: &Task, of: &str) -> Option<f64> {
    let (pair, mode) = of.split_once(", ")?;
    share(&answers(task), pair, Some(mode)).percent()
}

const DEPENDENT: &str = "correct / %";

/// Observations of a pair in per cent.
fn percent(is_correct: bool) -> f64 {
    100.0 * f64::from(u8::from(is_correct))
}

pub fn design(task: &Task) -> Design {
    let answers = answers(task);
    let levels: Vec<String> = names(task, &answers).into_iter().map(|(pair, _)| pair).collect();
    let observations: Vec<_> = answers
        .iter()
        .map(|answer| (answer.participant, answer.name(), percent(answer.is_correct)))
        .collect();
    Design::one(DEPENDENT, "pair", &levels, &observations)
        .with(Contrast::Mean)
        .without("pair", presented(task))
}

pub fn by_mode_design(task: &Task) -> Design {
    let answers = answers(task);
    let levels: Vec<String> = names(task, &answers).into_iter().map(|(pair, _)| pair).collect();
    let observations: Vec<_> = answers
        .iter()
        .filter_map(|answer| {
            let cell = (answer.name(), answer.mode?.to_owned());
            Some((answer.participant, cell, percent(answer.is_correct)))
        })
        .collect();
    let modes = MODES.map(str::to_owned);
    Design::two(DEPENDENT, ("pair", &levels), ("mode", &modes), &observations)
        .with(Contrast::Mean)
        .without("pair", presented(task))
}

pub fn design_of_parts(task: &Task) -> Design {
    let answers = answers(task);
    let parts: Vec<String> = task.parts().into_iter().map(str::to_owned).collect();
    let levels: Vec<String> = names(task, &answers).into_iter().map(|(pair, _)| pair).collect();
    let observations: Vec<_> = answers
        .iter()
        .map(|answer| {
            let cell = (answer.part.to_owned(), answer.name());
            (answer.participant, cell, percent(answer.is_correct))
        })
        .collect();
    Design::two(DEPENDENT, ("part", &parts), ("pair", &levels), &observations)
        .without("pair", presented(task))
}
