//! `hil-sim serve`: the device as any program sees it, on a TCP port or a pseudo-terminal.

#[cfg(unix)]
pub mod latency;

use std::io::{Write as _, stdout};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, anyhow};
use clap::{Args, ValueEnum};
use thermal_sim::World;
use thermal_sim::board::{Board, BoardBench, LossyLine};
use thermal_sim::commissioning::{CommissioningSetup, SimulatedSurroundings, settings_for_scene};
use thermal_sim::engine::{Engine, NativeEngine};
use thermal_sim::five_fingers::{FINGERS, FiveFingerEngine, NativeFiveFingers};
use thermal_sim::scene::Scene;
use thermal_sim::serve::{
    self, ClientLine, Clock, FiveFingers, OneFinger, ServedDevice, Speed, TcpLine, read_scene,
    scenes_of_five_fingers, serve_in_step,
};

use super::engine::{self, EngineKind};
use super::{Failure, output};

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
    /// Give the device its settings of calibration and tuning first, and those that the scene says; else it is new from the
    /// factory, and an untuned one is slow and has a small range
    #[arg(long, conflicts_with = "board")]
    commissioned: bool,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = EngineKind::DEFAULT)]
    engine: EngineKind,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    #[command(flatten)]
    line: Line,
    /// Also take lines to the surroundings of the device on a TCP port of this machine: baths, the reference thermometer,
    /// the force of the finger. The device then stands in its place of use, without faults, and its time passes as the
    /// client of the surroundings says
    #[arg(long, value_name = "ADDR")]
    surroundings: Option<String>,
    /// A bare board in place of the scene, for `bring-up`: sound, or with an error of assembly; --surroundings then connect
    /// its parts and read meters, too
    #[arg(long, value_name = "NAME", requires = "surroundings", conflicts_with = "scene")]
    board: Option<String>,
    /// Draw the parts of that board from their tolerances
    #[arg(long, value_name = "SEED", requires = "board")]
    draw: Option<u64>,
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
    let set = Arc::clone(&stop);
    ctrlc::set_handler(move || set.store(true, Ordering::Relaxed)).map_err(Failure::run)?;
    let scene = read_scene(arguments.scene.as_deref()).map_err(Failure::input)?;
    note_host_lines(&scene);
    // What cannot be listened on is refused before an image is built.
    let (line, place) = open(&arguments.line)?;
    let mut announcement = format!("listening on {place}\n");
    let mut surroundings = None;
    if let Some(address) = &arguments.surroundings {
        let (line, place) = listen("--surroundings", address)?;
        announcement += &format!("surroundings on {place}\n");
        surroundings = Some(line);
    }
    let board = arguments.board.as_deref();
    let board = board.map(|name| Board::named(name, arguments.draw)).transpose();
    let board = board.map_err(|error| Failure::input(anyhow!("--board: {error}")))?;
    let server = Server {
        line,
        surroundings,
        board,
        announcement,
        commissioned: arguments.commissioned,
        speed: match arguments.speed {
            SpeedArgument::RealTime => Speed::RealTime,
            SpeedArgument::Max => Speed::Max,
        },
        stop: &stop,
    };
    let elf = arguments.elf.as_deref();
    match (arguments.engine, arguments.fingers) {
        (EngineKind::Native, 1) => {
            engine::refuse_elf(elf)?;
            server.one_finger(scene, |world| Ok(NativeEngine::new(world)))
        }
        (EngineKind::Native, _) => {
            engine::refuse_elf(elf)?;
            server.five_fingers(&scene, |worlds| Ok(NativeFiveFingers::new(worlds)))
        }
        #[cfg(feature = "emulator")]
        (EngineKind::Image, 1) => {
            server.one_finger(scene, |world| super::image::engine(elf, world))
        }
        #[cfg(feature = "emulator")]
        (EngineKind::Image, _) => {
            server.five_fingers(&scene, |worlds| super::image::five_fingers(elf, worlds))
        }
    }
}

/// Says that the client takes the place of the scene's host.
fn note_host_lines(scene: &Scene) {
    let mut faults = scene.faults.iter();
    if !scene.host.is_empty() || faults.any(|fault| fault.fault.kind.is_of_host()) {
        eprintln!("hil-sim: the lines and faults of the scene's host are left to the client");
    }
}

/// Gives a device its settings.
fn set_up<D: ServedDevice>(device: &mut D, settings: &[String]) -> Result<(), Failure> {
    let lines = settings.iter().map(String::as_str);
    serve::set_up(device, lines).context("--commissioned").map_err(Failure::run)
}

/// A line and where it is.
type Place = (Box<dyn ClientLine>, String);

fn open(line: &Line) -> Result<Place, Failure> {
    #[cfg(unix)]
    if line.pty {
        let (line, path) = serve::PtyLine::open().context("--pty").map_err(Failure::run)?;
        return Ok((Box::new(line), path.display().to_string()));
    }
    listen("--tcp", line.tcp.as_deref().unwrap_or_default())
}

/// A TCP port, for this option.
fn listen(option: &'static str, address: &str) -> Result<Place, Failure> {
    let line = TcpLine::listen(address).context(option).map_err(Failure::input)?;
    let place = line.address().map_err(Failure::run)?.to_string();
    Ok((Box::new(line), place))
}

/// What a device is served on.
struct Server<'a> {
    line: Box<dyn ClientLine>,
    surroundings: Option<Box<dyn ClientLine>>,
    board: Option<Board>,
    /// Where these are, as it is printed when the device runs.
    announcement: String,
    /// Whether its settings are those of commissioning.
    commissioned: bool,
    speed: Speed,
    stop: &'a AtomicBool,
}

impl Server<'_> {
    fn one_finger<E: Engine>(
        mut self,
        scene: Scene,
        start: impl FnOnce(World) -> Result<E, Failure>,
    ) -> Result<(), Failure> {
        let settings = self.settings(&scene)?;
        let Some(mut surroundings_line) = self.surroundings.take() else {
            let world = World::new(&scene).map_err(Failure::input)?;
            return self.serve(OneFinger::new(start(world)?, scene), &settings);
        };
        let (world, mut surroundings, lost_bytes_interval) = match self.board.take() {
            Some(board) => {
                let interval = board.lost_bytes_interval;
                let bench = BoardBench::new(board);
                (bench.world(), SimulatedSurroundings::of_board(bench), interval)
            }
            None => {
                let setup = CommissioningSetup::new(&scene.params, scene.room_c, scene.seed);
                (setup.in_use(), SimulatedSurroundings::new(&setup), None)
            }
        };
        let mut device = OneFinger::new(start(world.map_err(Failure::input)?)?, scene);
        set_up(&mut device, &settings)?;
        let mut engine = LossyLine::new(device.into_engine(), lost_bytes_interval);
        self.announce()?;
        let mut clock = Clock::start(self.speed);
        let lines: [&mut dyn ClientLine; 2] = [&mut *self.line, &mut *surroundings_line];
        serve_in_step(&mut engine, &mut surroundings, lines, &mut clock, self.stop)
            .map_err(Failure::run)
    }

    fn five_fingers<H: FiveFingerEngine>(
        self,
        scene: &Scene,
        start: impl FnOnce([World; FINGERS]) -> Result<H, Failure>,
    ) -> Result<(), Failure> {
        if self.surroundings.is_some() {
            return Err(Failure::input(anyhow!(
                "--surroundings are those of one finger; allowed is --fingers 1"
            )));
        }
        if let Some(injection) = scene.injections.first() {
            return Err(Failure::input(anyhow!(
                "{} is a fault of the processor that five fingers share; such a scene is for one finger",
                injection.fault
            )));
        }
        let scenes = scenes_of_five_fingers(scene);
        let worlds: Result<Vec<_>, _> = scenes.iter().map(World::new).collect();
        let worlds = worlds.map_err(Failure::input)?;
        let worlds = <[World; FINGERS]>::try_from(worlds)
            .map_err(|_| Failure::run(anyhow!("a world for each finger")))?;
        let mut settings = Vec::new();
        for (finger, scene) in scenes.iter().enumerate() {
            let lines = self.settings(scene)?;
            settings.extend(lines.into_iter().map(|line| format!("@{finger} {line}")));
        }
        self.serve(FiveFingers::new(start(worlds)?, scenes), &settings)
    }

    /// The lines that set the device of a scene up.
    fn settings(&self, scene: &Scene) -> Result<Vec<String>, Failure> {
        if !self.commissioned {
            return Ok(Vec::new());
        }
        settings_for_scene(scene).context("--commissioned").map_err(Failure::run)
    }

    fn serve<D: ServedDevice>(mut self, mut device: D, settings: &[String]) -> Result<(), Failure> {
        set_up(&mut device, settings)?;
        self.announce()?;
        let mut clock = Clock::start(self.speed);
        serve::serve(&mut device, &mut *self.line, &mut clock, self.stop).map_err(Failure::run)
    }

    fn announce(&self) -> Result<(), Failure> {
        output::print(&self.announcement)?;
        stdout().flush().context("standard output").map_err(Failure::run)
    }
}
