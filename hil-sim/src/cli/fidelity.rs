//! `hil-sim fidelity`: skin temperature on the display compared with that on the real material.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde::Serialize;
use thermal_campaigns::fidelity::{
    self, BoundResult, BoxReport, DrawResult, FidelityCase, FidelityRow, ImageSample, PlantDraw,
    Population, PopulationCase, PopulationReport, PopulationResult, Priors, RemovedLimit, Scenario,
    Way,
};
use thermal_campaigns::parallel_map;
use thermal_device::control::Law;
use thermal_sim::{NativeRunner, SceneRunner};

use super::engine::{self, EngineKind};
use super::{Failure, output};
use thermal_device::Vocabulary as _;

#[derive(Args)]
pub struct Arguments {
    /// What the finger does; several, or all [default: A, or none with --box]
    #[arg(long, num_args = 1.., value_parser = scenarios())]
    scenario: Vec<Chosen>,
    /// Fingers, or contact laws, that are drawn in scenarios F to I
    #[arg(long, value_name = "N", default_value_t = 36)]
    draws: u64,
    /// Run so many cases of each of E to I only, evenly spread
    #[arg(long, value_name = "N")]
    sample: Option<usize>,
    /// Compare what is learnt in scenario G with the bound of Cramér and Rao
    #[arg(long)]
    bound: bool,
    /// Run so many cases of each of E to I on the image, too; its traces must be the same
    #[cfg(feature = "emulator")]
    #[arg(long, value_name = "N", default_value_t = 0)]
    image_sample: usize,
    /// Laws to compare in A to D and the box [default: all]
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
    boxed: Option<u64>,
    /// Run the draw of this number again; with --out its scenes are written, law by law
    #[arg(long, value_name = "DRAW", conflicts_with = "boxed")]
    replay: Option<u64>,
    /// Of the converter, and of the box
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: u64,
    /// What runs the device's logic [default: image for A to D, native for E to I and the box]
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
    /// Folder for fidelity.html, its pictures, fidelity.csv, box.csv, populations.csv and scenes
    #[arg(long)]
    out: Option<PathBuf>,
}

/// What `--scenario` chooses.
#[derive(Clone, Copy, PartialEq)]
enum Chosen {
    /// A scenario by its cases.
    Cases(Scenario),
    /// A scenario by its populations.
    Populations(&'static str),
    All,
}

impl Chosen {
    /// All scenarios.
    const EACH: [Self; 10] = [
        Self::Cases(Scenario::A),
        Self::Cases(Scenario::B),
        Self::Cases(Scenario::C),
        Self::Cases(Scenario::D),
        Self::Cases(Scenario::Unseen),
        Self::Populations("E"),
        Self::Populations("F"),
        Self::Populations("G"),
        Self::Populations("H"),
        Self::Populations("I"),
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Cases(scenario) => scenario.name(),
            Self::Populations(name) => name,
            Self::All => "all",
        }
    }

    fn scenario(self) -> Option<Scenario> {
        match self {
            Self::Cases(scenario) => Some(scenario),
            _ => None,
        }
    }
}

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
    let names = Chosen::EACH.map(Chosen::name).into_iter().chain(["all"]);
    PossibleValuesParser::new(names).map(|word| {
        let each = Chosen::EACH.into_iter().find(|one| one.name() == word);
        each.unwrap_or(Chosen::All)
    })
}

fn removals() -> impl TypedValueParser<Value = Removed> {
    choice(&RemovedLimit::ALL, RemovedLimit::name)
}

fn laws() -> impl TypedValueParser<Value = Law> {
    PossibleValuesParser::new(Law::WORDS.words).map(|word| Law::of_word(&word).unwrap_or_default())
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
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    populations: &'a [PopulationReport],
}

/// Runs, prints, writes.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let laws = match arguments.law.as_slice() {
        [] => Law::ALL.to_vec(),
        chosen => chosen.to_vec(),
    };
    let (cases, populations) = cases(arguments)?;
    output::create(arguments.out.as_deref())?;
    let usual = if cases.is_empty() { EngineKind::Native } else { EngineKind::DEFAULT };
    let kind = arguments.engine.unwrap_or(usual);
    let image = image(arguments)?;
    // An image that repeats a sample has the file.
    let elf = arguments.elf.as_deref().filter(|_| image.is_none());
    let campaign = Campaign { arguments, device: engine::runner(kind, elf)?, laws };
    let rows = campaign.rows(&cases).map_err(Failure::run)?;
    let drawn = campaign.draws().map_err(Failure::run)?;
    let boxed = (!drawn.is_empty()).then(|| BoxReport {
        engine: campaign.device_of_draws().name(),
        draws: drawn.len() as u64 / campaign.laws.len().max(1) as u64,
        seed: arguments.seed,
        laws: fidelity::statistics_by_law(&drawn),
    });
    let results = campaign.populations(&populations).map_err(Failure::run)?;
    let bounds = campaign.bounds(&populations).map_err(Failure::run)?;
    let reports = campaign
        .population_reports(&populations, (&results, &bounds), image.as_deref())
        .map_err(Failure::run)?;
    if let Some(folder) = &arguments.out {
        let charts = write_populations(folder, &populations, &results, &reports);
        charts
            .and_then(|chart| {
                let reports = (boxed.as_ref(), reports.as_slice());
                campaign.write(folder, &rows, &drawn, reports, chart)
            })
            .map_err(Failure::run)?;
    }
    let report = Report {
        seed: arguments.seed,
        laws: campaign.laws.iter().map(|law| law.name()).collect(),
        rows: &rows,
        boxed: boxed.as_ref(),
        populations: &reports,
    };
    let table = || {
        fidelity::table(&rows, arguments.all)
            + &boxed.as_ref().map_or(String::new(), fidelity::box_table)
            + &fidelity::population_table(&reports)
    };
    let page = arguments.out.as_ref();
    output::print_report(
        arguments.json,
        &report,
        table,
        page.map(|folder| folder.join(fidelity::HTML)),
    )
}

/// The image that repeats a sample, if one is to.
#[cfg(feature = "emulator")]
fn image(arguments: &Arguments) -> Result<Option<Box<dyn SceneRunner>>, Failure> {
    let wanted = arguments.image_sample > 0;
    let image = wanted.then(|| engine::runner(EngineKind::Image, arguments.elf.as_deref()));
    image.transpose()
}

/// This build has no emulator.
#[cfg(not(feature = "emulator"))]
fn image(_arguments: &Arguments) -> Result<Option<Box<dyn SceneRunner>>, Failure> {
    Ok(None)
}

/// The chosen cases of A to D and of the populations.
fn cases(arguments: &Arguments) -> Result<(Vec<FidelityCase>, Vec<PopulationCase>), Failure> {
    let boxed = arguments.boxed.is_some() || arguments.replay.is_some();
    let chosen: &[Chosen] = match arguments.scenario.as_slice() {
        [] if boxed => &[],
        [] => &[Chosen::Cases(Scenario::A)],
        chosen if chosen.contains(&Chosen::All) => &Chosen::EACH,
        chosen => chosen,
    };
    let mut cases: Vec<_> =
        (chosen.iter()).filter_map(|chosen| chosen.scenario()).flat_map(Scenario::cases).collect();
    let mut populations = Vec::new();
    for population in Population::ALL {
        if chosen.contains(&Chosen::Populations(population.scenario())) {
            let cases = population.cases(arguments.seed, arguments.draws);
            let cases = cases.map_err(Failure::run)?;
            let sample = arguments.sample.unwrap_or(cases.len());
            populations.extend(fidelity::spread(&cases, sample));
        }
    }
    let all = || {
        let populations = populations.iter();
        let populations =
            populations.map(|case| (case.object.name.as_str(), PopulationCase::FORCE_N));
        (cases.iter().map(|case| (case.name.as_str(), case.force_n))).chain(populations)
    };
    for name in &arguments.material {
        if all().next().is_some() && !all().any(|(known, _)| known == *name) {
            let mut known: Vec<_> = all().map(|(name, _)| name).collect();
            known.dedup();
            let problem = anyhow!("--material {name:?}; known are {}", known.join("; "));
            return Err(Failure::input(problem));
        }
    }
    for force_n in &arguments.force {
        if all().next().is_some() && !all().any(|(_, known)| known == *force_n) {
            let mut known: Vec<_> = all().map(|(_, force_n)| force_n).collect();
            known.sort_by(f64::total_cmp);
            known.dedup();
            let problem = anyhow!("--force {force_n}; known are {known:?}");
            return Err(Failure::input(problem));
        }
    }
    let wanted = |name: &String, force_n: f64| {
        (arguments.material.is_empty() || arguments.material.contains(name))
            && (arguments.force.is_empty() || arguments.force.contains(&force_n))
    };
    cases.retain(|case| wanted(&case.name, case.force_n));
    populations.retain(|case| wanted(&case.object.name, PopulationCase::FORCE_N));
    Ok((cases, populations))
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
        let plants: Vec<_> = std::iter::once(None).chain(bounds.into_iter().map(Some)).collect();
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
        let numbers = match (self.arguments.replay, self.arguments.boxed) {
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

    /// Runs every case of the populations in every way.
    fn populations(&self, cases: &[PopulationCase]) -> anyhow::Result<Vec<PopulationResult>> {
        let mut jobs = Vec::new();
        for case in cases {
            jobs.extend(case.population.ways().iter().map(|way| (case, *way)));
        }
        let device = self.device_of_draws();
        self.map("populations", &jobs, |(case, way)| {
            case.run(device, *way).with_context(|| context(case, *way))
        })
    }

    /// Compares what is learnt in each case of scenario G with its bound, if that is wanted.
    fn bounds(&self, cases: &[PopulationCase]) -> anyhow::Result<Vec<BoundResult>> {
        let mut results = Vec::new();
        for population in Population::ALL {
            let own = cases.iter().filter(|case| case.population == population);
            let own: Vec<_> = own.collect();
            if self.arguments.bound && population.scenario() == "G" && !own.is_empty() {
                let priors = Priors::of(population, self.arguments.seed)?;
                results.extend(self.map("bound", &own, |case| {
                    let result = BoundResult::run(case, &priors);
                    result.with_context(|| context(case, Way::AsItIs))
                })?);
            }
        }
        Ok(results)
    }

    /// Statistics of the populations; a sample of each is run on the image.
    fn population_reports(
        &self,
        cases: &[PopulationCase],
        (results, bounds): (&[PopulationResult], &[BoundResult]),
        image: Option<&dyn SceneRunner>,
    ) -> anyhow::Result<Vec<PopulationReport>> {
        let device = self.device_of_draws();
        let mut reports = Vec::new();
        for population in Population::ALL {
            let mut sample = None;
            if let Some(image) = image {
                let own = cases.iter().filter(|case| case.population == population);
                let own: Vec<_> = own.collect();
                let jobs = fidelity::spread(&own, self.image_sample());
                self.map("image", &jobs, |case| {
                    let same = case.check_same(device, image, Way::AsItIs);
                    same.with_context(|| context(case, Way::AsItIs))
                })?;
                let identical = jobs.len();
                sample = Some(ImageSample { identical });
            }
            let engine = device.name();
            let report = PopulationReport::new(population, results, engine, sample);
            reports.extend(report.map(|report| PopulationReport {
                bound: fidelity::bound_rows(population, bounds),
                ..report
            }));
        }
        Ok(reports)
    }

    #[cfg(feature = "emulator")]
    fn image_sample(&self) -> usize {
        self.arguments.image_sample
    }

    #[cfg(not(feature = "emulator"))]
    fn image_sample(&self) -> usize {
        0
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
        (boxed, populations): (Option<&BoxReport>, &[PopulationReport]),
        chart: Option<String>,
    ) -> anyhow::Result<()> {
        let svg = fidelity::plot(rows)?;
        let charts: Vec<_> = svg.iter().chain(&chart).map(String::as_str).collect();
        let page = fidelity::page(rows, boxed, populations, &charts);
        output::write(folder, fidelity::HTML, page)?;
        if let Some(svg) = &svg {
            output::write(folder, fidelity::SVG, svg)?;
            output::write(folder, "fidelity.csv", fidelity::rows_csv(rows)?)?;
        }
        if !drawn.is_empty() {
            output::write(folder, "box.csv", fidelity::box_csv(drawn)?)?;
        }
        if let Some(number) = self.arguments.replay {
            let PlantDraw { case, seed, plant, .. } = PlantDraw::new(self.arguments.seed, number);
            for law in &self.laws {
                let text = case.text(*law, seed, &plant);
                let name = format!("draw-{number}-{}.toml", law.name());
                output::write(folder, &name, text)?;
            }
        }
        Ok(())
    }
}

fn context(case: &PopulationCase, way: Way) -> String {
    format!("{} {}, {}", case.population.name(), case.name, way.name())
}

/// Writes the populations' chart, which is returned, their CSV, and the scenes of the worst cases.
fn write_populations(
    folder: &Path,
    cases: &[PopulationCase],
    results: &[PopulationResult],
    reports: &[PopulationReport],
) -> anyhow::Result<Option<String>> {
    let chart = fidelity::population_chart(results)?;
    let Some(svg) = &chart else { return Ok(None) };
    output::write(folder, fidelity::POPULATIONS_SVG, svg)?;
    output::write(folder, "populations.csv", fidelity::populations_csv(results)?)?;
    for report in reports {
        let told = report.ways.iter().filter(|way| way.way == Way::AsItIs);
        for (rank, worst) in (1..).zip(told.flat_map(|way| &way.worst)) {
            let same = |case: &&PopulationCase| {
                (case.population, &case.name) == (worst.population, &worst.case)
            };
            if let Some(case) = cases.iter().find(same) {
                let name = format!("{}-worst-{rank}.toml", report.population.name());
                output::write(folder, &name, case.text(Way::AsItIs))?;
            }
        }
    }
    Ok(chart)
}
