//! `hil-sim tracking`: how closely the display follows temperatures that the host prescribes.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use thermal_campaigns::fidelity::{Percentiles, PlantDraw};
use thermal_campaigns::parallel_map;
use thermal_campaigns::tracking::{
    self, LimitCase, SENSOR_LAGS_S, Stimulus, TouchingFinger, TrackingBox, TrackingCase,
    TrackingReport,
};
use thermal_sim::SceneRunner;

use super::engine::{self, EngineKind};
use super::{Failure, output};

#[derive(Args)]
pub struct Arguments {
    /// Devices that are drawn from the parameter box
    #[arg(long, value_name = "N", default_value_t = 0)]
    devices: u64,
    /// Of the draws
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: u64,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = EngineKind::Native)]
    engine: EngineKind,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Threads [default: one a core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Folder for tracking.svg and tracking.md
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Runs the campaign; prints its tables.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    output::create(arguments.out.as_deref())?;
    let device = engine::runner(arguments.engine, arguments.elf.as_deref())?;
    let report = measure(arguments, device.as_ref()).map_err(Failure::run)?;
    if let Some(folder) = &arguments.out {
        let svg = tracking::chart(&report).map_err(Failure::run)?;
        output::write(folder, "tracking.svg", svg).map_err(Failure::run)?;
        output::write(folder, "tracking.md", report.tables()).map_err(Failure::run)?;
    }
    output::print_report(arguments.json, &report, || report.tables(), None)
}

fn measure(arguments: &Arguments, device: &dyn SceneRunner) -> anyhow::Result<TrackingReport> {
    let threads = output::threads(arguments.threads);
    let stimuli = Stimulus::all();
    let mut cases = Vec::new();
    for stimulus in &stimuli {
        for touch in TouchingFinger::ALL {
            cases.extend(SENSOR_LAGS_S.map(|lag_s| TrackingCase::nominal(stimulus, touch, lag_s)));
        }
    }
    let bar = output::run_counter("stimuli".into(), cases.len())?;
    let run = |case: &TrackingCase| case.run(device).context(case.stimulus.name.clone());
    let results = parallel_map(&cases, threads, run, || bar.inc(1))?;
    bar.finish_and_clear();
    let by_touch: Vec<_> = results.chunks(SENSOR_LAGS_S.len()).collect();
    let by_stimulus = by_touch.chunks(TouchingFinger::ALL.len());
    let results = by_stimulus.map(|touches| touches.iter().map(|lags| lags.to_vec()).collect());

    let limits = LimitCase::all();
    let limits = parallel_map(&limits, threads, |case| case.run(device), || ())?;
    Ok(TrackingReport {
        engine: device.name(),
        stimuli: stimuli.iter().map(|stimulus| stimulus.name.clone()).collect(),
        results: results.collect(),
        limits,
        devices: arguments.devices,
        boxed: boxed(arguments, device, &stimuli)?,
    })
}

/// Every stimulus under the thesis's finger on every drawn device.
fn boxed(
    arguments: &Arguments,
    device: &dyn SceneRunner,
    stimuli: &[Stimulus],
) -> anyhow::Result<Vec<TrackingBox>> {
    let draws: Vec<_> =
        (0..arguments.devices).map(|number| PlantDraw::new(arguments.seed, number)).collect();
    if draws.is_empty() {
        return Ok(Vec::new());
    }
    // One job a device, which is commissioned once.
    let of_device = |draw: &PlantDraw| {
        let results = stimuli.iter().map(|stimulus| {
            let case = TrackingCase {
                stimulus: stimulus.clone(),
                touch: TouchingFinger::Thesis,
                plant: draw.plant.clone(),
                seed: draw.seed,
            };
            let mut result = case.run(device)?;
            result.curve = Vec::new();
            Ok(result)
        });
        let results: anyhow::Result<Vec<_>> = results.collect();
        results.with_context(|| format!("draw {} of seed {}", draw.number, arguments.seed))
    };
    let threads = output::threads(arguments.threads);
    let bar = output::run_counter("devices".into(), draws.len())?;
    let devices = parallel_map(&draws, threads, of_device, || bar.inc(1))?;
    bar.finish_and_clear();
    let rows = stimuli.iter().enumerate().filter_map(|(index, stimulus)| {
        let own = || devices.iter().map(|results| &results[index]);
        let worst_mk: Vec<_> = own().map(|result| result.worst_mk).collect();
        Some(TrackingBox {
            stimulus: stimulus.name.clone(),
            worst_mk: Percentiles::of(&worst_mk)?,
            limited: own().filter(|result| result.limited).count(),
            faulty: own().filter(|result| !result.faults.is_empty()).count(),
        })
    });
    Ok(rows.collect())
}
