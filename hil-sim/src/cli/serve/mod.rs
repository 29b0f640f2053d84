//! `hil-sim serve`: the device as any program sees it, on a TCP port or a pseudo-terminal.

#[cfg(unix)]
mod pty;

use std::io::{Write as _, stdout};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use anyhow::{Context, anyhow};
use clap::{Args, ValueEnum};
use signal_hook::consts::{SIGINT, SIGTERM};
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::five_fingers::FINGERS;
use thermal_sim::scene::{FaultKind, Scene};
use thermal_sim::serve::{
    ClientLine, Clock, OneFinger, ServedDevice, Speed, TcpLine, read_scene, scenes_of_five_fingers,
    serve,
};

use super::Failure;
use super::engine::{self, EngineKind};

/// Text after the options in the help.
const USAGE: &str = "\
Prints one line, `listening on` and the address or the path of the terminal, and is the device on that line until Ctrl-C.
There is one client at a time. The device runs on when a client goes, so one that was driven trips with host-silent.

  hil-sim serve --tcp 127.0.0.1:4000
  hil-sim serve scenes/copper.toml --engine native --pty";

#[derive(Args)]
#[command(after_help = USAGE)]
pub struct Arguments {
    /// A scene: its plant, its force and its faults; its time zero is 8 s (settle_s) after power-up. Without it nobody
    /// presses, in a room of 24 C
    scene: Option<PathBuf>,
    /// Number of fingers of the device, 1 or 5; the scene is around each
    #[arg(long, default_value_t = 1, value_parser = fingers)]
    fingers: usize,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = EngineKind::DEFAULT)]
    engine: EngineKind,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    #[command(flatten)]
    line: Line,
    /// Whether the device's time is real time, or passes as fast as it goes while a client is connected
    #[arg(long, value_enum, default_value_t = SpeedArgument::RealTime)]
    speed: SpeedArgument,
}

#[derive(Args)]
#[group(required = true, multiple = false)]
struct Line {
    /// Serve on a pseudo-terminal, which programs open as a serial port
    #[cfg(unix)]
    #[arg(long)]
    pty: bool,
    /// Serve on a TCP port of this machine, such as 127.0.0.1:4000; port 0 chooses a free one
    #[arg(long, value_name = "ADDR")]
    tcp: Option<String>,
}

#[derive(Clone, Copy, ValueEnum)]
enum SpeedArgument {
    /// Real time
    #[value(name = "1")]
    RealTime,
    /// As fast as it goes
    Max,
}

fn fingers(text: &str) -> Result<usize, String> {
    match text {
        "1" => Ok(1),
        "5" => Ok(FINGERS),
        _ => Err("devices have 1 or 5 fingers".into()),
    }
}

/// Serves until a signal ends it.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop)).map_err(Failure::run)?;
    }
    let scene = read_scene(arguments.scene.as_deref()).map_err(Failure::input)?;
    note_host_lines(&scene);
    // Refused before an image is built.
    let (mut line, place) = open(&arguments.line)?;
    let speed = match arguments.speed {
        SpeedArgument::RealTime => Speed::RealTime,
        SpeedArgument::Max => Speed::Max,
    };
    let elf = arguments.elf.as_deref();
    let server = Server {
        line: &mut *line,
        place,
        speed,
        stop: &stop,
    };
    match (arguments.engine, arguments.fingers) {
        (EngineKind::Native, 1) => {
            engine::refuse_elf(elf)?;
            let world = world(&scene)?;
            server.run(OneFinger::new(NativeEngine::new(world), scene))
        }
        (EngineKind::Native, _) => Err(Failure::input(anyhow!(
            "--fingers 5 --engine native: the native engine has one finger; allowed is --engine image"
        ))),
        #[cfg(feature = "emulator")]
        (EngineKind::Image, 1) => {
            let engine = super::image::engine(elf, world(&scene)?)?;
            server.run(OneFinger::new(engine, scene))
        }
        #[cfg(feature = "emulator")]
        (EngineKind::Image, _) => {
            if let Some(injection) = scene.injections.first() {
                return Err(Failure::input(anyhow!(
                    "{} is a fault of the processor that five fingers share; such a scene is for one finger",
                    injection.fault
                )));
            }
            let scenes = scenes_of_five_fingers(&scene);
            let worlds: Result<Vec<_>, _> = scenes.iter().map(world).collect();
            let worlds = <[World; FINGERS]>::try_from(worlds?)
                .map_err(|_| Failure::run(anyhow!("a scene for each finger")))?;
            let engine = super::image::five_fingers(elf, worlds)?;
            server.run(thermal_sim::serve::FiveFingers::new(engine, scenes))
        }
    }
}

fn world(scene: &Scene) -> Result<World, Failure> {
    World::new(scene).map_err(Failure::input)
}

/// Says that the client takes the place of the scene's host.
fn note_host_lines(scene: &Scene) {
    let mut kinds = scene.faults.iter().map(|fault| fault.fault.kind);
    let host_fault = |kind| {
        matches!(
            kind,
            FaultKind::HostGarbage | FaultKind::HostSilent | FaultKind::HostFlood
        )
    };
    if !scene.host.is_empty() || kinds.any(host_fault) {
        eprintln!("hil-sim: the lines and faults of the scene's host are left to the client");
    }
}

/// The line and where it is.
fn open(line: &Line) -> Result<(Box<dyn ClientLine>, String), Failure> {
    #[cfg(unix)]
    if line.pty {
        let (line, path) = pty::PtyLine::open()
            .context("--pty")
            .map_err(Failure::run)?;
        return Ok((Box::new(line), path.display().to_string()));
    }
    let address = line.tcp.as_deref().unwrap_or_default();
    let line = TcpLine::listen(address)
        .with_context(|| "--tcp")
        .map_err(Failure::input)?;
    let place = line.address().map_err(Failure::run)?.to_string();
    Ok((Box::new(line), place))
}

/// What a device is served on.
struct Server<'a> {
    line: &'a mut dyn ClientLine,
    place: String,
    speed: Speed,
    stop: &'a AtomicBool,
}

impl Server<'_> {
    fn run<D: ServedDevice>(self, mut device: D) -> Result<(), Failure> {
        let listening = format!("listening on {}\n", self.place);
        let mut out = stdout();
        (out.write_all(listening.as_bytes()))
            .and_then(|()| out.flush())
            .context("standard output")
            .map_err(Failure::run)?;
        let mut clock = Clock::start(self.speed);
        serve(&mut device, self.line, &mut clock, self.stop).map_err(Failure::run)
    }
}
