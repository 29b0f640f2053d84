//! Runs commands, and prints them so that the user can repeat them.
use std::ffi::OsString;
use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

/// Interval of polling in a wait with a time limit.
const POLL: Duration = Duration::from_millis(20);

/// Time limit of queries such as `rustc --version`.
const PROBE_LIMIT: Duration = Duration::from_secs(20);

/// Cargo's profile of the test suite, and the folder below `target/` for what it compiles.
pub const SUITE: &str = "suite";

/// Feature with which the suite compiles all programs: what the windows show is tested without a display. Cargo would compile a
/// dependency, and what depends on it, once more for other features.
pub const VIEWS: &str = "thermal-window/views";

/// The root of the workspace, in which every command runs.
pub fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

/// The folder for what cargo compiles of the workspace.
pub fn target_folder() -> PathBuf {
    let chosen = std::env::var_os("CARGO_TARGET_DIR");
    chosen.map_or_else(|| workspace().join("target"), PathBuf::from)
}

/// A command line with changes of the environment. Its `Display` is a shell command for the workspace's root, in which bytes
/// that are not Unicode are replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Invocation {
    program: OsString,
    shown: Vec<String>,
    args: Vec<OsString>,
    set: Vec<(String, String)>,
    unset: Vec<&'static str>,
}

impl Invocation {
    /// `program` with `args`, without quoting.
    pub fn new<A: Into<OsString>>(program: &str, args: impl IntoIterator<Item = A>) -> Self {
        Self {
            program: program.into(),
            shown: vec![program.into()],
            args: args.into_iter().map(Into::into).collect(),
            set: Vec::new(),
            unset: Vec::new(),
        }
    }

    /// The cargo that runs this program, printed as `cargo`.
    pub fn cargo<A: Into<OsString>>(args: impl IntoIterator<Item = A>) -> Self {
        let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        Self { program, ..Self::new("cargo", args) }
    }

    /// This program, printed as `cargo xtask`. Started by cargo, it would wait for cargo's lock of the target folder, which the
    /// compilation of another lane may hold for minutes.
    pub fn xtask<A: Into<OsString>>(args: impl IntoIterator<Item = A>) -> Self {
        let program = std::env::current_exe().unwrap_or_else(|_| "xtask".into());
        Self {
            program: program.into(),
            shown: vec!["cargo".into(), "xtask".into()],
            ..Self::new("", args)
        }
    }

    /// The program of a package of the workspace with `args`, compiled for release.
    pub fn run_package<A: Into<OsString>>(
        package: &'static str,
        args: impl IntoIterator<Item = A>,
    ) -> Self {
        Self::cargo(["run", "--release", "--package", package, "--"]).args(args)
    }

    /// Runs a program of the workspace as it is measured: compiled without checks of integer overflow.
    pub fn bench_package<A: Into<OsString>>(
        package: &'static str,
        args: impl IntoIterator<Item = A>,
    ) -> Self {
        Self::cargo(["run", "--profile", "bench", "--package", package, "--"]).args(args)
    }

    /// Appends to the command line.
    pub fn args<A: Into<OsString>>(mut self, args: impl IntoIterator<Item = A>) -> Self {
        self.args.extend(args.into_iter().map(Into::into));
        self
    }

    /// Sets an environment variable; printed with the command.
    pub fn env(mut self, name: &str, value: impl Into<String>) -> Self {
        self.set.push((name.into(), value.into()));
        self
    }

    /// Removes inherited environment variables; not printed, as a user's shell rarely has them.
    pub fn without(mut self, names: &[&'static str]) -> Self {
        self.unset.extend(names);
        self
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.args).current_dir(workspace());
        for name in &self.unset {
            command.env_remove(name);
        }
        command.envs(self.set.iter().map(|(name, value)| (name, value)));
        command
    }

    /// Runs the command with the terminal's streams; an error if it does not start or fails.
    pub fn run(&self) -> Result<()> {
        self.check(self.command().status())
    }

    /// As [`run`](Self::run), with the command's standard output on standard error.
    pub fn run_to_stderr(&self) -> Result<()> {
        self.check(self.command().stdout(std::io::stderr()).status())
    }

    /// Runs the command and hands each line of its standard output to `on_line`, when it comes.
    pub fn run_line_by_line(&self, mut on_line: impl FnMut(&str)) -> Result<()> {
        let mut command = self.command();
        let child = command.stdout(Stdio::piped()).spawn();
        let mut child = child.with_context(|| format!("`{self}` did not start"))?;
        if let Some(stdout) = child.stdout.take() {
            for line in BufReader::new(stdout).lines() {
                on_line(&line?);
            }
        }
        self.check(child.wait())
    }

    /// Appends everything the command prints to a file, without standard input.
    pub fn run_to_file(&self, path: &Path) -> Result<()> {
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.with_context(|| path.display().to_string())?;
        let mut command = self.command();
        command.stdin(Stdio::null()).stdout(file.try_clone()?);
        self.check(command.stderr(file).status())
    }

    /// Writes what the command prints on standard output to a file; its progress stays on standard error.
    pub fn run_with_stdout_in(&self, path: &Path) -> Result<()> {
        let file = File::create(path).with_context(|| path.display().to_string())?;
        self.check(self.command().stdout(file).status())
    }

    /// As [`run_to_stderr`](Self::run_to_stderr) without standard input, killed after `limit`.
    ///
    /// Only the process itself is killed, not its children.
    pub fn run_bounded(&self, limit: Duration) -> Result<()> {
        let mut command = self.command();
        command.stdin(Stdio::null()).stdout(std::io::stderr());
        let child = command.spawn().with_context(|| format!("`{self}` did not start"))?;
        let Some(child) = wait(child, limit)? else {
            bail!("`{self}` did not end within {} s and was stopped", limit.as_secs());
        };
        self.check(Ok(child))
    }

    fn check(&self, status: std::io::Result<ExitStatus>) -> Result<()> {
        let status = status.with_context(|| format!("`{self}` did not start"))?;
        if !status.success() {
            bail!("`{self}` failed ({status})");
        }
        Ok(())
    }

    /// Standard output of a short query; `None` if it does not start, fails or exceeds the time limit.
    pub fn answer(&self) -> Option<String> {
        let mut command = self.command();
        command.stdin(Stdio::null()).stderr(Stdio::null());
        command.stdout(Stdio::piped());
        let mut child = command.spawn().ok()?;
        let stdout = child.stdout.take()?;
        // Read in a thread: a full pipe would block the command.
        let text = std::thread::spawn(|| std::io::read_to_string(stdout));
        if !wait(child, PROBE_LIMIT).ok()??.success() {
            return None;
        }
        text.join().ok()?.ok()
    }
}

/// A program that runs beside this one until it is dropped.
pub struct Background {
    child: Child,
    stdout: BufReader<ChildStdout>,
}

impl Background {
    /// Starts a command without standard input.
    pub fn start(invocation: &Invocation) -> Result<Self> {
        let mut command = invocation.command();
        command.stdin(Stdio::null()).stdout(Stdio::piped());
        let child = command.spawn();
        let mut child = child.with_context(|| format!("`{invocation}` did not start"))?;
        let stdout = child.stdout.take().context("no standard output")?;
        Ok(Self { child, stdout: BufReader::new(stdout) })
    }

    /// The next line that it prints; `None` after the last.
    pub fn line(&mut self) -> Option<String> {
        let mut line = String::new();
        let read = self.stdout.read_line(&mut line).ok()?;
        (read > 0).then(|| line.trim_end().into())
    }
}

impl Drop for Background {
    /// Ends the program. On Unix `cargo run` becomes the program that it runs, so that is ended, too.
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ignored = self.child.kill();
        let _ignored = self.child.wait();
    }
}

/// The status of a child, or `None` if it had to be killed after `limit`.
fn wait(mut child: std::process::Child, limit: Duration) -> Result<Option<ExitStatus>> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if start.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        sleep(POLL);
    }
}

impl fmt::Display for Invocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, value) in &self.set {
            write!(f, "{name}={} ", quoted(value))?;
        }
        let shown: Vec<_> = self.shown.iter().map(|word| quoted(word)).collect();
        f.write_str(&shown.join(" "))?;
        for arg in &self.args {
            write!(f, " {}", quoted(&arg.to_string_lossy()))?;
        }
        Ok(())
    }
}

/// `word` quoted for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Path of `program` on the search path.
pub fn on_path(program: &str) -> Option<PathBuf> {
    let paths = std::env::var_os("PATH")?;
    std::env::split_paths(&paths).map(|dir| dir.join(program)).find(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_printed_command_can_be_run_by_a_shell() {
        let odd = "it's $HOME; \"two  words\"";
        let shown = Invocation::new("printf", ["%s", odd]).env("UNUSED", "a b").to_string();
        let echoed = Invocation::new("sh", ["-c", &shown]).answer();
        assert_eq!(echoed.as_deref(), Some(odd), "{shown}");
    }

    #[cfg(unix)]
    #[test]
    fn arguments_that_are_not_unicode_are_passed_unchanged() {
        use std::os::unix::ffi::OsStringExt;
        // One byte that begins no character: it counts as one, its replacement would be three.
        let odd = OsString::from_vec(vec![0xff]);
        let script = "printf %s \"$1\" | wc -c | tr -d ' '";
        let args = ["-c".into(), script.into(), "sh".into(), odd];
        assert_eq!(Invocation::new("sh", args).answer().as_deref(), Some("1\n"));
    }

    #[test]
    fn a_command_beyond_its_time_limit_is_stopped_and_named() {
        let error =
            Invocation::new("sleep", ["600"]).run_bounded(Duration::from_millis(50)).unwrap_err();
        assert!(error.to_string().contains("`sleep 600`"), "{error}");
    }

    #[test]
    fn a_failed_or_missing_command_is_an_error() {
        assert!(Invocation::new("true", [""; 0]).run().is_ok());
        assert!(Invocation::new("false", [""; 0]).run().is_err());
        assert!(Invocation::new("no-such-program-anywhere", [""; 0]).run().is_err());
        assert_eq!(Invocation::new("sh", ["-c", "echo lost; exit 3"]).answer(), None);
    }

    #[test]
    fn an_answer_longer_than_the_pipes_buffer_is_read_completely() {
        let answer = Invocation::new("head", ["-c", "300000", "/dev/zero"]).answer();
        assert_eq!(answer.map(|text| text.len()), Some(300_000));
    }

    #[test]
    fn removed_variables_do_not_reach_the_command() {
        let question =
            Invocation::new("sh", ["-c", "echo ${PATH-none} $ADDED"]).env("ADDED", "here");
        assert_ne!(question.answer().as_deref(), Some("none here\n"));
        let hidden =
            Invocation::new("/bin/sh", ["-c", "echo ${HOME-none} $ADDED"]).env("ADDED", "here");
        assert_eq!(hidden.without(&["HOME"]).answer().as_deref(), Some("none here\n"));
    }
}
