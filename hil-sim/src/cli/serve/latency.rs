//! `hil-sim serve-latency`: from the landing of a finger to the line of telemetry that tells a client of it.

use std::fs::OpenOptions;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
#[cfg(feature = "emulator")]
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::cli::{Failure, output};
use anyhow::{Context, Result, anyhow, bail};
use clap::Args;
use serde::Serialize;
use thermal_campaigns::percentile;
use thermal_client::client::Telemetry;
use thermal_device::StateName;
use thermal_sim::World;
use thermal_sim::engine::{Engine, NativeEngine};
use thermal_sim::scene::{Force, Scene};
use thermal_sim::serve::{
    ClientLine, Clock, OneFinger, PtyLine, Speed, TcpLine, read_scene, serve,
};

/// Interval of the landings and how long each lasts, ms.
const INTERVAL_MS: u64 = 500;
const TOUCH_MS: u64 = 200;
const FORCE_N: f64 = 2.0;
/// Interval of the client's signs of life, lines of telemetry.
const SIGN_OF_LIFE: usize = 500;

#[derive(Args)]
pub struct Arguments {
    /// Number of landings for each line and engine, half a second each
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u16).range(1..))]
    landings: u16,
    /// Image to run instead of the one of the current sources
    #[cfg(feature = "emulator")]
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report {
    landings: u16,
    lines: Vec<Row>,
}

/// Latencies on one line with one engine, ms.
#[derive(Serialize)]
struct Row {
    line: &'static str,
    engine: &'static str,
    /// From the landing to the end of the tick that detects it, in the device's time: without line and machine.
    device_ms: Percentiles,
    /// From the landing to the whole line of telemetry at the client, in real time.
    client_ms: Percentiles,
}

#[derive(Serialize)]
struct Percentiles {
    p50: f64,
    p90: f64,
    p99: f64,
    max: f64,
}

impl Percentiles {
    fn new(values: &[f64]) -> Result<Self> {
        let of = |percent| percentile(values, percent).context("no landing was detected");
        Ok(Self { p50: of(50.0)?, p90: of(90.0)?, p99: of(99.0)?, max: of(100.0)? })
    }
}

/// Measures in real time, on TCP and on a pseudo-terminal, with each engine.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = scene(arguments.landings).map_err(Failure::run)?;
    let mut lines = Vec::new();
    for kind in [LineKind::Tcp, LineKind::PseudoTerminal] {
        let world = || World::new(&scene).map_err(Failure::run);
        let native = NativeEngine::new(world()?);
        lines.push(measure(kind, native, &scene).map_err(Failure::run)?);
        #[cfg(feature = "emulator")]
        {
            let image = crate::cli::image::engine(arguments.elf.as_deref(), world()?)?;
            lines.push(measure(kind, image, &scene).map_err(Failure::run)?);
        }
    }
    let report = Report { landings: arguments.landings, lines };
    output::print_report(arguments.json, &report, || table(&report), None)
}

/// A finger that lands again and again from time zero on.
fn scene(landings: u16) -> Result<Scene> {
    let mut scene = read_scene(None)?;
    let force = |ms: u64, force_n| Force { t_s: ms as f64 / 1e3, force_n, ramp_s: 0.0 };
    scene.forces = (0..u64::from(landings))
        .map(|landing| landing * INTERVAL_MS)
        .flat_map(|ms| [force(ms, FORCE_N), force(ms + TOUCH_MS, 0.0)])
        .collect();
    Ok(scene)
}

#[derive(Clone, Copy)]
enum LineKind {
    Tcp,
    PseudoTerminal,
}

/// Serves a device on a line, with a client in another thread.
fn measure<E: Engine>(kind: LineKind, engine: E, scene: &Scene) -> Result<Row> {
    let name = match kind {
        LineKind::Tcp => "tcp",
        LineKind::PseudoTerminal => "pty",
    };
    eprintln!("{name}, engine {}", E::NAME);
    let mut line: Box<dyn ClientLine>;
    let mut stream: Box<dyn Stream>;
    match kind {
        LineKind::Tcp => {
            let port = TcpLine::listen("127.0.0.1:0")?;
            stream = Box::new(TcpStream::connect(port.address()?)?);
            line = Box::new(port);
        }
        LineKind::PseudoTerminal => {
            let (terminal, path) = PtyLine::open()?;
            stream = Box::new(OpenOptions::new().read(true).write(true).open(path)?);
            line = Box::new(terminal);
        }
    }
    let mut clock = Clock::start(Speed::RealTime);
    let zero = clock.started() + Duration::from_secs_f64(scene.settle_s);
    let landings = scene.forces.len() / 2;
    let stop = AtomicBool::new(false);
    let mut device = OneFinger::new(engine, scene.clone());
    let seen = thread::scope(|scope| {
        let client = scope.spawn(|| {
            let seen = Client::new(&mut *stream).and_then(|client| client.watch(landings));
            stop.store(true, Ordering::Relaxed);
            seen
        });
        let served = serve(&mut device, &mut *line, &mut clock, &stop);
        // Ends the client if the device has stopped.
        drop(line);
        served?;
        client.join().map_err(|_| anyhow!("the client failed"))?
    })?;
    let settle_ms = scene.settle_s * 1e3;
    let landing_ms = |landing: usize| landing as f64 * INTERVAL_MS as f64;
    let seen = || seen.iter().enumerate();
    let device_ms = seen().map(|(i, seen)| f64::from(seen.tick) - settle_ms - landing_ms(i));
    let client_ms = seen().map(|(i, seen)| {
        1e3 * seen.at.saturating_duration_since(zero).as_secs_f64() - landing_ms(i)
    });
    Ok(Row {
        line: name,
        engine: E::NAME,
        device_ms: Percentiles::new(&device_ms.collect::<Vec<_>>())?,
        client_ms: Percentiles::new(&client_ms.collect::<Vec<_>>())?,
    })
}

trait Stream: Read + Write + Send {}
impl<S: Read + Write + Send> Stream for S {}

/// The first line of telemetry of a contact.
struct Detected {
    tick: u32,
    at: Instant,
}

/// A client that arms the device and watches its telemetry.
struct Client<'a>(BufReader<&'a mut dyn Stream>);

impl<'a> Client<'a> {
    fn new(stream: &'a mut dyn Stream) -> Result<Self> {
        let mut client = Self(BufReader::new(stream));
        for line in ["material copper", "arm"] {
            client.query(line)?;
        }
        while client.query("state")?.starts_with("ok state=self-test ") {}
        client.query("start")?;
        client.query("stream 1")?;
        Ok(client)
    }

    fn send(&mut self, line: &str) -> Result<()> {
        let bytes = format!("{line}\n");
        Ok(self.0.get_mut().write_all(bytes.as_bytes())?)
    }

    fn line(&mut self) -> Result<String> {
        let mut line = String::new();
        if self.0.read_line(&mut line)? == 0 {
            bail!("the line has ended");
        }
        Ok(line)
    }

    fn query(&mut self, line: &str) -> Result<String> {
        self.send(line)?;
        let answer = self.line()?;
        if !answer.starts_with("ok") {
            bail!("the device answers '{line}' with '{}'", answer.trim_end());
        }
        Ok(answer)
    }

    /// The landings, as many as there are.
    fn watch(mut self, landings: usize) -> Result<Vec<Detected>> {
        let (mut seen, mut touched) = (Vec::new(), false);
        for number in 1_usize.. {
            let line = self.line()?;
            let at = Instant::now();
            let telemetry = Telemetry::parse(line.trim_end())
                .with_context(|| format!("no telemetry: '{}'", line.trim_end()))?;
            let contact = match telemetry.state {
                StateName::Contact => true,
                StateName::Preset => false,
                other => bail!("the device is {}", other.name()),
            };
            if contact && !touched {
                let tick = telemetry.tick;
                seen.push(Detected { tick, at });
            }
            touched = contact;
            if seen.len() == landings {
                break;
            }
            if number.is_multiple_of(SIGN_OF_LIFE) {
                self.send("")?;
            }
        }
        Ok(seen)
    }
}

fn table(report: &Report) -> String {
    let mut text = format!(
        "{:<6}{:<8}{:>26}{:>32}\n{:<14}{}\n",
        "line",
        "engine",
        "device's time, ms",
        "at the client, ms",
        "",
        format!("{:>8}{:>8}{:>8}{:>8}", "p50", "p90", "p99", "max").repeat(2)
    );
    for row in &report.lines {
        text += &format!("{:<6}{:<8}", row.line, row.engine);
        for of in [&row.device_ms, &row.client_ms] {
            for value in [of.p50, of.p90, of.p99, of.max] {
                text += &format!("{value:>8.2}");
            }
        }
        text += "\n";
    }
    text
}
