//! `--pairs`: an unnoticed fault, then another one.

use anyhow::anyhow;
use serde::Serialize;
use thermal_campaigns::faults::{FaultPair, PairResult, pair_table, pairs};
use thermal_sim::SceneRunner;

use super::{Arguments, Failure, each, output, tell};

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    engine: &'static str,
    seed: u64,
    holds: bool,
    pairs: &'a [PairResult],
}

/// Runs all pairs; one that breaks the claim is a failure, and its scene goes to `--out`.
pub fn run(arguments: &Arguments, device: &dyn SceneRunner) -> Result<(), Failure> {
    let seed = arguments.seed;
    let work = |pair: &FaultPair| {
        let ran = pair.run(device, seed)?;
        if let (Some(folder), Some(false)) = (&arguments.out, ran.as_ref().map(PairResult::holds)) {
            let words = format!("{} then {}", pair.latent.fault, pair.active.fault);
            let name = words.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
            output::write(folder, &(name + ".toml"), pair.text(seed))?;
        }
        Ok(ran)
    };
    let ran = each(arguments, "pairs", device, &pairs(seed), work).map_err(Failure::run)?;
    let ran: Vec<_> = ran.into_iter().flatten().collect();
    let failing = ran.iter().filter(|pair| !pair.holds()).count();
    let report = Report {
        engine: device.name(),
        seed,
        holds: failing == 0,
        pairs: &ran,
    };
    tell(arguments, &report, || pair_table(&ran))?;
    if failing == 0 {
        return Ok(());
    }
    Err(Failure::run(anyhow!(
        "{failing} of {} pairs break the claim",
        ran.len()
    )))
}
