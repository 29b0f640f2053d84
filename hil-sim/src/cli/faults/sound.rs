//! `--sound`: campaigns without a fault.

use thermal_campaigns::faults::{SoundCampaign, SoundResult, sound_table};
use thermal_sim::SceneRunner;

use super::{Arguments, Failure, RunsReport, each, output};

/// Runs so many campaigns; one that breaks a limit is a failure, and its scene is written to `--out`.
pub fn run(arguments: &Arguments, device: &dyn SceneRunner, count: u64) -> Result<(), Failure> {
    let numbers: Vec<u64> = (0..count).collect();
    let work = |number: &u64| {
        let campaign = SoundCampaign::new(arguments.seed, *number);
        let result = campaign.run(device);
        if let Some(folder) = arguments.out.as_ref().filter(|_| !result.holds()) {
            output::write(folder, &format!("sound-{number}.toml"), &campaign.text)?;
        }
        Ok(result)
    };
    let runs: Vec<SoundResult> =
        each(arguments, "campaigns without a fault", device.name(), &numbers, work)
            .map_err(Failure::run)?;
    let failing = runs.iter().filter(|run| !run.holds()).count();
    let report = RunsReport {
        engine: Some(device.name()),
        seed: arguments.seed,
        failing,
        key: "campaigns",
        runs: &runs,
    };
    let problem = format!("campaigns of seed {} broke a limit without a fault", arguments.seed);
    report.print(arguments, sound_table, problem)
}
