//! Statistics of a population.

use std::fmt::Write;

use serde::Serialize;

use super::{Aim, BoundRow, Population, Since, Way, bound};
use crate::fidelity::Percentiles;
use crate::percentile;

/// Result of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PopulationResult {
    /// The population.
    pub population: Population,
    /// Name of the case.
    pub case: String,
    /// What the device was told.
    pub way: Way,
    /// Largest skin error from 50 ms on, mK.
    pub max_after_50ms_mk: f64,
    /// The same from half a second on.
    pub max_after_500ms_mk: f64,
    /// Its root mean square over the contact, mK.
    pub rms_mk: f64,
    /// Whether the device knew the person.
    pub is_enrolled: bool,
    /// Faults that the device reported.
    pub faults: Vec<String>,
}

impl PopulationResult {
    /// Largest skin error from a time on, mK.
    pub const fn largest_mk(&self, since: Since) -> f64 {
        match since {
            Since::Ms50 => self.max_after_50ms_mk,
            Since::Ms500 => self.max_after_500ms_mk,
        }
    }
}

/// Statistics of a population for what the device was told.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WayStatistics {
    /// What the device was told.
    pub way: Way,
    /// Largest skin error from 50 ms on, mK.
    pub max_after_50ms_mk: Percentiles,
    /// The same from half a second on.
    pub max_after_500ms_mk: Percentiles,
    /// Its root mean square, mK.
    pub rms_mk: Percentiles,
    /// Runs in which the device reported a fault.
    pub faulty: usize,
    /// Runs in which the device knew the person.
    pub enrolled: usize,
    /// The worst runs, worst first.
    pub worst: Vec<PopulationResult>,
}

/// Runs of a population that the image has repeated with the same traces.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImageSample {
    /// Number of runs.
    pub identical: usize,
}

/// A percentile of the largest skin error, compared with its aim.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AimedPercentile {
    /// From when on.
    pub since: Since,
    /// Percentile, %.
    pub percent: f64,
    /// Aim, mK.
    pub aim_mk: f64,
    /// Value for the object as it is, mK.
    pub value_mk: f64,
}

/// Statistics of a population.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PopulationReport {
    /// The population.
    pub population: Population,
    /// Name of the engine.
    pub engine: &'static str,
    /// Number of cases.
    pub cases: usize,
    /// The aims; none of drawn contact laws.
    pub aims: Vec<AimedPercentile>,
    /// What the image has repeated, if it has.
    pub image: Option<ImageSample>,
    /// Statistics by what the device was told.
    pub ways: Vec<WayStatistics>,
    /// What was learnt against the bound of Cramér and Rao, if that was computed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bound: Vec<BoundRow>,
}

/// Number of worst runs that are listed.
const WORST: usize = 5;

impl PopulationReport {
    /// Statistics of a population's results, of each way that was run; `None` if there are none of the object as it is.
    pub fn new(
        population: Population,
        results: &[PopulationResult],
        engine: &'static str,
        image: Option<ImageSample>,
    ) -> Option<Self> {
        let of = |way| -> Vec<&PopulationResult> {
            (results.iter()).filter(|one| (one.population, one.way) == (population, way)).collect()
        };
        let told = of(Way::AsItIs);
        let errors = |since| -> Vec<_> { told.iter().map(|one| one.largest_mk(since)).collect() };
        percentile(&errors(Since::Ms50), 50.0)?;
        let ways = (population.ways().iter()).map(|way| statistics(*way, of(*way)));
        Some(Self {
            population,
            engine,
            cases: told.len(),
            aims: (population.aims().iter())
                .map(|&Aim { since, percent, aim_mk }| {
                    let value_mk = percentile(&errors(since), percent)?;
                    Some(AimedPercentile { since, percent, aim_mk, value_mk })
                })
                .collect::<Option<_>>()?,
            image,
            ways: ways.flatten().collect(),
            bound: Vec::new(),
        })
    }
}

fn statistics(way: Way, mut own: Vec<&PopulationResult>) -> Option<WayStatistics> {
    own.sort_by(|a, b| b.max_after_50ms_mk.total_cmp(&a.max_after_50ms_mk));
    let column = |value: fn(&PopulationResult) -> f64| -> Option<Percentiles> {
        Percentiles::of(&own.iter().map(|one| value(one)).collect::<Vec<_>>())
    };
    Some(WayStatistics {
        way,
        max_after_50ms_mk: column(|one| one.max_after_50ms_mk)?,
        max_after_500ms_mk: column(|one| one.max_after_500ms_mk)?,
        rms_mk: column(|one| one.rms_mk)?,
        faulty: own.iter().filter(|one| !one.faults.is_empty()).count(),
        enrolled: own.iter().filter(|one| one.is_enrolled).count(),
        worst: own.into_iter().take(WORST).cloned().collect(),
    })
}

/// The statistics as text.
pub fn table(reports: &[PopulationReport]) -> String {
    let mut text = String::new();
    for report in reports {
        let PopulationReport { population, engine, cases, aims, image, ways, bound } = report;
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "\n{}: {}\n{cases} cases, engine {engine}",
            population.name(),
            population.title()
        );
        if let Some(ImageSample { identical }) = image {
            let _ = write!(text, "; {identical} runs repeated by the image, traces identical");
        }
        let _ = writeln!(
            text,
            "\nmK, skin error{:6}largest after 50 ms, 50/95/99 %, max   after 0.5 s, 50/95 %   rms, 50/95 %    faulty",
            ""
        );
        for way in ways {
            let (max, late, rms) = (way.max_after_50ms_mk, way.max_after_500ms_mk, way.rms_mk);
            let _ = writeln!(
                text,
                "{:20}{:>8.1}{:>8.1}{:>8.1}{:>10.1}      {:>8.1}{:>8.1}      {:>8.1}{:>8.1}{:>8}",
                way.way.name(),
                max.p50,
                max.p95,
                max.p99,
                max.max,
                late.p50,
                late.p95,
                rms.p50,
                rms.p95,
                way.faulty
            );
        }
        if population.is_of_enrolled() {
            let enrolled: usize = ways.iter().map(|way| way.enrolled).sum();
            let _ = writeln!(
                text,
                "finger enrolled in {enrolled} of {cases} cases; the device did not trust the others"
            );
        }
        for aim in aims {
            let _ = writeln!(
                text,
                "after {} s, {} %: {:.1} mK, aim {} mK: {}",
                aim.since.since_s(),
                aim.percent,
                aim.value_mk,
                aim.aim_mk,
                if aim.value_mk <= aim.aim_mk { "ok" } else { "over" }
            );
        }
        for one in ways.iter().flat_map(|way| &way.worst) {
            let _ = writeln!(
                text,
                "{:12} {:>8.1} mK, {} {}",
                one.way.name(),
                one.max_after_50ms_mk,
                one.case,
                one.faults.join(", ")
            );
        }
        text += &bound::table(bound);
    }
    text
}
