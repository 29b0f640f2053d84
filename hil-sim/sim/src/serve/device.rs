//! Devices that can be served, with the scene around them.

use std::path::Path;

use crate::engine::Engine;
use crate::five_fingers::{FINGERS, FiveFingerEngine, is_triggered};
use crate::processor::NotInjected;
use crate::run::{inject_due, raise_trigger};
use crate::scene::{Scene, SceneError};
use crate::trigger_edges::TriggerEdges;

/// Simulated time for which half-spaces are deep enough, s; the longest that a plant can have.
const SERVED_S: f64 = 86_400.0;

/// Half a millisecond, us.
const HALF_MS_US: i64 = 500;

/// What is around a device that is served without a scene: a finger that nobody presses, in a room of 24 C.
const NO_SCENE: &str = "\
duration_s = 1.0
skin_c = 34.0
room_c = 24.0
seed = 1
[object]
material = \"copper\"
";

/// The scene of a file, or a finger that nobody presses, for a device that is served for a day.
///
/// # Errors
/// The scene is wrong.
pub fn read_scene(path: Option<&Path>) -> Result<Scene, SceneError> {
    let mut scene = match path {
        Some(path) => Scene::read(path),
        None => Scene::parse(NO_SCENE, Path::new("the scene without a scene")),
    }?;
    scene.duration_s = SERVED_S;
    Ok(scene)
}

/// The same scene for each of five fingers, with noise of its own.
pub fn scenes_of_five_fingers(scene: &Scene) -> [Scene; FINGERS] {
    std::array::from_fn(|finger| Scene {
        seed: scene.seed.wrapping_add(finger as u64),
        ..scene.on_five_fingers()
    })
}

/// A device that runs by the millisecond.
pub trait ServedDevice {
    /// Why the device can stop early.
    type Stop: std::error::Error + Send + Sync + 'static;

    /// Sends bytes to the device, starting now.
    fn send(&mut self, bytes: &[u8]);

    /// Runs device and plant for a millisecond.
    ///
    /// # Errors
    /// The device did something that is not modelled.
    fn run_1_ms(&mut self) -> Result<(), Self::Stop>;

    /// Appends the bytes that the device has sent since the last call.
    fn receive(&mut self, into: &mut Vec<u8>);
}

/// Why a served device stopped.
#[derive(Debug, thiserror::Error)]
pub enum ServeError<S: std::error::Error + 'static> {
    /// The engine stopped because the device did something that is not modelled.
    #[error(transparent)]
    Stop(S),
    /// A processor fault of the scene could not be injected.
    #[error(transparent)]
    NotInjected(#[from] NotInjected),
}

/// A device with one finger in a scene. Time zero of the scene is its settling time after the device's first boundary, as in
/// [`run`](crate::run::run); the host's lines and faults of the scene are left to the client.
#[derive(Debug)]
pub struct OneFinger<E> {
    engine: E,
    scene: Scene,
    trigger_edges: TriggerEdges,
    ms: u64,
}

impl<E: Engine> OneFinger<E> {
    /// A device that was just powered up in the world of this scene.
    pub fn new(engine: E, scene: Scene) -> Self {
        let trigger_edges = TriggerEdges::new(scene_time_us(&scene, 0));
        Self { engine, scene, trigger_edges, ms: 0 }
    }

    /// What runs the device, for a device that leaves its scene.
    pub fn into_engine(self) -> E {
        self.engine
    }

    /// Raises the trigger input at the scene's times in the half of this millisecond that begins so many us after it.
    fn trigger(&mut self, after_us: i64) -> Result<(), E::Stop> {
        let from_us = scene_time_us(&self.scene, self.ms) + after_us;
        raise_trigger(&mut self.engine, &self.scene, &mut self.trigger_edges, from_us)
    }

    fn inject(&mut self, half: u64, at: impl Fn(u32) -> bool) -> Result<(), NotInjected> {
        let (faults, zero_ms) = (&self.scene.injections, self.scene.settle_ms());
        inject_due(&mut self.engine, faults.iter(), zero_ms, half, at)
    }
}

impl<E: Engine> ServedDevice for OneFinger<E> {
    type Stop = ServeError<E::Stop>;

    fn send(&mut self, bytes: &[u8]) {
        self.engine.send(bytes);
    }

    fn run_1_ms(&mut self) -> Result<(), Self::Stop> {
        let t_s = scene_time_s(&self.scene, self.ms);
        self.engine.world().apply_scene(&self.scene, t_s);
        self.inject(2 * self.ms, |after_us| after_us == 0)?;
        let legs = self.engine.legs();
        self.engine.world().step(legs);
        self.inject(2 * self.ms, |after_us| after_us > 0)?;
        self.trigger(0).map_err(ServeError::Stop)?;
        self.engine.run_half_ms().map_err(ServeError::Stop)?;
        self.inject(2 * self.ms + 1, |_| true)?;
        self.trigger(HALF_MS_US).map_err(ServeError::Stop)?;
        self.engine.run_half_ms().map_err(ServeError::Stop)?;
        self.ms += 1;
        Ok(())
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        self.engine.receive(into);
    }
}

/// A device with five fingers, each in a scene.
#[derive(Debug)]
pub struct FiveFingers<H> {
    engine: H,
    scenes: [Scene; FINGERS],
    trigger_edges: [TriggerEdges; FINGERS],
    ms: u64,
}

impl<H: FiveFingerEngine> FiveFingers<H> {
    /// A device that was just powered up in the worlds of these scenes, whose processor faults are not injected.
    pub fn new(engine: H, scenes: [Scene; FINGERS]) -> Self {
        let trigger_edges =
            scenes.each_ref().map(|scene| TriggerEdges::new(scene_time_us(scene, 0) - HALF_MS_US));
        Self { engine, scenes, trigger_edges, ms: 0 }
    }
}

impl<H: FiveFingerEngine> ServedDevice for FiveFingers<H> {
    type Stop = H::Stop;

    fn send(&mut self, bytes: &[u8]) {
        self.engine.send(bytes);
    }

    fn run_1_ms(&mut self) -> Result<(), H::Stop> {
        let ms = scene_time_us(&self.scenes[0], self.ms) / 1000;
        if is_triggered(&self.scenes, &mut self.trigger_edges, ms) {
            self.engine.trigger()?;
        }
        for (finger, scene) in self.scenes.iter().enumerate() {
            self.engine.run_to(finger)?;
            let legs = self.engine.legs(finger);
            let world = self.engine.world(finger);
            world.apply_scene(scene, scene_time_s(scene, self.ms));
            world.step(legs);
        }
        self.ms += 1;
        Ok(())
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        self.engine.receive(into);
    }
}

/// Time of a scene, s, this many milliseconds after the start of the device.
fn scene_time_s(scene: &Scene, ms: u64) -> f64 {
    (ms as f64 - scene.settle_ms() as f64) / 1e3
}

/// The same, us.
fn scene_time_us(scene: &Scene, ms: u64) -> i64 {
    1000 * (ms as i64 - scene.settle_ms() as i64)
}
