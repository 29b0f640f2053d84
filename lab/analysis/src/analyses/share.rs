//! Shares of correct answers, with their exact intervals and criteria.

use experiment_statistics::proportion::{Proportion, criterion};

use crate::cells::over_participants;
use crate::input::Task;
use crate::picture::{Intervals, Mark};
use crate::report::{Cell, Column, cells, numbers, probabilities, words};

/// Probability below which a number of correct answers is above chance.
const ALPHA: f64 = 0.01;
pub const CONFIDENCE: f64 = 0.95;

/// How a share of correct answers is to be read, for the notes.
pub const READING: &str = "n counts answers over participants and repetitions. The interval is the exact binomial one of 95 % \
     (Clopper and Pearson), p the exact binomial probability of so many correct answers or more by chance, and the criterion the \
     smallest number of correct answers with p < .01. These treat answers of one participant as independent; the mean over \
     participants and its standard error (SEM) do not. Probabilities are not corrected for the number of rows.";

/// Answers of a condition: participant, and whether the answer was correct.
#[derive(Clone, Debug, Default)]
pub struct Share {
    answers: Vec<(usize, bool)>,
}

impl Share {
    pub fn new(answers: impl IntoIterator<Item = (usize, bool)>) -> Self {
        Self { answers: answers.into_iter().collect() }
    }

    /// Participant, and 1 for a correct and 0 for another answer.
    pub fn observations(&self) -> impl Iterator<Item = (usize, f64)> {
        self.answers
            .iter()
            .map(|(participant, correct)| (*participant, f64::from(u8::from(*correct))))
    }

    pub fn total(&self) -> u32 {
        self.answers.len() as u32
    }

    pub fn correct(&self) -> u32 {
        self.answers.iter().filter(|(_, correct)| *correct).count() as u32
    }

    pub fn proportion(&self) -> Option<Proportion> {
        Proportion::new(self.correct(), self.total()).ok()
    }

    pub fn percent(&self) -> Option<f64> {
        Some(100.0 * self.proportion()?.value())
    }

    /// The interval, %.
    pub fn interval(&self) -> Option<(f64, f64)> {
        let interval = self.proportion()?.interval(CONFIDENCE).ok()?;
        Some((100.0 * interval.low, 100.0 * interval.high))
    }

    pub fn mark(&self, row: impl Into<String>, series: usize) -> Option<Mark> {
        Some(Mark { row: row.into(), series, value: self.percent()?, interval: self.interval() })
    }

    /// Smallest number of correct answers that is above chance.
    fn criterion(&self, chance: Option<f64>) -> Option<u32> {
        criterion(self.total(), chance?, ALPHA).ok().flatten()
    }

    /// Cells of [`columns`].
    pub fn cells(&self, chance: Option<f64>) -> Vec<Cell> {
        let (low, high) = self.interval().unzip();
        let by_chance = chance.and_then(|chance| self.proportion()?.p_by_chance(chance).ok());
        let least = self.criterion(chance);
        let observed = self.observations().map(|(participant, value)| (participant, 100.0 * value));
        let (participants, mean, sem) = over_participants(&observed.collect::<Vec<_>>());
        cells![
            self.total(),
            self.correct(),
            self.percent(),
            low,
            high,
            by_chance,
            least,
            participants,
            mean,
            sem
        ]
    }
}

/// Columns of a share.
pub fn columns() -> Vec<Column> {
    vec![
        words("n"),
        words("correct"),
        numbers("share correct", "%", 1),
        numbers("95 % from", "%", 1),
        numbers("95 % to", "%", 1),
        probabilities("p by chance"),
        words("criterion"),
        words("participants"),
        numbers("mean", "%", 1),
        numbers("SEM", "%", 1),
    ]
}

/// A picture of shares.
pub fn picture(
    marks: &[Mark],
    series: &[&str],
    chance: Option<f64>,
    threshold: Option<f64>,
) -> anyhow::Result<String> {
    let named = [(chance, "chance"), (threshold, "threshold")];
    let lines = named.into_iter().filter_map(|(value, name)| {
        let percent = 100.0 * value.filter(|value| value.is_finite())?;
        Some((percent, format!("{name} {percent:.0}")))
    });
    Intervals {
        axis: "correct / %, with the exact interval of 95 %",
        range: (0.0, 100.0),
        step: 20.0,
        series,
        lines: lines.collect(),
    }
    .draw(marks)
}

/// The verdict on answers that are too few for one.
pub const TOO_FEW: &str = "too few answers";

/// Whether the share reaches the session's threshold, in words, so far as the criterion allows any.
pub fn verdict(share: &Share, task: &Task) -> Option<&'static str> {
    let reaches_threshold = share.proportion()?.value() >= task.threshold?;
    // Without chance there is no criterion.
    task.chance?;
    Some(match share.criterion(task.chance) {
        Some(least) if reaches_threshold && share.correct() >= least => "yes",
        Some(_) if !reaches_threshold => "no",
        _ => TOO_FEW,
    })
}
