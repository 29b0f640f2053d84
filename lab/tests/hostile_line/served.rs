//! A served device at the other end of a hostile line.

use std::net::TcpStream;
use std::path::Path;
use std::sync::Arc;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use thermal_sim::World;
use thermal_sim::commissioning::{CommissioningSetup, SimulatedSurroundings, settings_for_scene};
use thermal_sim::engine::NativeEngine;
use thermal_sim::scene::Scene;
use thermal_sim::serve::{
    ClientLine, Clock, OneFinger, PtyLine, Speed, TcpLine, read_scene, serve, serve_in_step, set_up,
};

use crate::kinds::Kind;
use crate::line::{HostileLine, TestEnds};

/// How a client reaches the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    Tcp,
    PseudoTerminal,
    /// By TCP, in step with its surroundings.
    InStep,
}

/// Time within which a device answers the test. A device whose client has vanished trips within 2 s.
const ANSWER_TIME: Duration = Duration::from_secs(5);
/// Whether the bridge is driven in a state.
pub fn is_driven(state: &str) -> bool {
    ["self-test", "armed", "preset", "contact", "stimulus"].contains(&state)
}

/// A device that is served until this value is dropped.
pub struct Served {
    /// Address or path of its line, and address of its surroundings.
    pub place: String,
    pub surroundings: String,
    questions: Sender<String>,
    answers: Receiver<String>,
    client_lines: Arc<AtomicU64>,
    transport: Transport,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Served {
    pub fn start(transport: Transport, kind: &Kind) -> Self {
        let (questions, asked) = mpsc::channel();
        let (answer, answers) = mpsc::channel();
        let (announce, places) = mpsc::channel();
        let client_lines = Arc::<AtomicU64>::default();
        let stop = Arc::<AtomicBool>::default();
        let ends =
            TestEnds { questions: asked, answers: answer, client_lines: client_lines.clone() };
        let (defect, seed, stopped) = (kind.defect, kind.seed, stop.clone());
        let thread = thread::spawn(move || {
            let (line, place) = open(transport);
            let is_counted = transport == Transport::InStep;
            let mut line = HostileLine::new(line, defect, is_counted, seed, ends);
            let scene = scene();
            if is_counted {
                let mut surroundings_line = TcpLine::listen("127.0.0.1:0").unwrap();
                let surroundings_place = surroundings_line.address().unwrap().to_string();
                let setup = CommissioningSetup::new(&scene.params, scene.room_c, scene.seed);
                let mut engine = NativeEngine::new(setup.in_use().unwrap());
                let mut surroundings = SimulatedSurroundings::new(&setup);
                announce.send((place, surroundings_place)).unwrap();
                let mut clock = Clock::start(Speed::Max);
                let lines: [&mut dyn ClientLine; 2] = [&mut line, &mut surroundings_line];
                serve_in_step(&mut engine, &mut surroundings, lines, &mut clock, &stopped).unwrap();
                return;
            }
            let world = World::new(&scene).unwrap();
            let mut device = OneFinger::new(NativeEngine::new(world), scene);
            set_up(&mut device, settings().iter().map(String::as_str)).unwrap();
            announce.send((place, String::new())).unwrap();
            serve(&mut device, &mut line, &mut Clock::start(Speed::RealTime), &stopped).unwrap();
        });
        let (place, surroundings) = places.recv().expect("a device");
        Self {
            place,
            surroundings,
            questions,
            answers,
            client_lines,
            transport,
            stop,
            thread: Some(thread),
        }
    }

    /// Asks the device itself, past the defect of its line; `None` if it does not answer.
    fn ask(&self, line: &str) -> Option<String> {
        // The time of a device in step passes only while somebody is connected.
        let _somebody =
            (self.transport == Transport::InStep).then(|| TcpStream::connect(&self.place));
        // A restart of the device leaves lines unanswered, and the first answer then counts as that of one of them.
        (0..3).find_map(|_| {
            self.questions.send(line.into()).expect("a device");
            self.answers.recv_timeout(ANSWER_TIME).ok()
        })
    }

    /// The word of its state.
    pub fn state(&self) -> String {
        let answer = self.ask("state").unwrap_or_else(|| "no answer".into());
        let state = answer.strip_prefix("ok state=").and_then(|rest| rest.split(' ').next());
        state.unwrap_or(&answer).into()
    }

    /// Arms it without a client.
    pub fn arm(&self) {
        self.ask("arm");
        let begin = Instant::now();
        while self.state() != "armed" {
            assert!(begin.elapsed() < ANSWER_TIME, "the self-test takes 0.8 s");
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// Lines that its clients have sent.
    pub fn client_lines(&self) -> u64 {
        self.client_lines.load(Ordering::Relaxed)
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // What has failed there has ended the line.
            let _ignored = thread.join();
        }
    }
}

fn open(transport: Transport) -> (Box<dyn ClientLine>, String) {
    if transport == Transport::PseudoTerminal {
        let (line, path) = PtyLine::open().unwrap();
        return (Box::new(line), path.display().to_string());
    }
    let line = TcpLine::listen("127.0.0.1:0").unwrap();
    let place = line.address().unwrap().to_string();
    (Box::new(line), place)
}

fn scene() -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/copper.toml");
    let mut scene = read_scene(Some(Path::new(path))).unwrap();
    scene.forces.clear();
    scene
}

/// The settings of a device that was commissioned.
fn settings() -> &'static [String] {
    static SETTINGS: OnceLock<Vec<String>> = OnceLock::new();
    SETTINGS.get_or_init(|| settings_for_scene(&scene()).unwrap())
}
