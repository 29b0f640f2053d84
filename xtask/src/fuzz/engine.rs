//! libFuzzer's processes.
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

/// An input that takes longer hangs, s.
const HANG_S: u32 = 10;
/// Longest inputs, bytes: more of the same finds nothing more.
const LONGEST: u32 = 1024;
/// Between two lines of progress.
const TELL: Duration = Duration::from_secs(10);
const POLL: Duration = Duration::from_millis(100);
/// Lines that are shown of a process that has failed.
const LAST_LINES: usize = 30;

/// How much is done for each target.
#[derive(Clone, Copy, Debug)]
pub enum Effort {
    /// For so long.
    Time(Duration),
    /// So many executions, all processes together.
    Runs(u64),
}

/// The instrumented program.
pub struct Engine {
    /// A copy, which later builds leave alone.
    program: PathBuf,
}

/// What a process says: its progress, and its last lines.
#[derive(Default)]
struct Said {
    progress: Progress,
    last: Vec<String>,
}

/// A process, and the thread that listens to it.
struct Process {
    child: Child,
    said: Arc<Mutex<Said>>,
    listener: thread::JoinHandle<()>,
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
        let said = Arc::new(Mutex::new(Said::default()));
        let heard = Arc::clone(&said);
        let listener = thread::spawn(move || {
            for line in BufReader::new(stderr).split(b'\n').map_while(Result::ok) {
                let line = String::from_utf8_lossy(&line).into_owned();
                let mut said = heard.lock().unwrap_or_else(PoisonError::into_inner);
                said.progress.take(&line);
                if said.last.len() == LAST_LINES {
                    said.last.remove(0);
                }
                said.last.push(line);
            }
        });
        Ok(Self {
            child,
            said,
            listener,
        })
    }

    fn progress(&self) -> Progress {
        self.said
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .progress
    }
}

impl Engine {
    /// With a program that was built.
    pub fn new(built: &Path) -> Result<Self> {
        let program = folder().join("fuzz");
        // A run that goes on keeps its own.
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
            .arg(format!("-max_len={LONGEST}"));
        command
    }

    /// Fuzzes one target.
    ///
    /// Fails if an input crashes, hangs, or leads to what must not be.
    pub fn fuzz(&self, target: Target, effort: Effort, jobs: u64) -> Result<Reached> {
        let name = target.name();
        let start = Instant::now();
        let mut processes = Vec::new();
        for _ in 0..jobs {
            let mut command = self.command(target);
            command.args(["-print_final_stats=1", "-reload=5"]);
            // A replay has it.
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
        let mut told = Instant::now();
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
            if told.elapsed() >= TELL {
                told = Instant::now();
                let Progress {
                    executions,
                    edges,
                    features,
                    inputs,
                } = together(&processes);
                let seconds = start.elapsed().as_secs();
                eprintln!(
                    "{name}: {seconds} s, {executions} executions, {edges} edges, {features} features, {inputs} inputs"
                );
            }
            thread::sleep(POLL);
        }
        for process in &mut processes {
            // Those of the others that go on.
            let _ = process.child.kill();
            process.child.wait()?;
        }
        let time = start.elapsed();
        let mut all = Vec::new();
        for (i, process) in processes.into_iter().enumerate() {
            let _ = process.listener.join();
            let said = process.said.lock().unwrap_or_else(PoisonError::into_inner);
            all.push(said.progress);
            if failed == Some(i) {
                bail!(
                    "{name}:\n{}\n{}",
                    said.last.join("\n"),
                    how_to_replay(target, &said.last)
                );
            }
        }
        let progress = Progress::together(&all);
        Ok(Reached {
            executions: progress.executions,
            progress,
            time,
        })
    }

    /// Runs one input, and prints what it means.
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
        println!("{} holds", input.display());
        Ok(())
    }

    /// Puts the fewest inputs that cover what all cover into the repository's corpus.
    pub fn keep(&self, target: Target) -> Result<()> {
        let fewest = folder().join("fewest").join(target.name());
        let _ = std::fs::remove_dir_all(&fewest);
        create(&fewest)?;
        // Of those that are there now: a run that goes on replaces some by shorter ones.
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

/// From libFuzzer's `Test unit written to FILE`.
fn how_to_replay(target: Target, lines: &[String]) -> String {
    let written = lines
        .iter()
        .find_map(|line| Some(line.split_once("Test unit written to ")?.1.trim()));
    match written {
        Some(file) => format!(
            "to replay: cargo xtask fuzz --target {} --replay {file}",
            target.name()
        ),
        None => "no input was written".into(),
    }
}
