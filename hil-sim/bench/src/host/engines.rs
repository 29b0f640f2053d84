//! Both engines on one scene, in turn: how much faster than real time the simulator runs.
use std::path::Path;

use anyhow::Context;
use serde::Serialize;
use stm32_emulator::Firmware;
use thermal_sim::scene::Scene;
use thermal_sim::{NativeRunner, SceneRunner};

use super::tables::grid;

/// The measured scene: a finger on granite for 10 of 12 s.
const SCENE: &str = include_str!("../../../../scenes/granite.toml");

/// Simulated time divided by run time of both engines, with the truth, the trace and telemetry of every tick. Set-up and
/// settling of the device count as part of the run; commissioning before it does not.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    engines: Vec<Factors>,
}

/// Factors of one engine.
#[derive(Clone, Debug, Serialize)]
struct Factors {
    engine: &'static str,
    /// Median over the rounds.
    median: f64,
    /// Largest of all rounds, that of the least disturbed one.
    largest: f64,
    /// Median over the rounds of the ratio to the first engine in the same round.
    ratio: f64,
}

/// Runs the scene on both engines once a round.
///
/// # Errors
/// The image cannot be built, or a run ended early.
pub fn measure(rounds: usize, progress: impl Fn(&str)) -> anyhow::Result<Figures> {
    let scene = Scene::parse(SCENE, Path::new("scenes/granite.toml"))?;
    let elf = stm32_emulator::build(1)?;
    let image = Firmware::from_file(&elf).with_context(|| elf.display().to_string())?;
    let runners: [&dyn SceneRunner; 2] = [&NativeRunner, &image];
    let mut factors = vec![Vec::with_capacity(rounds); runners.len()];
    for round in 1..=rounds {
        progress(&format!("round {round} of {rounds}"));
        for (runner, factors) in runners.iter().zip(&mut factors) {
            factors.push(runner.run(&scene)?.1.real_time_factor);
        }
    }
    let engines = runners.iter().zip(&factors).map(|(runner, own)| Factors {
        engine: runner.name(),
        median: median(own.clone()),
        largest: own.iter().copied().fold(0.0, f64::max),
        ratio: median(own.iter().zip(&factors[0]).map(|(a, b)| a / b).collect()),
    });
    Ok(Figures { engines: engines.collect() })
}

/// The figures as a table.
pub fn table(figures: &Figures) -> String {
    let heads = ["engine", "x real time", "(fastest)", "x native"];
    grid(
        &heads,
        figures.engines.iter().map(|engine| {
            vec![
                engine.engine.to_owned(),
                format!("{:.0}", engine.median),
                format!("{:.0}", engine.largest),
                format!("{:.3}", engine.ratio),
            ]
        }),
    )
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
