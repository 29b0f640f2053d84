//! `hil-sim fidelity`: skin temperature on the display compared with that on the real material.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde::Serialize;
use thermal_campaigns::fidelity::{
    self, BoxReport, DrawResult, FidelityCase, FidelityRow, PlantDraw, RemovedLimit, Scenario,
};
use thermal_campaigns::parallel_map;
use thermal_device::control::Law;
use thermal_sim::{NativeRunner, SceneRunner};

use super::engine::{self, EngineKind};
use super::{Failure, output};

#[derive(Args)]
pub struct Arguments {
    /// What the finger does; several, or all [default: A, or none with --box]
    #[arg(long, num_args = 1.., value_parser = scenarios())]
    scenario: Vec<Chosen>,
    /// Laws to compare [default: all]
    #[arg(long, num_args = 1.., value_parser = laws())]
    law: Vec<Law>,
    /// Cases of these names only, as the table has them
    #[arg(long, num_args = 1..)]
    material: Vec<String>,
    /// Cases with these forces only, N
    #[arg(long, num_args = 1..)]
    force: Vec<f64>,
    /// Bounds that are removed in the plant, one after the other, each beside the plant as it is; or all
    #[arg(long, num_args = 1.., value_parser = removals())]
    without: Vec<Removed>,
    /// Draw so many plants from the box
    #[arg(long = "box", value_name = "N", num_args = 0..=1, default_missing_value = "100")]
    draws: Option<u64>,
    /// Run the draw of this number again; with --out its scenes are written, law by law
    #[arg(long, value_name = "DRAW", conflicts_with = "draws")]
    replay: Option<u64>,
    /// Of the converter, and of the box
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: u64,
    /// What runs the device's logic [default: image for scenarios, native for the box]
    #[arg(long, value_enum)]
    engine: Option<EngineKind>,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Threads [default: one a core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Print every force, not only the worst
    #[arg(long)]
    all: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Folder for fidelity.html, fidelity.svg, fidelity.csv, box.csv and scenes
    #[arg(long)]
    out: Option<PathBuf>,
}

/// A chosen scenario, or `None` for `all`.
type Chosen = Option<Scenario>;
type Removed = Option<RemovedLimit>;

fn choice<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = Option<T>> {
    let names: Vec<_> = all.iter().map(|one| name(*one)).chain(["all"]).collect();
    PossibleValuesParser::new(names)
        .map(move |word| all.iter().copied().find(|one| name(*one) == word))
}

fn scenarios() -> impl TypedValueParser<Value = Chosen> {
    choice(&Scenario::ALL, Scenario::name)
}

fn removals() -> impl TypedValueParser<Value = Removed> {
    choice(&RemovedLimit::ALL, RemovedLimit::name)
}

fn laws() -> impl TypedValueParser<Value = Law> {
    PossibleValuesParser::new(Law::PROTOCOL_WORDS.map(|(word, _)| word)).map(|word| {
        let known = Law::PROTOCOL_WORDS.iter().find(|(known, _)| *known == word);
        known.map_or(Law::default(), |(_, law)| *law)
    })
}

/// The chosen values, or all if `all` is among them.
fn expand<T: Copy>(chosen: &[Option<T>], all: &[T]) -> Vec<T> {
    if chosen.iter().any(Option::is_none) {
        return all.to_vec();
    }
    chosen.iter().copied().flatten().collect()
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    seed: u64,
    laws: Vec<&'static str>,
    rows: &'a [FidelityRow],
    #[serde(rename = "box")]
    boxed: Option<&'a BoxReport>,
}

/// Runs, prints, writes.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let laws = match arguments.law.as_slice() {
        [] => Law::PROTOCOL_WORDS.map(|(_, law)| law).to_vec(),
        chosen => chosen.to_vec(),
    };
    let cases = cases(arguments)?;
    output::create(arguments.out.as_deref())?;
    let usual = if cases.is_empty() {
        EngineKind::Native
    } else {
        EngineKind::DEFAULT
    };
    let kind = arguments.engine.unwrap_or(usual);
    let campaign = Campaign {
        arguments,
        device: engine::runner(kind, arguments.elf.as_deref())?,
        laws,
    };
    let rows = campaign.rows(&cases).map_err(Failure::run)?;
    let drawn = campaign.draws().map_err(Failure::run)?;
    let boxed = (!drawn.is_empty()).then(|| BoxReport {
        engine: campaign.device_of_draws().name(),
        draws: drawn.len() as u64 / campaign.laws.len().max(1) as u64,
        seed: arguments.seed,
        laws: fidelity::statistics_by_law(&drawn),
    });
    if let Some(folder) = &arguments.out {
        campaign
            .write(folder, &rows, &drawn, boxed.as_ref())
            .map_err(Failure::run)?;
    }
    let report = Report {
        seed: arguments.seed,
        laws: campaign.laws.iter().map(|law| law.name()).collect(),
        rows: &rows,
        boxed: boxed.as_ref(),
    };
    let table = || {
        fidelity::table(&rows, arguments.all)
            + &boxed.as_ref().map_or(String::new(), fidelity::box_table)
    };
    let page = arguments.out.as_ref();
    output::print_report(
        arguments.json,
        &report,
        table,
        page.map(|folder| folder.join(fidelity::HTML)),
    )
}

/// The chosen cases.
fn cases(arguments: &Arguments) -> Result<Vec<FidelityCase>, Failure> {
    let boxed = arguments.draws.is_some() || arguments.replay.is_some();
    let scenarios = match arguments.scenario.as_slice() {
        [] if boxed => Vec::new(),
        [] => vec![Scenario::A],
        chosen => expand(chosen, &Scenario::ALL),
    };
    let mut cases: Vec<_> = scenarios
        .iter()
        .flat_map(|scenario| scenario.cases())
        .collect();
    for name in &arguments.material {
        if !cases.is_empty() && !cases.iter().any(|case| case.name == *name) {
            let mut known: Vec<_> = cases.iter().map(|case| case.name.as_str()).collect();
            known.dedup();
            let problem = anyhow!("--material {name:?}; known are {}", known.join("; "));
            return Err(Failure::input(problem));
        }
    }
    for force_n in &arguments.force {
        if !cases.is_empty() && !cases.iter().any(|case| case.force_n == *force_n) {
            let mut known: Vec<_> = cases.iter().map(|case| case.force_n).collect();
            known.sort_by(f64::total_cmp);
            known.dedup();
            let problem = anyhow!("--force {force_n}; known are {known:?}");
            return Err(Failure::input(problem));
        }
    }
    cases.retain(|case| {
        (arguments.material.is_empty() || arguments.material.contains(&case.name))
            && (arguments.force.is_empty() || arguments.force.contains(&case.force_n))
    });
    Ok(cases)
}

struct Campaign<'a> {
    arguments: &'a Arguments,
    /// Runs the scenarios.
    device: Box<dyn SceneRunner>,
    laws: Vec<Law>,
}

impl Campaign<'_> {
    /// Runs the draws: the native engine unless the command line names one.
    fn device_of_draws(&self) -> &dyn SceneRunner {
        match self.arguments.engine {
            Some(_) => self.device.as_ref(),
            None => &NativeRunner,
        }
    }

    /// Runs every case with every law, with and without the limits to be removed.
    fn rows(&self, cases: &[FidelityCase]) -> anyhow::Result<Vec<FidelityRow>> {
        let bounds = expand(&self.arguments.without, &RemovedLimit::ALL);
        let plants: Vec<_> = std::iter::once(None)
            .chain(bounds.into_iter().map(Some))
            .collect();
        let mut jobs = Vec::new();
        for case in cases {
            for law in &self.laws {
                jobs.extend(plants.iter().map(|without| (case, *law, *without)));
            }
        }
        let device = self.device.as_ref();
        self.map("scenarios", &jobs, |(case, law, without)| {
            FidelityRow::run(device, case, *law, *without, self.arguments.seed).with_context(|| {
                format!("{} {} {} N", case.scenario.name(), case.name, case.force_n)
            })
        })
    }

    /// Runs the draws, or the one to replay, with every law.
    fn draws(&self) -> anyhow::Result<Vec<DrawResult>> {
        let numbers = match (self.arguments.replay, self.arguments.draws) {
            (Some(number), _) => number..number.saturating_add(1),
            (None, draws) => 0..draws.unwrap_or(0),
        };
        let mut jobs = Vec::new();
        for number in numbers {
            jobs.extend(self.laws.iter().map(|law| (number, *law)));
        }
        let device = self.device_of_draws();
        self.map("box", &jobs, |(number, law)| {
            PlantDraw::new(self.arguments.seed, *number)
                .run(device, *law)
                .with_context(|| format!("draw {number} of seed {}", self.arguments.seed))
        })
    }

    fn map<T: Sync, R: Send>(
        &self,
        name: &'static str,
        jobs: &[T],
        work: impl Fn(&T) -> anyhow::Result<R> + Sync,
    ) -> anyhow::Result<Vec<R>> {
        let bar = output::run_counter(name.into(), jobs.len())?;
        let threads = output::threads(self.arguments.threads);
        let results = parallel_map(jobs, threads, work, || bar.inc(1));
        bar.finish_and_clear();
        results
    }

    fn write(
        &self,
        folder: &Path,
        rows: &[FidelityRow],
        drawn: &[DrawResult],
        boxed: Option<&BoxReport>,
    ) -> anyhow::Result<()> {
        let svg = fidelity::plot(rows)?;
        let page = fidelity::page(rows, boxed, svg.as_deref());
        output::write(folder, fidelity::HTML, page)?;
        if let Some(svg) = &svg {
            output::write(folder, fidelity::SVG, svg)?;
            output::write(folder, "fidelity.csv", fidelity::rows_csv(rows)?)?;
        }
        if !drawn.is_empty() {
            output::write(folder, "box.csv", fidelity::box_csv(drawn)?)?;
        }
        if let Some(number) = self.arguments.replay {
            let PlantDraw {
                case, seed, plant, ..
            } = PlantDraw::new(self.arguments.seed, number);
            for law in &self.laws {
                let text = case.text(*law, seed, &plant);
                let name = format!("draw-{number}-{}.toml", law.name());
                output::write(folder, &name, text)?;
            }
        }
        Ok(())
    }
}
