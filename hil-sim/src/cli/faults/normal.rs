//! `--normal`: normal use without faults.

use thermal_campaigns::faults::{UseSession, session_table};
use thermal_sim::SceneRunner;

use super::{Arguments, Failure, RunsReport, each, output};

/// Runs sessions of some hours; a trip is a failure. Its scene, and one with a finger that was not learnt, is written to `--out`.
pub fn run(arguments: &Arguments, device: &dyn SceneRunner, hours: u64) -> Result<(), Failure> {
    let seed = arguments.seed;
    let numbers: Vec<u64> = (0..UseSession::in_hours(hours)).collect();
    let work = |number: &u64| {
        let session = UseSession::new(seed, *number, arguments.flux_sensor);
        let used = session.run(device);
        let is_told = used.failure.is_some() || !used.distrusts.is_empty();
        if let Some(folder) = arguments.out.as_ref().filter(|_| is_told) {
            output::write(folder, &format!("session-{number}.toml"), &session.text)?;
        }
        Ok(used)
    };
    let used = each(arguments, "sessions", device.name(), &numbers, work).map_err(Failure::run)?;
    let failed = used.iter().filter(|used| used.failure.is_some()).count();
    let report = RunsReport {
        engine: Some(device.name()),
        seed: arguments.seed,
        failing: failed,
        key: "sessions",
        runs: &used,
    };
    let problem = format!("sessions of seed {seed} failed without a fault");
    report.print(arguments, session_table, problem)
}
