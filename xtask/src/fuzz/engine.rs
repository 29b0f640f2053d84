//! Processes of libFuzzer: started, watched, and their results collected.
use std::ffi::OsString;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use super::progress::{Progress, Reached};
use super::{Target, create, folder, found};
use crate::process::workspace;

/// Limit for the time of one input, s; a longer one is reported as a hang.
const HANG_S: u32 = 10;
/// Time between two lines of progress.
const REPORT_INTERVAL: Duration = Duration::from_secs(10);
const POLL: Duration = Duration::from_millis(100);
/// Lines of output that are printed for a failed process.
const LAST_LINES: usize = 30;

/// Amount of fuzzing for each target.
#[derive(Clone, Copy, Debug)]
pub enum Effort {
    /// Duration.
    Time(Duration),
    /// Number of executions, summed over all processes.
    Runs(u64),
}

/// The instrumented program.
pub struct Engine {
    /// A copy, which later builds do not overwrite.
    program: PathBuf,
}

/// Output of a process: its progress and its last lines.
#[derive(Default)]
struct Output {
    progress: Progress,
    last: Vec<String>,
}

/// A process, and the thread that reads its output.
struct Process {
    child: Child,
    output: Arc<Mutex<Output>>,
    reader: thread::JoinHandle<()>,
}

impl Process {
    fn start(mut command: Command) -> Result<Self> {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .with_context(|| format!("{}: did not start", command.get_program().display()))?;
        let stderr = child.stderr.take().context("no standard error")?;
        let output = Arc::new(Mutex::new(Output::default()));
        let shared = Arc::clone(&output);
        let reader = thread::spawn(move || {
            for line in BufReader::new(stderr).split(b'\n').map_while(Result::ok) {
                let line = String::from_utf8_lossy(&line).into_owned();
                let mut output = shared.lock().unwrap_or_else(PoisonError::into_inner);
                output.progress.take(&line);
                if output.last.len() == LAST_LINES {
                    output.last.remove(0);
                }
                output.last.push(line);
            }
        });
        Ok(Self { child, output, reader })
    }

    fn progress(&self) -> Progress {
        self.output.lock().unwrap_or_else(PoisonError::into_inner).progress
    }
}

impl Engine {
    /// Copies the built program.
    pub fn new(built: &Path) -> Result<Self> {
        let program = folder().join("fuzz");
        // A program that still runs keeps its file.
        let _ = std::fs::remove_file(&program);
        std::fs::copy(built, &program)
            .with_context(|| format!("{}: cannot be copied", built.display()))?;
        create(&folder().join("found"))?;
        Ok(Self { program })
    }

    fn command(&self, target: Target) -> Command {
        let mut artifacts = OsString::from("-artifact_prefix=");
        artifacts.push(folder().join("found").join(format!("{}-", target.name())));
        let mut command = Command::new(&self.program);
        command
            .current_dir(workspace())
            .env("FUZZ_TARGET", target.name())
            .arg(artifacts)
            .arg(format!("-timeout={HANG_S}"))
            .arg(format!("-max_len={}", target.longest()));
        command
    }

    /// Fuzzes one target.
    ///
    /// Fails if an input crashes, hangs, or violates an assertion of the target.
    pub fn fuzz(&self, target: Target, effort: Effort, jobs: u64) -> Result<Reached> {
        let name = target.name();
        let start = Instant::now();
        let mut processes = Vec::new();
        for _ in 0..jobs {
            let mut command = self.command(target);
            command.args(["-print_final_stats=1", "-reload=5"]);
            // A replay prints the backtrace.
            command.env("RUST_BACKTRACE", "0");
            command.arg(match effort {
                Effort::Time(time) => format!("-max_total_time={}", time.as_secs()),
                Effort::Runs(runs) => format!("-runs={}", runs.div_ceil(jobs)),
            });
            if let Some(path) = target.dictionary() {
                command.arg(format!("-dict={}", path.display()));
            }
            command.arg(found(target)?).args(target.seeds());
            processes.push(Process::start(command)?);
        }
        let mut reported = Instant::now();
        let mut failed = None;
        loop {
            let mut runs_on = false;
            for (i, process) in processes.iter_mut().enumerate() {
                match process.child.try_wait()? {
                    None => runs_on = true,
                    Some(status) if !status.success() => failed = failed.or(Some(i)),
                    Some(_) => {}
                }
            }
            if failed.is_some() || !runs_on {
                break;
            }
            if reported.elapsed() >= REPORT_INTERVAL {
                reported = Instant::now();
                let Progress { executions, edges, features, inputs } = together(&processes);
                let seconds = start.elapsed().as_secs();
                eprintln!(
                    "{name}: {seconds} s, {executions} executions, {edges} edges, {features} features, {inputs} inputs"
                );
            }
            thread::sleep(POLL);
        }
        for process in &mut processes {
            // After a failure the others still run.
            let _ = process.child.kill();
            process.child.wait()?;
        }
        let time = start.elapsed();
        let mut all = Vec::new();
        for (i, process) in processes.into_iter().enumerate() {
            let _ = process.reader.join();
            let output = process.output.lock().unwrap_or_else(PoisonError::into_inner);
            all.push(output.progress);
            if failed == Some(i) {
                bail!(
                    "{name}:\n{}\n{}",
                    output.last.join("\n"),
                    how_to_replay(target, &output.last)
                );
            }
        }
        let progress = Progress::together(&all);
        Ok(Reached { progress, time })
    }

    /// Runs one input and prints its decoded form.
    pub fn replay(&self, target: Target, input: &Path) -> Result<()> {
        let input =
            std::path::absolute(input).with_context(|| format!("--replay {}", input.display()))?;
        let status = self
            .command(target)
            .env("FUZZ_SHOW", "1")
            .arg(&input)
            .status()
            .context("the fuzzer did not start")?;
        if !status.success() {
            bail!("{} fails ({status})", input.display());
        }
        println!("{} passes", input.display());
        Ok(())
    }

    /// Replaces the repository's corpus by the smallest set of inputs with the same coverage.
    pub fn keep(&self, target: Target) -> Result<()> {
        let fewest = folder().join("fewest").join(target.name());
        let _ = std::fs::remove_dir_all(&fewest);
        create(&fewest)?;
        // A copy, because a fuzzer that still runs replaces inputs by shorter ones.
        let now = folder().join("now").join(target.name());
        let _ = std::fs::remove_dir_all(&now);
        create(&now)?;
        for entry in std::fs::read_dir(found(target)?)? {
            let entry = entry?;
            let _ = std::fs::copy(entry.path(), now.join(entry.file_name()));
        }
        let status = self
            .command(target)
            .args(["-set_cover_merge=1", "-use_counters=0"])
            .arg(&fewest)
            .arg(&now)
            .args(target.seeds())
            .status()
            .context("the fuzzer did not start")?;
        if !status.success() {
            bail!("{}: an input fails ({status})", target.name());
        }
        let kept = target.corpus();
        std::fs::remove_dir_all(&kept)
            .with_context(|| format!("{}: cannot be emptied", kept.display()))?;
        create(&kept)?;
        let mut bytes = 0;
        let mut files = 0;
        for entry in std::fs::read_dir(&fewest)? {
            let entry = entry?;
            bytes += std::fs::copy(entry.path(), kept.join(entry.file_name()))?;
            files += 1;
        }
        println!("{}: {files} inputs, {bytes} bytes", kept.display());
        Ok(())
    }
}

fn together(processes: &[Process]) -> Progress {
    let all: Vec<_> = processes.iter().map(Process::progress).collect();
    Progress::together(&all)
}

/// The command that replays the input that libFuzzer says it has written.
fn how_to_replay(target: Target, lines: &[String]) -> String {
    let written =
        lines.iter().find_map(|line| Some(line.split_once("Test unit written to ")?.1.trim()));
    match written {
        Some(file) => {
            format!("to replay: cargo xtask fuzz --target {} --replay {file}", target.name())
        }
        None => "no input was written".into(),
    }
}
