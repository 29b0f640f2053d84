//! Both engines on one scene, in turn: how much faster than real time the simulator runs.
use std::path::Path;

use anyhow::Context;
use serde::Serialize;
use stm32_emulator::Firmware;
use thermal_sim::scene::Scene;
use thermal_sim::speed::Speed;
use thermal_sim::{NativeRunner, SceneRunner};

use super::tables::grid;

/// The measured scene: a finger on granite for 10 of 12 s.
const SCENE: &str = include_str!("../../../../scenes/granite.toml");

/// Speed of both engines, with the truth, the trace and telemetry of every tick.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    engines: Vec<Factors>,
}

/// Factors of one engine, over the rounds.
#[derive(Clone, Debug, Serialize)]
struct Factors {
    engine: &'static str,
    /// Median real-time factor of a run, counted from the creation of its plant.
    real_time_factor: f64,
    /// Median real-time factor of the simulation's loop.
    loop_real_time_factor: f64,
    /// Largest real-time factor of the loop, in the least disturbed round.
    loop_largest: f64,
    /// Median ratio of the loop's factor to the factor that the first engine's loop had in the same round.
    loop_ratio: f64,
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
    let mut speeds = vec![Vec::<Speed>::with_capacity(rounds); runners.len()];
    for round in 1..=rounds {
        progress(&format!("round {round} of {rounds}"));
        for (runner, speeds) in runners.iter().zip(&mut speeds) {
            speeds.push(runner.run(&scene)?.1.speed);
        }
    }
    let loops = |of: usize| speeds[of].iter().map(|speed| speed.loop_real_time_factor);
    let engines = runners.iter().enumerate().map(|(own, runner)| Factors {
        engine: runner.name(),
        real_time_factor: median(speeds[own].iter().map(|speed| speed.real_time_factor).collect()),
        loop_real_time_factor: median(loops(own).collect()),
        loop_largest: loops(own).fold(0.0, f64::max),
        loop_ratio: median(loops(own).zip(loops(0)).map(|(a, b)| a / b).collect()),
    });
    Ok(Figures { engines: engines.collect() })
}

/// The figures as a table.
pub fn table(figures: &Figures) -> String {
    let heads = ["engine", "x real time", "of the loop", "(fastest)", "x native"];
    let rows = figures.engines.iter().map(|engine| {
        vec![
            engine.engine.to_owned(),
            format!("{:.0}", engine.real_time_factor),
            format!("{:.0}", engine.loop_real_time_factor),
            format!("{:.0}", engine.loop_largest),
            format!("{:.3}", engine.loop_ratio),
        ]
    });
    grid(&heads, rows)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
