//! `--normal`: use without a fault.

use anyhow::{Context, anyhow};
use hil_sim::faults::{Device, Session, Used, use_table};
use serde::Serialize;

use super::{Arguments, Failure, each, output};

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    engine: &'static str,
    seed: u64,
    holds: bool,
    sessions: &'a [Used],
}

/// Runs so many hours; a session in which something trips is a failure, and its scene goes to `--out`.
pub fn run(arguments: &Arguments, device: Device<'_>, hours: u64) -> Result<(), Failure> {
    let seed = arguments.seed;
    let numbers: Vec<u64> = (0..Session::in_hours(hours)).collect();
    let work = |number: &u64| {
        let session = Session::new(seed, *number);
        let used = session.run(device);
        if let (Some(folder), Some(_)) = (&arguments.out, &used.failure) {
            let path = folder.join(format!("session-{number}.toml"));
            std::fs::write(&path, &session.text).with_context(|| path.display().to_string())?;
        }
        Ok(used)
    };
    let used = each(arguments, "sessions", device, &numbers, work).map_err(Failure::run)?;
    let failed = used.iter().filter(|used| used.failure.is_some()).count();
    let text = if arguments.json {
        let report = Report {
            engine: device.name(),
            seed,
            holds: failed == 0,
            sessions: &used,
        };
        serde_json::to_string(&report).map_err(Failure::run)? + "\n"
    } else {
        use_table(&used)
    };
    output::print(&text)?;
    if failed == 0 {
        return Ok(());
    }
    Err(Failure::run(anyhow!(
        "{failed} of {} sessions of seed {seed} failed without a fault",
        used.len()
    )))
}
