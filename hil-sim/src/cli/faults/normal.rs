//! `--normal`: use without a fault.

use anyhow::anyhow;
use serde::Serialize;
use thermal_campaigns::faults::{SessionResult, UseSession, session_table};
use thermal_sim::SceneRunner;

use super::{Arguments, Failure, each, output, tell};

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    engine: &'static str,
    seed: u64,
    holds: bool,
    sessions: &'a [SessionResult],
}

/// Runs so many hours; a session in which something trips is a failure, and its scene goes to `--out`.
pub fn run(arguments: &Arguments, device: &dyn SceneRunner, hours: u64) -> Result<(), Failure> {
    let seed = arguments.seed;
    let numbers: Vec<u64> = (0..UseSession::in_hours(hours)).collect();
    let work = |number: &u64| {
        let session = UseSession::new(seed, *number);
        let used = session.run(device);
        if let (Some(folder), Some(_)) = (&arguments.out, &used.failure) {
            output::write(folder, &format!("session-{number}.toml"), &session.text)?;
        }
        Ok(used)
    };
    let used = each(arguments, "sessions", device, &numbers, work).map_err(Failure::run)?;
    let failed = used.iter().filter(|used| used.failure.is_some()).count();
    let report = Report {
        engine: device.name(),
        seed,
        holds: failed == 0,
        sessions: &used,
    };
    tell(arguments, &report, || session_table(&used))?;
    if failed == 0 {
        return Ok(());
    }
    Err(Failure::run(anyhow!(
        "{failed} of {} sessions of seed {seed} failed without a fault",
        used.len()
    )))
}
