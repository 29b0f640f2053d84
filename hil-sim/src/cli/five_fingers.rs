//! `hil-sim hand`: five scenes on the five fingers of one device.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, anyhow};
use clap::Args;
use serde::Serialize;
use thermal_sim::World;
use thermal_sim::engine::Cost;
use thermal_sim::five_fingers::{
    FINGERS, FiveFingerEngine, NativeFiveFingers, run as run_five_fingers,
};
use thermal_sim::metrics::{Figures, figures as figures_of};
use thermal_sim::scene::Scene;

use super::engine::{self, EngineKind};
use super::{Failure, output};

#[derive(Args)]
pub struct Arguments {
    /// The scenes, TOML, from the first finger to the fifth
    #[arg(num_args = FINGERS, required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = EngineKind::DEFAULT)]
    engine: EngineKind,
    /// Image to run instead of the five-finger image of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Print the figures as one JSON object
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report {
    /// Figures of each finger; costs are those of one finger's tick, the mean and the largest of all fingers.
    fingers: Vec<Figures>,
    /// From the request of a tick to its first instruction, cycles, estimated.
    latency_cycles_max: Option<u64>,
}

/// Runs the scenes for a program that began at a time, and prints their figures.
pub fn run(arguments: &Arguments, began: Instant) -> Result<(), Failure> {
    let mut scenes = Vec::new();
    let mut worlds = Vec::new();
    for path in &arguments.scenes {
        let scene = engine::read(path)?;
        let world = World::of_five_fingers(&scene).with_context(|| path.display().to_string());
        worlds.push(world.map_err(Failure::input)?);
        scenes.push(scene);
    }
    let five = || Failure::input(anyhow!("a hand has {FINGERS} scenes"));
    let scenes: [Scene; FINGERS] = scenes.try_into().map_err(|_| five())?;
    let worlds: [World; FINGERS] = worlds.try_into().map_err(|_| five())?;
    let elf = arguments.elf.as_deref();
    let (figures, cost) = match arguments.engine {
        EngineKind::Native => {
            engine::refuse_elf(elf)?;
            measure(&scenes, &mut NativeFiveFingers::new(worlds), began)
        }
        #[cfg(feature = "emulator")]
        EngineKind::Image => {
            let (elf, began) = super::image::path_and_began(elf, FINGERS, began)?;
            measure(&scenes, &mut super::image::five_fingers(Some(&elf), worlds)?, began)
        }
    }?;
    let report = Report { latency_cycles_max: cost.map(|cost| cost.latency_max), fingers: figures };
    let table = || table(&report.fingers, cost);
    output::print_report(arguments.json, &report, table, None)
}

fn measure<H: FiveFingerEngine>(
    scenes: &[Scene; FINGERS],
    five_fingers: &mut H,
    began: Instant,
) -> Result<(Vec<Figures>, Option<Cost>), Failure> {
    let name = format!("five fingers on engine {}", H::NAME);
    let outcomes =
        output::with_progress(name, |progress| run_five_fingers(scenes, five_fingers, progress))?;
    let mut outcomes = outcomes.map_err(Failure::run)?;
    outcomes.iter_mut().for_each(|outcome| outcome.clock.began = began);
    let figures = scenes.iter().zip(&outcomes);
    let figures = figures.map(|(scene, outcome)| figures_of(scene, outcome));
    Ok((figures.collect(), five_fingers.cost()))
}

fn table(figures: &[Figures], cost: Option<Cost>) -> String {
    let mut text = format!(
        "{:<7}{:<18}{:>20}{:>12}  {}\n",
        "finger", "material", "skin after 50 ms mK", "RMS mK", "faults"
    );
    for (finger, of) in figures.iter().enumerate() {
        let number = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.1}"));
        let faults: Vec<_> = of.faults.iter().map(|fault| fault.fault.as_str()).collect();
        let faults = if faults.is_empty() { "none".into() } else { faults.join(", ") };
        text += &format!(
            "{finger:<7}{:<18}{:>20}{:>12}  {faults}\n",
            of.material,
            number(of.skin_max_mk()),
            number(of.skin_rms_mk()),
        );
    }
    if let Some(cost) = cost {
        text += &format!(
            "\na tick of one finger   {:.0} instructions mean, {} max; {:.0} cycles mean, {} max (estimated)\n\
             until a tick begins    {} cycles at most (estimated)\n\
             CPU load, all fingers  {:.2} % (estimated)\n",
            cost.instructions_mean,
            cost.instructions_max,
            cost.cycles_mean,
            cost.cycles_max,
            cost.latency_max,
            cost.load * 100.0,
        );
        if let Some(stack) = cost.stack_bytes {
            text += &format!("stack used             {stack} bytes\n");
        }
    }
    text
}
