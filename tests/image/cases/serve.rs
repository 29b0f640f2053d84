//! The image and the native engine as a client of a served device sees them.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use image_tests::image;
use stm32_emulator::{Firmware, FiveFingerBoard, OneFingerBoard};
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::five_fingers::{FINGERS, NativeFiveFingers};
use thermal_sim::scene::{Force, Scene};
use thermal_sim::serve::{
    ClientLine, Clock, FiveFingers, OneFinger, ServedDevice, Speed, read_scene,
    scenes_of_five_fingers, serve,
};

/// Time of the end, ms.
const END_MS: u64 = 5000;

/// A finger that lands when the device has been on for 4 s.
fn scene() -> Scene {
    let mut scene = read_scene(None).expect("a scene");
    scene.forces = vec![Force { t_s: -4.0, force_n: 2.0, ramp_s: 0.0 }];
    scene
}

fn world(scene: &Scene) -> World {
    World::new(scene).expect("a plant for the scene")
}

/// A client that sends lines at their times, reads everything, and ends the serving.
struct Script<'a> {
    lines: &'a [(u64, &'a str)],
    ms: u64,
    waiting: Vec<u8>,
    received: Vec<u8>,
    stop: &'a AtomicBool,
}

impl ClientLine for Script<'_> {
    fn poll(&mut self) -> Option<u64> {
        let due = self.lines.iter().filter(|(ms, _)| *ms == self.ms);
        self.waiting.extend(due.flat_map(|(_, line)| line.bytes()));
        self.ms += 1;
        self.stop.store(self.ms == END_MS, Ordering::Relaxed);
        Some(1)
    }

    fn read(&mut self, limit: usize) -> Vec<u8> {
        let now = limit.min(self.waiting.len());
        self.waiting.drain(..now).collect()
    }

    fn write(&mut self, bytes: &[u8], _patience: Duration) -> usize {
        self.received.extend(bytes);
        0
    }
}

/// What a device sends until its last line is no longer complete: answers, and the telemetry of each finger.
#[derive(Debug, Default, PartialEq)]
struct Received {
    answers: Vec<String>,
    telemetry: [Vec<String>; FINGERS],
}

fn received(device: &mut impl ServedDevice, lines: &[(u64, &str)]) -> Received {
    let stop = AtomicBool::new(false);
    let mut script =
        Script { lines, ms: 0, waiting: Vec::new(), received: Vec::new(), stop: &stop };
    let mut clock = Clock::start(Speed::Max);
    // The clock of a client that is there from the start.
    clock.wait_for_next_ms(true);
    serve(device, &mut script, &mut clock, &stop).expect("a device that runs");
    let text = String::from_utf8(script.received).expect("ASCII");
    let mut received = Received::default();
    for line in text.lines() {
        let address = line.strip_prefix('@').and_then(|line| line.split_once(' '));
        let (finger, content) = match address {
            Some((digit, content)) => (digit.parse().expect("a finger"), content),
            None => (0_usize, line),
        };
        match content.strip_prefix("T ") {
            // The last lines are on their way.
            Some(telemetry) if tick(telemetry) < END_MS - 20 => {
                received.telemetry[finger].push(telemetry.into());
            }
            Some(_) => {}
            None => received.answers.push(line.into()),
        }
    }
    received
}

fn tick(telemetry: &str) -> u64 {
    let tick = telemetry.split(' ').next();
    tick.and_then(|tick| tick.parse().ok()).expect(telemetry)
}

#[test]
fn a_client_cannot_tell_the_image_from_the_native_engine() {
    let lines = [
        (20, "id\n"),
        (30, "checksum on\n"),
        (40, "material copper*30\n"),
        (50, "law pi*44\n"),
        (55, "arm\n"),
        (60, "arm*7E\n"),
        (70, "checksum off*42\n"),
        (3000, "start\n"),
        (3100, "stream 5\n"),
        (4200, "state\n"),
        (4400, "\n"),
    ];
    let scene = scene();
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    let board = OneFingerBoard::new(&firmware, world(&scene)).expect("the image starts");
    let image = received(&mut OneFinger::new(board, scene.clone()), &lines);
    let native = NativeEngine::new(world(&scene));
    let native = received(&mut OneFinger::new(native, scene.clone()), &lines);
    let begins = [
        "ok thermal-display ",
        "ok*04",
        "ok*04",
        "err checksum 44 is wrong, the line has 43; send the line again*",
        "err checksum missing, the line has 7E; send the line again with it*",
        "ok*04",
        "ok",
        "ok",
        "ok",
        "ok state=contact ",
    ];
    assert_eq!(image.answers.len(), begins.len(), "{:?}", image.answers);
    for (answer, begin) in image.answers.iter().zip(begins) {
        assert!(answer.starts_with(begin), "{answer}");
    }
    assert!(image.telemetry[0].len() > 350);
    assert_eq!(image, native);
}

#[test]
fn a_client_cannot_tell_five_fingers_of_the_image_from_those_of_the_native_engine() {
    let lines = [
        (20, "id\n"),
        (30, "material granite\n"),
        (40, "@2 material copper\n"),
        (50, "@7 state\n"),
        (60, "arm\n"),
        (3000, "start\n"),
        (3100, "@1 stream 10\n"),
        (3103, "@2 stream 10\n"),
        (4200, "@2 state\n"),
        (4210, "@4 abort\n"),
        (4220, "@4 state\n"),
        (4400, "\n"),
    ];
    let scenes = scenes_of_five_fingers(&scene());
    let worlds = || scenes.each_ref().map(world);
    let elf = stm32_emulator::build(FINGERS).expect("the image builds");
    let firmware = Firmware::from_file(&elf).expect("an image for this chip");
    let board = FiveFingerBoard::new(&firmware, worlds()).expect("the image starts");
    let image = received(&mut FiveFingers::new(board, scenes.clone()), &lines);
    let native = NativeFiveFingers::new(worlds());
    let native = received(&mut FiveFingers::new(native, scenes.clone()), &lines);
    let begins = [
        "ok thermal-display 0.2.0 fingers=5 ",
        "ok",
        "@2 ok",
        "err unknown finger '7' after @; known: 0 to 4",
        "ok",
        "ok",
        "@1 ok",
        "@2 ok",
        "@2 ok state=contact fault=- material=copper ",
        "@4 ok",
        "@4 ok state=ready fault=- material=granite ",
    ];
    assert_eq!(image.answers.len(), begins.len(), "{:?}", image.answers);
    for (answer, begin) in image.answers.iter().zip(begins) {
        assert!(answer.starts_with(begin), "{answer}");
    }
    assert!(image.telemetry[1].len() > 150 && image.telemetry[2].len() > 150);
    assert_eq!(image, native);
}
