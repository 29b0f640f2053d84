//! Measurements in the emulator: the longest tick and the deepest stack over the scenes, beside the stack's proven bound.
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use documented_figures::{Verdict, figure};
use stm32_emulator::Firmware;
use stm32_emulator::FiveFingerBoard;
use stm32_emulator::OneFingerBoard;
use thermal_campaigns::parallel_map;
use thermal_sim::World;
use thermal_sim::commissioning::{CommissioningSetup, commission};
use thermal_sim::engine::{Cost, Engine};
use thermal_sim::five_fingers::{self, FINGERS, FiveFingerEngine as _};
use thermal_sim::run::{Outcome, run};
use thermal_sim::scene::Scene;

use crate::scenes::{courses, faulty, touched};
use crate::{Proof, Section, levels};

/// Cycles of a millisecond at 180 MHz.
const MILLISECOND: u64 = 180_000;

/// Figures of one run.
struct Measured {
    what: String,
    cost: Cost,
}

/// Checks that ticks and stack are as `docs/figures.toml` states, and that the stack is within its upper bound.
///
/// # Errors
/// A scene does not run to its end.
pub fn check(proof: &Proof, elf: &Path, fingers: usize) -> Result<Section> {
    let firmware = Firmware::from_file(elf).with_context(|| elf.display().to_string())?;
    let all = match fingers {
        1 => alone(&firmware)?,
        FINGERS => vec![together(&firmware)?],
        other => bail!("an image for {other} fingers; known are 1 and {FINGERS}"),
    };
    let (bound, available) = (levels::bound(proof)?, MILLISECOND / fingers as u64);
    let mut section = Section { title: "emulated".into(), ..Section::default() };
    let of = |what: fn(&Cost) -> u64| {
        let largest = all.iter().max_by_key(|measured| what(&measured.cost));
        largest.map(|measured| (what(&measured.cost), measured.what.as_str())).context("no scene")
    };
    let instructions = of(|cost| cost.instructions_max)?;
    let cycles = of(|cost| cost.cycles_max)?;
    let stack = of(|cost| cost.stack_bytes.unwrap_or(0).into())?;
    ensure!(stack.0 > 0, "the image does not say where its stack ends");
    section.lines.push(format!("{} scenes; {available} cycles are there for a tick", all.len()));
    let Section { lines, violations, differences, .. } = &mut section;
    let hand = if fingers == 1 { "one" } else { "five" };
    let proven = (u64::from(bound), "proven");
    for (what, (value, scene)) in
        [("instructions", instructions), ("cycles", cycles), ("stack", stack), ("bound", proven)]
    {
        let figure = figure(&format!("proof.{what}_{hand}"));
        lines.push(format!("{value} {} ({scene}), {figure}", figure.unit));
        if let Verdict::Differs(why) = figure.judge(value as f64) {
            differences.push(format!("{why} ({scene})"));
        }
    }
    if stack.0 > u64::from(bound) {
        let (seen, scene) = stack;
        violations.push(format!("{seen} bytes of stack in {scene}, proven are {bound}"));
    }
    if cycles.0 > available {
        violations.push(format!("{} cycles in {}: late", cycles.0, cycles.1));
    }
    Ok(section.judged(&proof.compiler))
}

/// Cost of all scenes with one finger, without the eight seconds before each.
fn alone(firmware: &Firmware) -> Result<Vec<Measured>> {
    let scenes = touched()?.into_iter().chain(faulty()?).chain(courses()?);
    let scenes: Vec<(String, Scene)> = scenes.collect();
    let jobs: Vec<Option<&(String, Scene)>> =
        [None].into_iter().chain(scenes.iter().map(Some)).collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let measured = |job: &Option<&(String, Scene)>| {
        let Some((what, scene)) = job else {
            return commissioned(firmware);
        };
        let mut image = OneFingerBoard::new(firmware, World::new(scene)?)?;
        let outcome = run(scene, &mut image, |_| ()).with_context(|| what.clone())?;
        let plays = (scene.host.iter()).any(|sent| sent.line.starts_with("play"));
        let started = (outcome.events.iter()).any(|(_, line)| line.ends_with("start"));
        ensure!(started || !plays, "{what}: no course has started");
        of_outcome(what, &outcome)
    };
    parallel_map(&jobs, threads, measured, || ())
}

fn of_outcome(what: &str, outcome: &Outcome) -> Result<Measured> {
    let cost = outcome.cost.with_context(|| format!("{what}: no tick"))?;
    Ok(Measured { what: what.into(), cost })
}

/// Cost of commissioning: calibration of the sensors and identification of the tile.
fn commissioned(firmware: &Firmware) -> Result<Measured> {
    let what = "commissioning";
    let (_, scene) = touched()?.into_iter().next().context("no scene")?;
    let plants = CommissioningSetup::new(&scene.params, scene.room_c, scene.seed);
    let mut image = OneFingerBoard::new(firmware, plants.in_use()?)?;
    commission(&plants, &mut image, &mut |_| ())?;
    Ok(Measured { what: what.into(), cost: image.cost().context("commissioning: no tick")? })
}

/// Five fingers at once, some of them with faults.
fn together(firmware: &Firmware) -> Result<Measured> {
    let touched = touched()?.into_iter().take(3);
    let faulty = faulty()?
        .into_iter()
        .filter(|(what, _)| ["bridge-shorted", "host-flood"].contains(&what.as_str()));
    let (names, scenes): (Vec<String>, Vec<Scene>) = touched.chain(faulty).unzip();
    let scenes: [Scene; FINGERS] =
        scenes.try_into().map_err(|other: Vec<_>| anyhow::anyhow!("{} scenes", other.len()))?;
    let mut worlds = Vec::new();
    for scene in &scenes {
        worlds.push(World::of_five_fingers(scene)?);
    }
    let worlds = worlds.try_into().map_err(|_| anyhow::anyhow!("worlds"))?;
    let mut hand = FiveFingerBoard::new(firmware, worlds)?;
    five_fingers::run(&scenes, &mut hand, |_| ())?;
    Ok(Measured { what: names.join(", "), cost: hand.cost().context("no tick")? })
}
