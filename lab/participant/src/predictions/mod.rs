//! Predicted results beside published ones, and what the fidelity of a display is worth in per cent correct.
//!
//! The falls are those of the simulated finger on samples and on the simulated device in free exploration; the observer turns
//! them into proportions in closed form. Noise, factor of three fingers and lapses are fitted to Tables 3-3 and 3-5, the
//! factor of identification to section 4.2; everything else is predicted.

pub mod closed_form;
pub mod fit;
pub mod published;
mod text;

use contact_model::material::{Material, find};
use experiment_statistics::StatisticsError;
use experiment_statistics::correlation::pearson;
use serde::Serialize;
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_plant::Params;
use thermal_plant::finger::FingerParams;
use thermal_session::ContactRule;
use thermal_thesis::published::{
    ANSWERS_OF_TABLE_3_3, ANSWERS_OF_TABLE_3_5, PublishedPair, discrimination, localisation,
};

use crate::device::PreparedDevice;
use crate::falls::{Exploration, TouchSetup, mean_fall_k};
use crate::{BenchError, HandParams, ObserverParams};
use closed_form::{colder, identified};
use fit::{Cell, CellTask, Fitted, fit};
use published::{
    SECTION_3, SECTION_4_2, SECTION_4_2_C, SECTION_4_2_CORRELATION, SECTION_4_2_MATERIALS,
    SECTION_4_3_BELOW, SECTION_4_3_C, SECTION_4_3_MATERIALS, SECTION_4_3_REPORTED_C,
    TABLE_3_3_MATERIALS, THRESHOLD_PERCENT,
};

/// Explorations over which falls on displays, and those on samples beside them, are averaged.
const EXPLORATIONS: u32 = 12;
/// Seed of the device's parts.
const DEVICE_SEED: u64 = 1;

/// Why nothing was predicted.
#[derive(Debug, thiserror::Error)]
pub enum PredictionError {
    /// The simulated bench.
    #[error(transparent)]
    Bench(#[from] BenchError),
    /// The answers have no correlation.
    #[error(transparent)]
    Statistics(#[from] StatisticsError),
    /// The search for the most likely observer.
    #[error("the fit failed: {0}")]
    Fit(String),
}

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

/// A display mode of section 4.3's experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DisplayMode {
    /// The thesis's display: Eq. 3-1 and a loop of 10 Hz.
    SemiInfinitePi10Hz,
    /// This display: contact resistance and the model's law.
    ContactModel,
}

impl DisplayMode {
    /// Both, the thesis's first.
    pub const ALL: [Self; 2] = [Self::SemiInfinitePi10Hz, Self::ContactModel];

    /// Its words on the line.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::SemiInfinitePi10Hz => "semi-infinite/pi-10hz",
            Self::ContactModel => "contact/model",
        }
    }

    const fn setting(self) -> (ContactModel, Law) {
        match self {
            Self::SemiInfinitePi10Hz => (ContactModel::SemiInfinite, Law::Pi10Hz),
            Self::ContactModel => (ContactModel::ContactResistance, Law::Model),
        }
    }
}

/// Section 4.2: identification.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Identification {
    /// Fitted factor on the noise.
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
    /// Per cent correct in the order of [`DisplayMode::ALL`].
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

/// Who touches, and how.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// Skin and room, °C.
    pub skin_room_c: (f64, f64),
    /// Whether the participants lift and replace their fingers, as in the thesis, or touch once.
    pub lifts: bool,
    /// Whether their fingers are layered tissue with blood, or the thesis's half-spaces; displays assume what they are.
    pub is_layered: bool,
}

impl Condition {
    /// The thesis's finger, which is lifted and replaced.
    const fn of_thesis(skin_room_c: (f64, f64)) -> Self {
        Self {
            skin_room_c,
            lifts: true,
            is_layered: false,
        }
    }

    fn setup(&self) -> TouchSetup {
        let (skin_c, room_c) = self.skin_room_c;
        let mut params = Params::nominal();
        let assumed_finger = if self.is_layered {
            params.finger = FingerParams::layered();
            AssumedFinger::Mean
        } else {
            AssumedFinger::Thesis
        };
        TouchSetup {
            params,
            skin_c,
            room_c,
            hand: HandParams::TYPICAL,
            contact: if self.lifts {
                ContactRule::Free
            } else {
                ContactRule::Hold
            },
            assumed_finger,
            decision_median_s: ObserverParams::TOUCH.decision_median_s,
            decision_sigma_ln: ObserverParams::TOUCH.decision_sigma_ln,
        }
    }
}

fn material(name: &str) -> Result<&'static Material, BenchError> {
    find(name).ok_or_else(|| BenchError::Material(name.into()))
}

/// Falls on samples of sections 3.2 and 3.3.
///
/// # Errors
/// The simulated plant does not accept a value.
pub fn falls_of_chapter_3() -> Result<Falls, PredictionError> {
    let setup = Condition::of_thesis(SECTION_3).setup();
    let names = TABLE_3_3_MATERIALS.iter().chain(&["granite"]);
    let falls_k: Result<Vec<_>, BenchError> = names
        .map(|name| Ok(((*name).to_owned(), mean_fall_k(&setup, material(name)?)?)))
        .collect();
    Ok(Falls {
        skin_room_c: SECTION_3,
        falls_k: falls_k?,
    })
}

impl Falls {
    /// Fall on a material, K; zero for one that is not in the list.
    fn of(&self, name: &str) -> f64 {
        let found = self.falls_k.iter().find(|(known, _)| known == name);
        found.map_or(0.0, |(_, fall_k)| *fall_k)
    }
}

/// Cells of Table 3-3 with their labels.
fn table_3_3(falls: &Falls) -> Vec<(String, Cell)> {
    let cell = |pair: PublishedPair| {
        let cell = Cell {
            task: CellTask::Colder([falls.of(&pair.first), falls.of(&pair.second)]),
            published: pair.percent / 100.0,
            trials: ANSWERS_OF_TABLE_3_3,
        };
        (format!("{} - {}", pair.first, pair.second), cell)
    };
    discrimination().into_iter().map(cell).collect()
}

/// Cells of Table 3-5: those whose target is the colder, and those whose target is the warmer.
fn table_3_5(falls: &Falls) -> [Vec<(String, Cell)>; 2] {
    let cell = |pair: PublishedPair| {
        let cell = Cell {
            task: CellTask::Different(falls.of(&pair.first), falls.of(&pair.second)),
            published: pair.percent / 100.0,
            trials: ANSWERS_OF_TABLE_3_5,
        };
        (format!("{} among {}", pair.first, pair.second), cell)
    };
    let is_colder = |pair: &PublishedPair| falls.of(&pair.first) > falls.of(&pair.second);
    let (high_low, low_high): (Vec<_>, Vec<_>) = localisation().into_iter().partition(is_colder);
    [high_low, low_high].map(|rows| rows.into_iter().map(cell).collect())
}

fn table(
    name: &str,
    basis: Basis,
    fitted: &Fitted,
    cells: &[&[(String, Cell)]],
    checks: impl FnOnce(&TableResult, &[f64]) -> Vec<Check>,
) -> TableResult {
    let observer = fitted.observer();
    let result = |(label, cell): &(String, Cell)| CellResult {
        label: label.clone(),
        published: 100.0 * cell.published,
        predicted: 100.0 * cell.predicted(&observer),
    };
    let parts: Vec<Vec<CellResult>> = cells
        .iter()
        .map(|part| part.iter().map(result).collect())
        .collect();
    let part_means: Vec<f64> = parts
        .iter()
        .map(|part| mean(part.iter().map(|cell| cell.predicted)))
        .collect();
    let cells: Vec<CellResult> = parts.into_iter().flatten().collect();
    let mut table = TableResult {
        name: name.into(),
        basis,
        observer: format!(
            "s0 {:.2} K, w {:.3}, three fingers {:.2}, lapses {:.3}",
            fitted.s0_k, fitted.w, fitted.three_finger_factor, fitted.lapse
        ),
        rms: mean(
            cells
                .iter()
                .map(|cell| (cell.predicted - cell.published).powi(2)),
        )
        .sqrt(),
        mean_published: mean(cells.iter().map(|cell| cell.published)),
        mean_predicted: mean(cells.iter().map(|cell| cell.predicted)),
        cells,
        checks: Vec::new(),
    };
    table.checks = checks(&table, &part_means);
    table
}

fn check_table_3_3(table: &TableResult, _parts: &[f64]) -> Vec<Check> {
    let allowed = [
        "copper - bronze",
        "copper - stainless-steel",
        "bronze - stainless-steel",
        "g10 - abs",
    ];
    let below: Vec<&str> = (table.cells.iter())
        .filter(|cell| cell.predicted < THRESHOLD_PERCENT)
        .map(|cell| cell.label.as_str())
        .collect();
    vec![
        at_most("rms", table.rms, 9.0),
        within("mean", table.mean_predicted, 84.0, 93.0),
        Check {
            what: "pairs below 72 %".into(),
            value: below.join(", "),
            allowed: format!("among {}", allowed.join(", ")),
            met: below.iter().all(|pair| allowed.contains(pair)),
        },
    ]
}

fn check_table_3_5(table: &TableResult, parts: &[f64]) -> Vec<Check> {
    let [high_low, low_high] = [0, 1].map(|part| parts.get(part).copied().unwrap_or(0.0));
    vec![
        at_most("rms", table.rms, 10.0),
        within("mean", table.mean_predicted, 50.0, 60.0),
        Check {
            what: "mean with a colder target against that with a warmer one".into(),
            value: format!("{high_low:.1} and {low_high:.1} %"),
            allowed: "larger (published: 61.5 and 51.5 %)".into(),
            met: high_low > low_high,
        },
    ]
}

fn at_most(what: &str, value: f64, most: f64) -> Check {
    Check {
        what: what.into(),
        value: format!("{value:.1} %"),
        allowed: format!("at most {most} %"),
        met: value <= most,
    }
}

fn within(what: &str, value: f64, least: f64, most: f64) -> Check {
    Check {
        what: what.into(),
        value: format!("{value:.1} %"),
        allowed: format!("{least} to {most} %"),
        met: (least..=most).contains(&value),
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len();
    values.sum::<f64>() / count as f64
}

/// Mean falls of explorations on samples, and on the display in each of `modes`, K: a row for each material.
fn falls_on_samples_and_displays(
    condition: Condition,
    materials: &[&str],
    modes: &[DisplayMode],
) -> Result<Vec<Vec<f64>>, PredictionError> {
    let setup = condition.setup();
    let device = PreparedDevice::new(&setup.params, setup.room_c, DEVICE_SEED, 1)?;
    let explorations: Vec<Exploration> = (0..EXPLORATIONS)
        .map(|number| Exploration::new(&setup, number))
        .collect();
    let of_material = |name: &&str| {
        let material = material(name)?;
        let mut means_k = vec![0.0; 1 + modes.len()];
        for exploration in &explorations {
            means_k[0] += exploration.on_sample(&setup, material)?;
            for (sum_k, mode) in means_k[1..].iter_mut().zip(modes) {
                *sum_k += exploration.on_display(&setup, &device, mode.setting(), name)?;
            }
        }
        Ok(means_k
            .iter()
            .map(|sum_k| sum_k / f64::from(EXPLORATIONS))
            .collect())
    };
    materials.iter().map(of_material).collect()
}

/// Section 4.2, whose factor is fitted to both overall percentages.
fn identification(observer: &ObserverParams) -> Result<Identification, PredictionError> {
    let falls_k = falls_on_samples_and_displays(
        Condition::of_thesis(SECTION_4_2_C),
        &SECTION_4_2_MATERIALS,
        &[DisplayMode::SemiInfinitePi10Hz],
    )?;
    let of = |column: usize| -> Vec<f64> { falls_k.iter().map(|row| row[column]).collect() };
    let (real_k, simulated_k) = (of(0), of(1));
    let confusions = |factor: f64| {
        let observer = ObserverParams {
            identification_factor: factor,
            ..*observer
        };
        [&real_k, &simulated_k].map(|presented_k| -> Vec<Vec<f64>> {
            presented_k
                .iter()
                .map(|fall_k| identified(&observer, *fall_k, &real_k))
                .collect()
        })
    };
    let overall = |rows: &[Vec<f64>]| mean(rows.iter().enumerate().map(|(index, row)| row[index]));
    let log_likelihood = |factor: f64| -> f64 {
        let both = confusions(factor);
        let parts = SECTION_4_2.iter().zip(&both);
        parts
            .map(|((percent, trials), rows)| {
                let (observed, expected) = (percent / 100.0, overall(rows));
                let correct = observed * libm::log(expected);
                f64::from(*trials) * (correct + (1.0 - observed) * libm::log(1.0 - expected))
            })
            .sum()
    };
    // One parameter in a known range: every value to two decimals is tried.
    let factors = (50..=400).map(|hundredths| f64::from(hundredths) / 100.0);
    let likely = factors.map(|factor| (factor, log_likelihood(factor)));
    let (factor, _) = likely.fold((1.0, f64::NEG_INFINITY), |best, next| {
        if next.1 > best.1 { next } else { best }
    });
    let confusions = confusions(factor);
    let correct = confusions.each_ref().map(|rows| -> Vec<f64> {
        let diagonal = rows
            .iter()
            .enumerate()
            .map(|(index, row)| 100.0 * row[index]);
        diagonal.collect()
    });
    let [real, simulated] = &confusions;
    let correlation = pearson(&real.concat(), &simulated.concat())?.r;
    let overall: Vec<f64> = confusions
        .iter()
        .map(|rows| 100.0 * overall(rows))
        .collect();
    let cell = |label: &str, index: usize| CellResult {
        label: label.into(),
        published: SECTION_4_2[index].0,
        predicted: overall[index],
    };
    let best_is_foam = correct.iter().all(|rates| {
        let foam = rates.last().copied().unwrap_or(0.0);
        rates.iter().all(|rate| *rate <= foam)
    });
    let checks = vec![
        within("real materials", overall[0], 45.0, 60.0),
        within("simulated materials", overall[1], 45.0, 60.0),
        Check {
            what: "best identified".into(),
            value: if best_is_foam { "foam" } else { "another" }.into(),
            allowed: "foam".into(),
            met: best_is_foam,
        },
        Check {
            what: "correlation of the confusion matrices".into(),
            value: format!("{correlation:.2}"),
            allowed: format!("at least 0.7 (published: {SECTION_4_2_CORRELATION})"),
            met: correlation >= 0.7,
        },
    ];
    Ok(Identification {
        factor,
        materials: SECTION_4_2_MATERIALS.map(str::to_owned).to_vec(),
        overall: [cell("real", 0), cell("simulated", 1)],
        falls_k: [real_k, simulated_k],
        correct,
        confusions,
        correlation,
        checks,
    })
}

/// Section 4.3 in a condition, with both displays.
///
/// # Errors
/// The simulated device cannot present something.
pub fn real_against_simulated(
    observer: &ObserverParams,
    condition: Condition,
) -> Result<RealAgainstSimulated, PredictionError> {
    let falls_k =
        falls_on_samples_and_displays(condition, &SECTION_4_3_MATERIALS, &DisplayMode::ALL)?;
    let named = || SECTION_4_3_MATERIALS.iter().zip(&falls_k).enumerate();
    let (mut pairs, mut identical) = (Vec::new(), Vec::new());
    for (of_real, (real, real_row)) in named() {
        for (of_simulated, (simulated, simulated_row)) in named() {
            let real_colder = [1, 2]
                .map(|display| 100.0 * colder(observer, [real_row[0], simulated_row[display]]));
            if of_real == of_simulated {
                identical.push(IdenticalResult {
                    material: (*real).into(),
                    real_k: real_row[0],
                    simulated_k: [simulated_row[1], simulated_row[2]],
                    real_colder,
                });
                continue;
            }
            // Materials are listed from the coldest on.
            let is_real_colder = of_real < of_simulated;
            pairs.push(PairResult {
                real: (*real).into(),
                simulated: (*simulated).into(),
                published_below: SECTION_4_3_BELOW.contains(&(*real, *simulated)),
                correct: real_colder.map(|percent| {
                    if is_real_colder {
                        percent
                    } else {
                        100.0 - percent
                    }
                }),
            });
        }
    }
    let means = [0, 1].map(|display| mean(pairs.iter().map(|pair| pair.correct[display])));
    let differences = pairs
        .iter()
        .map(|pair| (pair.correct[1] - pair.correct[0]).abs());
    Ok(RealAgainstSimulated {
        condition,
        means,
        largest_difference: differences.fold(0.0, f64::max),
        checks: check_section_4_3(&pairs, &identical),
        pairs,
        identical,
    })
}

fn check_section_4_3(pairs: &[PairResult], identical: &[IdenticalResult]) -> Vec<Check> {
    let rank = |name: &str| {
        SECTION_4_3_MATERIALS
            .iter()
            .position(|known| *known == name)
    };
    let correct = |of: &dyn Fn(&PairResult) -> bool| -> Vec<f64> {
        let wanted = pairs.iter().filter(|pair| of(pair));
        wanted.map(|pair| pair.correct[0]).collect()
    };
    let is = |pair: &PairResult, a: &str, b: &str| {
        (pair.real == a && pair.simulated == b) || (pair.real == b && pair.simulated == a)
    };
    let real_colder = correct(&|pair| rank(&pair.real) < rank(&pair.simulated));
    let simulated_colder = correct(&|pair| rank(&pair.real) > rank(&pair.simulated));
    let (above, below) = (
        mean(real_colder.into_iter()),
        mean(simulated_colder.into_iter()),
    );
    let copper_steel = correct(&|pair| is(pair, "copper", "stainless-steel"));
    let with_abs = correct(&|pair| is(pair, "copper", "abs") || is(pair, "stainless-steel", "abs"));
    let of_identical = |name: &str| {
        let found = identical.iter().find(|row| row.material == name);
        found.map_or(0.0, |row| row.real_colder[0])
    };
    let published: Vec<String> = (pairs.iter())
        .filter(|pair| pair.published_below != (pair.correct[0] < THRESHOLD_PERCENT))
        .map(|pair| format!("{} / {}", pair.real, pair.simulated))
        .collect();
    vec![
        Check {
            what: "mean with the real one colder against the simulated one colder".into(),
            value: format!("{above:.1} and {below:.1} %"),
            allowed: "5 % apart at most".into(),
            met: (above - below).abs() <= 5.0,
        },
        Check {
            what: "copper with stainless steel".into(),
            value: percentages(&copper_steel),
            allowed: "below 72 %".into(),
            met: copper_steel
                .iter()
                .all(|percent| *percent < THRESHOLD_PERCENT),
        },
        Check {
            what: "ABS with copper and stainless steel".into(),
            value: percentages(&with_abs),
            allowed: "above 72 %".into(),
            met: with_abs.iter().all(|percent| *percent > THRESHOLD_PERCENT),
        },
        within(
            "identical copper, real said to be colder",
            of_identical("copper"),
            40.0,
            60.0,
        ),
        within(
            "identical stainless steel",
            of_identical("stainless-steel"),
            40.0,
            60.0,
        ),
        Check {
            what: "identical granite".into(),
            value: format!("{:.1} %", of_identical("granite")),
            allowed: "above 50 %".into(),
            met: of_identical("granite") > 50.0,
        },
        Check {
            what: "identical ABS (published: real felt colder)".into(),
            value: format!("{:.1} %", of_identical("abs")),
            allowed: "above 50 %".into(),
            met: of_identical("abs") > 50.0,
        },
        Check {
            what: "pairs on the other side of 72 % than published".into(),
            value: published.join(", "),
            allowed: "none".into(),
            met: published.is_empty(),
        },
    ]
}

fn percentages(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|value| format!("{value:.1} %")).collect();
    texts.join(", ")
}

/// What errors of 20, 50 and 200 mK at the receptors are worth.
fn worth(touch: &ObserverParams, falls: &Falls) -> Vec<Worth> {
    /// Standard normal deviate of 75 %.
    const Z_75: f64 = 0.674_489_750_196_082;
    let of = |name: &str, observer: &ObserverParams, fall_k: f64| Worth {
        observer: name.into(),
        fall_k,
        correct: [20.0, 50.0, 100.0, 200.0]
            .map(|mk| (mk, 100.0 * colder(observer, [fall_k + 1e-3 * mk, fall_k])))
            .to_vec(),
        threshold_75_k: Z_75 * std::f64::consts::SQRT_2 * observer.sigma_k(fall_k),
    };
    let mut rows: Vec<Worth> = ["foam", "abs", "granite", "copper"]
        .iter()
        .map(|name| of(&format!("touch of {name}"), touch, falls.of(name)))
        .collect();
    rows.push(of(
        "thermode, fingertip",
        &ObserverParams::THERMODE_FINGERTIP,
        0.0,
    ));
    rows.push(of(
        "thermode, thenar",
        &ObserverParams::THERMODE_THENAR,
        0.0,
    ));
    rows
}

/// All predictions.
///
/// # Errors
/// The simulated bench or the fit has failed.
pub fn report() -> Result<Report, PredictionError> {
    let falls = falls_of_chapter_3()?;
    let two_hands = table_3_3(&falls);
    let [high_low, low_high] = table_3_5(&falls);
    let cells = |parts: &[&[(String, Cell)]]| -> Vec<Cell> {
        parts
            .iter()
            .flat_map(|part| part.iter().map(|(_, cell)| *cell))
            .collect()
    };
    let find = |cells: &[Cell], fits_factor: bool| {
        fit(cells, fits_factor).map_err(|error| PredictionError::Fit(error.to_string()))
    };
    let fitted = find(&cells(&[&two_hands, &high_low, &low_high]), true)?;
    let without_table_3_5 = find(&cells(&[&two_hands]), false)?;
    let without_table_3_3 = find(&cells(&[&high_low, &low_high]), false)?;
    let three_fingers: [&[(String, Cell)]; 2] = [&high_low, &low_high];
    let (name_3_3, name_3_5) = ("Table 3-3", "Table 3-5");
    let tables = vec![
        table(
            name_3_3,
            Basis::Fitted,
            &fitted,
            &[&two_hands],
            check_table_3_3,
        ),
        table(
            name_3_5,
            Basis::Fitted,
            &fitted,
            &three_fingers,
            check_table_3_5,
        ),
        table(
            name_3_3,
            Basis::Predicted,
            &without_table_3_3,
            &[&two_hands],
            check_table_3_3,
        ),
        table(
            name_3_5,
            Basis::Predicted,
            &without_table_3_5,
            &three_fingers,
            check_table_3_5,
        ),
    ];
    let observer = fitted.observer();
    let at_gate = Condition::of_thesis(SECTION_4_3_C);
    let conditions = [
        at_gate,
        Condition::of_thesis(SECTION_4_3_REPORTED_C),
        Condition {
            lifts: false,
            ..at_gate
        },
        Condition {
            is_layered: true,
            ..at_gate
        },
    ];
    let conditions = conditions.map(|condition| real_against_simulated(&observer, condition));
    let conditions = conditions.into_iter();
    Ok(Report {
        tables,
        identification: identification(&observer)?,
        real_against_simulated: conditions.collect::<Result<_, _>>()?,
        worth: worth(&observer, &falls),
        falls,
        fitted,
        without_table_3_5,
        without_table_3_3,
    })
}

#[cfg(test)]
mod tests;
