//! The clients of a device, and what one of them does at a hostile line.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::{self, sleep};
use std::time::{Duration, Instant};

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

use crate::kinds::{Kind, Signal};
use crate::served::{self, Served, Transport, is_driven};

/// Interval at which a running client is looked at.
const LOOK_INTERVAL: Duration = Duration::from_millis(5);
/// Time for which [`Signal::Stop`] lets a client stand still.
const STAND_STILL: Duration = Duration::from_secs(4);
/// Time after which a client that does not end is killed: after the signal that ends it, and altogether.
const KILLED_AFTER_SIGNAL: Duration = Duration::from_secs(30);
const KILLED_AFTER: Duration = Duration::from_secs(100);

/// Time in which a device without a host has tripped: a self-test that has begun is exempt, and takes 0.8 s.
const GUARD_ACTS_WITHIN: Duration = Duration::from_secs(4);

/// What is entered at standard input.
#[derive(Clone, Copy, Debug)]
pub enum Input {
    None,
    /// This, and then nothing, without an end.
    Once(&'static str),
    /// This again and again.
    Again(&'static str),
}

/// A program that uses a device.
#[derive(Clone, Copy, Debug)]
pub struct Client {
    pub name: &'static str,
    pub transport: Transport,
    /// Words of the command, unless it is that of Python; `PLACE`, `SURROUNDINGS` and `FOLDER` stand for those of the case.
    pub words: &'static [&'static str],
    pub input: Input,
    /// Whether the device is armed when it begins.
    pub is_armed_before: bool,
    /// When SIGINT ends it; without, it ends by itself.
    pub interrupted_at: Option<Duration>,
    /// How long it runs on a line without a defect.
    pub takes: Duration,
    /// Whether it leaves the device driven when it ends by itself.
    pub leaves_driven: bool,
    /// Whether a device that it has armed switches its bridge off by itself when it vanishes.
    pub is_guarded: bool,
    pub memory_max_mb: f64,
}

/// What has become of a client.
#[derive(Debug)]
pub struct Outcome {
    /// Exit code; `None` if a signal has ended it.
    pub code: Option<i32>,
    pub was_killed: bool,
    /// From the signal that ends it, or from its begin on.
    pub ended_after: Duration,
    /// Whether a signal that ends it was sent while it ran.
    pub is_interrupted: bool,
    pub said: String,
    pub peak_mb: f64,
    pub client_lines: u64,
    /// Whether the device itself says that it is driven: at once, and when its guard has had the time to act.
    pub is_driven: bool,
    pub is_driven_later: bool,
    /// Its state when the client ended.
    pub state: String,
    pub folder: PathBuf,
}

/// The clients.
pub fn all() -> Vec<Client> {
    let lab = Client {
        name: "info",
        transport: Transport::Tcp,
        words: &["info", "--tcp", "PLACE"],
        input: Input::None,
        is_armed_before: true,
        interrupted_at: None,
        takes: Duration::from_millis(300),
        leaves_driven: true,
        is_guarded: false,
        memory_max_mb: 50.0,
    };
    let stopped = |ms| Some(Duration::from_millis(ms));
    let monitor = Client {
        name: "monitor",
        words: &["monitor", "--headless", "--tcp", "PLACE"],
        input: Input::Once("arm\n"),
        is_armed_before: false,
        is_guarded: true,
        interrupted_at: stopped(5000),
        takes: Duration::from_secs(5),
        leaves_driven: false,
        ..lab
    };
    vec![
        lab,
        Client {
            name: "log",
            words: &["log", "--interval", "10", "--out", "FOLDER/log.csv", "--tcp", "PLACE"],
            interrupted_at: stopped(4000),
            takes: Duration::from_secs(4),
            leaves_driven: false,
            ..lab
        },
        Client {
            name: "play --arm",
            words: &["play", "FOLDER/course.csv", "--arm", "--at", "now", "--tcp", "PLACE"],
            is_armed_before: false,
            is_guarded: true,
            takes: Duration::from_millis(1500),
            ..lab
        },
        monitor,
        Client {
            name: "monitor at a PTY",
            transport: Transport::PseudoTerminal,
            words: &["monitor", "--headless", "--port", "PLACE"],
            ..monitor
        },
        Client {
            name: "run",
            words: &[
                "run",
                "FOLDER/session.toml",
                "--participant",
                "01",
                "--headless",
                "--out",
                "FOLDER/data",
                "--tcp",
                "PLACE",
            ],
            input: Input::Again("c\n"),
            is_armed_before: false,
            is_guarded: true,
            interrupted_at: stopped(7000),
            takes: Duration::from_secs(7),
            leaves_driven: false,
            ..lab
        },
        Client {
            name: "commission --surroundings",
            transport: Transport::InStep,
            words: &["commission", "--tcp", "PLACE", "--surroundings", "SURROUNDINGS"],
            is_armed_before: false,
            interrupted_at: stopped(3000),
            takes: Duration::from_secs(3),
            leaves_driven: false,
            ..lab
        },
        Client {
            name: "send",
            words: &["send", "arm", "state", "-", "--tcp", "PLACE"],
            input: Input::Once("state\n"),
            is_armed_before: false,
            interrupted_at: stopped(2000),
            takes: Duration::from_secs(2),
            leaves_driven: false,
            ..lab
        },
        Client {
            name: "Python",
            words: &[],
            is_armed_before: false,
            is_guarded: true,
            interrupted_at: stopped(4000),
            takes: Duration::from_secs(4),
            leaves_driven: false,
            memory_max_mb: 100.0,
            ..lab
        },
    ]
}

/// A program of somebody who uses the package: it arms, holds a temperature, and watches.
const PYTHON_PROGRAM: &str = "\
import signal, sys, time
from thermal_display import Display, DisplayError
# Whoever starts this in the background may have had it ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
try:
    with Display.tcp(sys.argv[1]) as display:
        display.arm(wait_s=5)
        display.hold(30.0)
        while True:
            display.check()
            time.sleep(0.02)
except KeyboardInterrupt:
    sys.exit(0)
except DisplayError as error:
    sys.exit(f'{type(error).__name__}: {error}')
";

/// The interpreter that has what the package needs, made by `cargo xtask test`.
pub fn python() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/python-package/bin/python3");
    path.is_file().then_some(path)
}

impl Client {
    fn command(&self, served: &Served, folder: &Path) -> Command {
        if self.is_python() {
            let mut command = Command::new(python().expect("an interpreter"));
            let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../python/src");
            command.args(["-B", "-c", PYTHON_PROGRAM, &served.place]).env("PYTHONPATH", source);
            return command;
        }
        let mut command = Command::new(env!("CARGO_BIN_EXE_thermal-lab"));
        command.args(self.words.iter().map(|word| {
            word.replace("PLACE", &served.place)
                .replace("SURROUNDINGS", &served.surroundings)
                .replace("FOLDER", folder.to_str().unwrap())
        }));
        command
    }

    pub fn is_python(&self) -> bool {
        self.name == "Python"
    }

    /// Runs it at a device on a line of this kind, with files in this folder.
    pub fn run(&self, kind: &Kind, folder: &Path) -> Outcome {
        let _ignored = fs::remove_dir_all(folder);
        fs::create_dir_all(folder).unwrap();
        fs::write(folder.join("course.csv"), "t_s,celsius\n0,30\n60,28\n").unwrap();
        let session = concat!(env!("CARGO_MANIFEST_DIR"), "/sessions/p5-real-and-simulated.toml");
        fs::copy(session, folder.join("session.toml")).unwrap();
        let served = Served::start(self.transport, kind);
        if self.is_armed_before {
            served.arm();
        }
        let screen = File::create(folder.join("said.txt")).unwrap();
        let mut child = self
            .command(&served, folder)
            .stdin(Stdio::piped())
            .stdout(screen.try_clone().unwrap())
            .stderr(screen)
            .spawn()
            .unwrap();
        let mut input = child.stdin.take();
        match self.input {
            Input::None => input = None,
            Input::Once(text) => {
                input.as_mut().unwrap().write_all(text.as_bytes()).unwrap();
            }
            Input::Again(text) => {
                let mut input = input.take().unwrap();
                thread::spawn(move || {
                    while input.write_all(text.as_bytes()).is_ok() {
                        sleep(Duration::from_millis(300));
                    }
                });
            }
        }
        let ended = self.attend(&mut child, kind);
        drop(input);
        let state = served.state();
        let is_driven = is_driven(&state);
        if is_driven && self.transport != Transport::InStep {
            sleep(GUARD_ACTS_WITHIN);
        }
        Outcome {
            code: ended.status.code(),
            was_killed: ended.was_killed,
            ended_after: ended.after,
            is_interrupted: ended.is_interrupted,
            said: String::from_utf8_lossy(&fs::read(folder.join("said.txt")).unwrap()).into(),
            peak_mb: ended.peak_kb as f64 / 1024.0,
            client_lines: served.client_lines(),
            is_driven,
            is_driven_later: is_driven && served::is_driven(&served.state()),
            state,
            folder: folder.into(),
        }
    }

    /// Sends the signals to a client, and waits for its end.
    fn attend(&self, child: &mut Child, kind: &Kind) -> Ended {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(kind.seed);
        let moment = self.takes.mul_f64(random.random_range(0.0..1.0));
        let mut ending = self.interrupted_at.map(|at| (Signal::Int, at));
        let mut pause = None;
        match kind.signal {
            Some(Signal::Stop) => pause = Some(moment),
            Some(signal) => ending = Some((signal, moment)),
            None => {}
        }
        let begin = Instant::now();
        let (mut signalled_at, mut was_killed, mut peak_kb) = (None, false, 0);
        loop {
            peak_kb = peak_kb.max(peak_memory_kb(child.id()));
            if let Some(status) = child.try_wait().unwrap() {
                let after = signalled_at.unwrap_or(begin).elapsed();
                return Ended {
                    status,
                    was_killed,
                    after,
                    is_interrupted: signalled_at.is_some(),
                    peak_kb,
                };
            }
            if pause.take_if(|at| begin.elapsed() >= *at).is_some() {
                kill(child, "-STOP");
                sleep(STAND_STILL);
                kill(child, "-CONT");
            }
            if let Some((signal, _)) = ending.take_if(|(_, at)| begin.elapsed() >= *at) {
                kill(
                    child,
                    match signal {
                        Signal::Int | Signal::Stop => "-INT",
                        Signal::Term => "-TERM",
                        Signal::Hup => "-HUP",
                        Signal::Kill => "-KILL",
                    },
                );
                signalled_at = Some(Instant::now());
            }
            let is_late = signalled_at.is_some_and(|at| at.elapsed() > KILLED_AFTER_SIGNAL);
            if is_late || begin.elapsed() > KILLED_AFTER {
                was_killed = true;
                child.kill().unwrap();
            }
            sleep(LOOK_INTERVAL);
        }
    }
}

struct Ended {
    status: ExitStatus,
    was_killed: bool,
    after: Duration,
    is_interrupted: bool,
    peak_kb: u64,
}

fn kill(child: &Child, signal: &str) {
    // It may just have ended.
    let _ignored =
        Command::new("kill").args([signal, &child.id().to_string()]).stderr(Stdio::null()).status();
}

/// Largest resident memory of a running process so far, kB; 0 where the system does not say.
fn peak_memory_kb(id: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    peak.and_then(|rest| rest.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}
