//! Checks that run side by side, each with its output in a file.
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result, anyhow};

use crate::process::{Invocation, workspace};
use crate::step::Steps;

/// One check of the suite.
pub struct Check {
    /// Its title in the table.
    pub title: &'static str,
    /// Commands that must succeed in this order, or why there are none.
    pub commands: Result<Vec<Invocation>, &'static str>,
}

/// Checks that run one after the other, because they would wait for the same lock of cargo.
pub type Lane = Vec<Check>;

/// Lines of a failed check's output that are printed.
const LAST_LINES: usize = 200;

/// Runs lanes side by side. After a failure no further check begins; the error is the first one.
pub fn run(lanes: &[Lane], steps: &mut Steps) -> Result<()> {
    let (steps, failed) = (Mutex::new(steps), AtomicBool::new(false));
    let steps = || steps.lock().unwrap_or_else(PoisonError::into_inner);
    let run_lane = |lane: &Lane| {
        for Check { title, commands } in lane {
            if failed.load(Ordering::Relaxed) {
                break;
            }
            let commands = match commands {
                Ok(commands) => commands,
                Err(why) => {
                    steps().skip(title, why);
                    continue;
                }
            };
            let index = steps().start(title, "");
            let start = Instant::now();
            let result = run_commands(title, commands);
            let took = start.elapsed();
            steps().finish(index, result.is_ok(), took);
            let verdict = if result.is_ok() { "passed" } else { "FAILED" };
            eprintln!("{title}: {verdict} after {:.1} s", took.as_secs_f64());
            if result.is_err() {
                failed.store(true, Ordering::Relaxed);
                return result;
            }
        }
        Ok(())
    };
    thread::scope(|scope| {
        let lanes: Vec<_> = lanes.iter().map(|lane| scope.spawn(|| run_lane(lane))).collect();
        let results = lanes.into_iter().map(|lane| lane.join());
        results
            .map(|result| result.unwrap_or_else(|_| Err(anyhow!("a lane of the suite panicked"))))
            .fold(Ok(()), Result::and)
    })
}

fn run_commands(title: &str, commands: &[Invocation]) -> Result<()> {
    let log = log_of(title);
    if let Some(folder) = log.parent() {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    fs::write(&log, "").with_context(|| log.display().to_string())?;
    for command in commands {
        command.run_to_file(&log).map_err(|error| {
            let text = fs::read(&log).unwrap_or_default();
            let text = String::from_utf8_lossy(&text);
            let lines: Vec<_> = text.lines().collect();
            let last = lines[lines.len().saturating_sub(LAST_LINES)..].join("\n");
            let log = log.display();
            anyhow!("{title}\n{last}\n{error}\nall output: {log}; to repeat this, run that command")
        })?;
    }
    Ok(())
}

/// The file for the output of a check.
fn log_of(title: &str) -> PathBuf {
    let name = title.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    workspace().join("target/suite/log").join(name + ".log")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(title: &'static str, script: &str) -> Check {
        Check { title, commands: Ok(vec![Invocation::new("sh", ["-c", script])]) }
    }

    #[test]
    fn a_failure_is_reported_with_its_output_and_stops_its_lane() {
        let failing =
            vec![check("test fails", "echo reason; exit 1"), check("test after", "exit 0")];
        let passing = vec![check("test passes", "true")];
        let mut steps = Steps::new(3);
        let error = run(&[failing, passing], &mut steps).unwrap_err();
        assert!(error.to_string().contains("reason"), "{error}");
        let table = steps.to_string();
        assert!(!table.contains("test after"), "{table}");
    }
}
