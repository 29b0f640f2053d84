//! The part of the fault matrix on the device for five fingers.

use thermal_campaigns::faults::{FaultCase, FaultSummary, FiveFingerRun, Reference, Strict};

use super::{Arguments, each};
use crate::cli::{Failure, engine};

/// Runs the cases and summarises each.
pub fn outlines(
    arguments: &Arguments,
    cases: Vec<FaultCase>,
) -> Result<Vec<FaultSummary>, Failure> {
    if cases.is_empty() {
        return Ok(Vec::new());
    }
    let (mut device, name) =
        engine::five_finger_runner(arguments.engine, arguments.elf.as_deref())?;
    if arguments.strict {
        device = Box::new(Strict(device));
    }
    let runs = FiveFingerRun::all(cases, arguments.seed);
    let needed = Reference::needed(&runs);
    let references = each(arguments, "five fingers without a fault", name, &needed, |run| {
        Reference::run(device.as_ref(), *run)
    })
    .map_err(Failure::run)?;
    let trials = each(arguments, "five fingers with a fault", name, &runs, |run| {
        run.run(device.as_ref(), &references)
    })
    .map_err(Failure::run)?;
    let summaries = runs.iter().zip(trials);
    Ok(summaries.map(|(run, trials)| run.summary(trials)).collect())
}
