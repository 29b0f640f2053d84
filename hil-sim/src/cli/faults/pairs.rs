//! `--pairs`: a latent fault followed by another one.

use thermal_campaigns::faults::{FaultPair, pair_table, pairs};
use thermal_sim::SceneRunner;

use super::{Arguments, Failure, RunsReport, each, output};

/// Runs all pairs; a broken limit is a failure, and its scene is written to `--out`.
pub fn run(arguments: &Arguments, device: &dyn SceneRunner) -> Result<(), Failure> {
    let seed = arguments.seed;
    let work = |pair: &FaultPair| {
        let ran = pair.run(device, seed)?;
        if let (Some(folder), Some(false)) =
            (&arguments.out, ran.as_ref().map(|ran| ran.trial.holds()))
        {
            let words = format!("{} then {}", pair.latent.fault, pair.active.fault);
            let name = words.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
            output::write(folder, &(name + ".toml"), pair.text(seed))?;
        }
        Ok(ran)
    };
    let ran = each(arguments, "pairs", device.name(), &pairs(seed), work).map_err(Failure::run)?;
    let ran: Vec<_> = ran.into_iter().flatten().collect();
    let failing = ran.iter().filter(|pair| !pair.trial.holds()).count();
    let report = RunsReport {
        engine: Some(device.name()),
        seed: arguments.seed,
        failing,
        key: "pairs",
        runs: &ran,
    };
    let problem = "pairs break the claim".to_owned();
    report.print(arguments, pair_table, problem)
}
