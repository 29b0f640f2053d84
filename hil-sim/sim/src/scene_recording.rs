//! One finger's scene as it goes on: what it changes in the world, and what is kept of it.

use crate::World;
use crate::engine::{Cost, DeviceReset};
use crate::host::Host;
use crate::scene::Scene;
use crate::telemetry::Telemetry;
use crate::trace::{Trace, TraceRow};

/// What a run has given.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the engine that has run it.
    pub engine: &'static str,
    /// One row a millisecond.
    pub trace: Trace,
    /// Every line of the device that is not telemetry, with the time at which it was complete, s.
    pub answers: Vec<(f64, String)>,
    /// Resets of the device after its power-up, at times of the scene: negative while it settles.
    pub resets: Vec<DeviceReset>,
    /// Electrical work that the module has taken up in the scene, J.
    pub electrical_j: f64,
    /// Cost of the scene, without set-up and settling.
    pub cost: Option<Cost>,
    /// Simulated seconds per second of this machine, settling included.
    pub real_time_factor: f64,
}

/// A scene on one finger, from power-up on. Milliseconds count from the finger's first boundary.
pub struct SceneRecording<'a> {
    scene: &'a Scene,
    /// What is sent to the finger.
    pub host: Host,
    /// Millisecond of the scene's time zero, and of its end.
    pub zero_ms: u64,
    pub end_ms: u64,
    trace: Trace,
    answers: Vec<(f64, String)>,
    /// Electrical work that the tile had taken up at the first row and at the last one, J.
    work_j: (f64, f64),
}

impl<'a> SceneRecording<'a> {
    /// The device has these settings; its telemetry comes every `stream_ms`.
    pub fn new(scene: &'a Scene, settings: &[String], stream_ms: u32) -> Self {
        let zero_ms = scene.settle_ms();
        Self {
            scene,
            host: Host::new(scene, settings, stream_ms),
            zero_ms,
            end_ms: zero_ms + (scene.duration_s * 1e3).round() as u64,
            trace: Trace::default(),
            answers: Vec::new(),
            work_j: (0.0, 0.0),
        }
    }

    /// Time of a millisecond in the scene, s.
    fn t_s(&self, ms: u64) -> f64 {
        (ms as f64 - self.zero_ms as f64) / 1e3
    }

    /// Changes what the scene changes at a boundary.
    pub fn change(&self, ms: u64, world: &mut World) {
        let t_s = self.t_s(ms);
        let broken = self.scene.faults.iter().filter_map(|fault| fault.at(t_s));
        world.set_force_and_faults(self.scene.force_n(t_s), broken);
    }

    /// Keeps the state at a boundary within the scene.
    pub fn keep(&mut self, ms: u64, world: &mut World) {
        if !(self.zero_ms..=self.end_ms).contains(&ms) {
            return;
        }
        self.work_j.1 = world.plant().energy().electrical_j;
        if ms == self.zero_ms {
            self.work_j.0 = self.work_j.1;
        }
        let camera = world.camera_reading(ms - self.zero_ms);
        (self.trace).push(ms, TraceRow::capture(self.t_s(ms), world.plant(), camera));
    }

    /// Takes a line of the device; gives it back if it refuses the scene.
    pub fn hear(&mut self, ms: u64, line: String) -> Result<(), String> {
        match Telemetry::parse(&line) {
            Some(telemetry) => self.trace.join(telemetry),
            // Before time zero only set-up is sent.
            None if ms < self.zero_ms && line.starts_with("err") => return Err(line),
            None => self.answers.push((self.t_s(ms + 1), line)),
        }
        Ok(())
    }

    /// What the run has given; resets are counted from the first boundary.
    pub fn outcome(
        self,
        engine: &'static str,
        resets: &[DeviceReset],
        cost: Option<Cost>,
        real_time_factor: f64,
    ) -> Outcome {
        let shift = |reset: &DeviceReset| DeviceReset {
            t_s: reset.t_s - self.zero_ms as f64 / 1e3,
            ..*reset
        };
        Outcome {
            engine,
            resets: resets.iter().map(shift).collect(),
            trace: self.trace,
            answers: self.answers,
            electrical_j: self.work_j.1 - self.work_j.0,
            cost,
            real_time_factor,
        }
    }
}
