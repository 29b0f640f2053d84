//! What is predicted, and the criteria on it.

use serde::Serialize;

use super::condition::Condition;
use super::fit::Fitted;

/// Whether a table was used to find the observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// The observer was fitted to it.
    Fitted,
    /// The observer knows nothing of it.
    Predicted,
}

/// A cell of a table, per cent.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CellResult {
    /// What it is the cell of.
    pub label: String,
    /// Published percentage.
    pub published: f64,
    /// Ours.
    pub predicted: f64,
}

/// A criterion and whether it is met.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What is checked.
    pub what: String,
    /// Result.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
    /// Whether it is.
    pub met: bool,
}

impl Check {
    /// A percentage with an upper limit.
    pub(super) fn at_most(what: &str, value: f64, most: f64) -> Self {
        Self {
            what: what.into(),
            value: format!("{value:.1} %"),
            allowed: format!("at most {most} %"),
            met: value <= most,
        }
    }

    /// A percentage with both limits.
    pub(super) fn within(what: &str, value: f64, least: f64, most: f64) -> Self {
        Self {
            what: what.into(),
            value: format!("{value:.1} %"),
            allowed: format!("{least} to {most} %"),
            met: (least..=most).contains(&value),
        }
    }
}

/// A published table beside the predicted one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TableResult {
    /// Its name.
    pub name: String,
    /// Whether the observer was fitted to it.
    pub basis: Basis,
    /// Parameters, in words.
    pub observer: String,
    /// Its cells.
    pub cells: Vec<CellResult>,
    /// Root mean square of the differences, per cent.
    pub rms: f64,
    /// Mean of the published cells, per cent.
    pub mean_published: f64,
    /// Mean of the predicted ones, per cent.
    pub mean_predicted: f64,
    /// Criteria.
    pub checks: Vec<Check>,
}

/// Section 4.2: identification.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Identification {
    /// Factor by which the observer's noise is multiplied, fitted to both overall percentages correct.
    pub factor: f64,
    /// Materials.
    pub materials: Vec<String>,
    /// Falls on samples and on the thesis's display, K.
    pub falls_k: [Vec<f64>; 2],
    /// Per cent correct of each material, real and simulated.
    pub correct: [Vec<f64>; 2],
    /// Proportions of the answers to each material, real and simulated.
    pub confusions: [Vec<Vec<f64>>; 2],
    /// Overall per cent correct, real and simulated: published and ours.
    pub overall: [CellResult; 2],
    /// Correlation between both confusion matrices.
    pub correlation: f64,
    /// Criteria.
    pub checks: Vec<Check>,
}

/// A pair of section 4.3 on both displays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairResult {
    /// Real material.
    pub real: String,
    /// Simulated material.
    pub simulated: String,
    /// Whether the published proportion is below the threshold.
    pub published_below: bool,
    /// Per cent correct in the order of [`DisplayMode::ALL`](super::DisplayMode::ALL).
    pub correct: [f64; 2],
}

/// A material against itself on both displays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct IdenticalResult {
    /// Material.
    pub material: String,
    /// Fall on the sample, K.
    pub real_k: f64,
    /// Falls on the displays, K.
    pub simulated_k: [f64; 2],
    /// Per cent of trials in which the real one is said to be the colder.
    pub real_colder: [f64; 2],
}

/// Section 4.3 with both displays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RealAgainstSimulated {
    /// Who touches, and how.
    pub condition: Condition,
    /// Pairs of different materials.
    pub pairs: Vec<PairResult>,
    /// Mean per cent correct over them.
    pub means: [f64; 2],
    /// Largest difference between the displays for a pair, percentage points.
    pub largest_difference: f64,
    /// Identical pairs.
    pub identical: Vec<IdenticalResult>,
    /// Criteria, for the thesis's display.
    pub checks: Vec<Check>,
}

/// What an error of the skin's temperature is worth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worth {
    /// The observer.
    pub observer: String,
    /// Fall from which the error departs, K.
    pub fall_k: f64,
    /// Errors, mK, and per cent of trials in which the colder of two stimuli that differ by them is found.
    pub correct: Vec<(f64, f64)>,
    /// Difference that is found in 75 % of the trials, K, without lapses.
    pub threshold_75_k: f64,
}

/// Expected falls on samples, K.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Falls {
    /// Skin and room, °C.
    pub skin_room_c: (f64, f64),
    /// Fall on each material.
    pub falls_k: Vec<(String, f64)>,
}

impl Falls {
    /// Fall on a material, K; zero for one that is not in the list.
    pub(super) fn of(&self, name: &str) -> f64 {
        let found = self.falls_k.iter().find(|(known, _)| known == name);
        found.map_or(0.0, |(_, fall_k)| *fall_k)
    }
}

/// All predictions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Falls of sections 3.2 and 3.3.
    pub falls: Falls,
    /// The observer fitted to both tables.
    pub fitted: Fitted,
    /// The observer fitted to Table 3-3 alone, with a factor of three fingers of 1.
    pub without_table_3_5: Fitted,
    /// The observer fitted to Table 3-5 alone, with a factor of three fingers of 1.
    pub without_table_3_3: Fitted,
    /// Both tables, each fitted and predicted.
    pub tables: Vec<TableResult>,
    /// Section 4.2.
    pub identification: Identification,
    /// Section 4.3 at its gate, with the skin that it reports, at its gate with one touch in place of many, and at its gate with
    /// fingers of layered tissue.
    pub real_against_simulated: Vec<RealAgainstSimulated>,
    /// Worth of errors of the skin's temperature.
    pub worth: Vec<Worth>,
}
