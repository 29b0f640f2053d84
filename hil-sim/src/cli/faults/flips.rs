//! `--flips`: single bit flips of the running image.

use std::ops::Range;

use anyhow::{Context, anyhow};
use thermal_campaigns::faults::{BitFlip, FlipEffect, FlippableMemory, ReferenceRun, flip_table};
use thermal_sim::SceneRunner;

use super::{Arguments, Failure, RunsReport, each, output};

/// Runs the flips with these numbers; a broken limit is a failure, and its scene is written to `--out`.
pub fn run(
    arguments: &Arguments,
    device: &dyn SceneRunner,
    numbers: Range<u64>,
) -> Result<(), Failure> {
    if !device.has_processor() {
        let problem =
            anyhow!("--flips with --engine native, which has no bits to flip; image is allowed");
        return Err(Failure::input(problem));
    }
    let of_place = |place: &_| ReferenceRun::new(device, *place);
    let references = each(arguments, "references", device.name(), &ReferenceRun::PLACES, of_place)
        .map_err(Failure::run)?;
    let stack_bytes = references.iter().filter_map(ReferenceRun::stack_bytes).max();
    let memory = FlippableMemory::new(device, stack_bytes.unwrap_or(0)).map_err(Failure::run)?;
    let seed = arguments.seed;
    let flips: Vec<_> = numbers.map(|number| BitFlip::new(seed, number, &memory)).collect();
    let work = |flip: &BitFlip| {
        let flipped = flip.run(device, &references);
        let flipped = flipped.with_context(|| format!("number {} of seed {seed}", flip.number))?;
        if let (Some(folder), true) =
            (&arguments.out, flips.len() == 1 || flipped.class == FlipEffect::Broken)
        {
            output::write(folder, &format!("flip-{}.toml", flip.number), flip.text())?;
        }
        Ok(flipped)
    };
    let ran = each(arguments, "flips", device.name(), &flips, work).map_err(Failure::run)?;
    let failing = ran.iter().filter(|run| run.class == FlipEffect::Broken).count();
    let report =
        RunsReport { engine: None, seed: arguments.seed, failing, key: "flips", runs: &ran };
    let problem =
        "flips break a limit; --replay NUMBER with the same --flips and --seed repeats one"
            .to_owned();
    report.print(arguments, flip_table, problem)
}
