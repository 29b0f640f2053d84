//! What each kind of fault does to the plant, the comparator, the device and the host.

mod comparator;
mod cooling;
mod device;
mod electrics;
mod host;
mod sensors;

use std::path::Path;

use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::sensors::Channel;
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::run::Outcome;
use thermal_sim::scene::{ActiveFault, FaultKind, Scene, Sensor};

const HEAD: &str = "duration_s = 20\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\n";
/// Neither noise nor non-linearity, self-heating nor leads; a driver that does not trip where the tests drive it.
const IDEAL: &str = "[plant]\nsensors.converter.noise_counts = 0\nsensors.converter.inl_counts = 0\n\
    sensors.reference.excitation_duty = 0\nsensors.display.lead_share = 0\nsensors.check.lead_share = 0\n\
    sensors.sink.lead_share = 0\nsensors.skin.lead_share = 0\nbridge.trip_a = 40\n";

const OFF: BridgeOutputs = BridgeOutputs { a: Leg::Off, b: Leg::Off, enabled: false };

fn scene(tables: &str) -> Scene {
    let text = format!("{HEAD}{tables}");
    Scene::parse(&text, Path::new("test scene")).unwrap_or_else(|error| panic!("{error}"))
}

const TOUCH: &str = "[[force]]\nt_s = 0.5\nforce_n = 2\n";

/// A run under a finger, natively.
fn ran(tables: &str) -> (Scene, Outcome) {
    let scene = scene(&format!("{TOUCH}{tables}"));
    let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
    let outcome =
        thermal_sim::run::run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
    (scene, outcome)
}

/// A world without errors of its sensors, at rest at 24 deg C, with its supply connected.
fn ideal() -> World {
    connected(IDEAL)
}

/// A world with its supply connected.
fn connected(tables: &str) -> World {
    let mut world = World::new(&scene(tables)).expect("a plant for the scene");
    world.connect_supply();
    world
}

fn driven(a: f64, b: f64) -> BridgeOutputs {
    BridgeOutputs { a: Leg::Duty(a), b: Leg::Duty(b), enabled: true }
}

fn broken(kind: FaultKind, value: f64) -> ActiveFault {
    ActiveFault { value, ..kind.into() }
}

fn of(kind: FaultKind, sensor: Sensor, value: f64) -> ActiveFault {
    ActiveFault { sensor, ..broken(kind, value) }
}

/// Lets time pass in milliseconds with the finger lifted, things broken, and the legs held.
fn run(world: &mut World, ms: u32, legs: BridgeOutputs, all: &[ActiveFault]) {
    world.set_force_and_faults(0.0, all.iter().copied());
    for _ in 0..ms {
        world.step(legs);
        codes(world);
    }
}

/// The codes of the last scan of a tick.
fn codes(world: &mut World) -> [u16; Channel::ALL.len()] {
    let mut codes = [0; Channel::ALL.len()];
    for _ in 0..16 {
        codes = Channel::ALL.map(|channel| world.convert(channel));
    }
    codes
}
