//! The scene of one finger during a run: its changes to the world, and the recording of trace and answers.

use crate::World;
use crate::engine::{Cost, DeviceReset};
use crate::host::Host;
use crate::scene::Scene;
use crate::telemetry::Telemetry;
use crate::trace::{Trace, TraceRow};

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the engine.
    pub engine: &'static str,
    /// One row per millisecond.
    pub trace: Trace,
    /// Every line of the device except telemetry, with the time of its completion, s.
    pub answers: Vec<(f64, String)>,
    /// Resets of the device after power-up; times before time zero are negative.
    pub resets: Vec<DeviceReset>,
    /// Electrical energy taken up by the module during the scene, J.
    pub electrical_j: f64,
    /// Computing cost of the scene without set-up and settling.
    pub cost: Option<Cost>,
    /// Simulated time divided by run time, including settling.
    pub real_time_factor: f64,
}

/// A scene on one finger from power-up on. Milliseconds count from the first boundary of the finger.
pub struct SceneRecording<'a> {
    scene: &'a Scene,
    /// Lines sent to the finger.
    pub host: Host,
    /// Times of the scene's time zero and of its end, ms.
    pub zero_ms: u64,
    pub end_ms: u64,
    trace: Trace,
    answers: Vec<(f64, String)>,
    /// Electrical energy that the tile had taken up at the first row and at the last one, J.
    energy_j: (f64, f64),
}

impl<'a> SceneRecording<'a> {
    /// Prepares the scene for a device with these settings that sends telemetry every `stream_ms`, and whose set-up begins
    /// `set_up_from_ms` after its start.
    pub fn new(scene: &'a Scene, settings: &[String], stream_ms: u32, set_up_from_ms: u64) -> Self {
        let zero_ms = scene.settle_ms();
        Self {
            scene,
            host: Host::new(scene, settings, stream_ms, set_up_from_ms),
            zero_ms,
            end_ms: zero_ms + (scene.duration_s * 1e3).round() as u64,
            trace: Trace::default(),
            answers: Vec::new(),
            energy_j: (0.0, 0.0),
        }
    }

    /// Scene time of a millisecond, s.
    fn t_s(&self, ms: u64) -> f64 {
        (ms as f64 - self.zero_ms as f64) / 1e3
    }

    /// Applies force and faults of the scene at a boundary.
    pub fn apply_scene(&self, ms: u64, world: &mut World) {
        let t_s = self.t_s(ms);
        let faults = self.scene.faults.iter().filter_map(|fault| fault.at(t_s));
        world.set_force_and_faults(self.scene.force_n(t_s), faults);
    }

    /// Records the state at a boundary within the scene.
    pub fn record(&mut self, ms: u64, world: &mut World) {
        if !(self.zero_ms..=self.end_ms).contains(&ms) {
            return;
        }
        self.energy_j.1 = world.plant().energy().electrical_j;
        if ms == self.zero_ms {
            self.energy_j.0 = self.energy_j.1;
        }
        let camera = world.camera_reading(ms - self.zero_ms);
        (self.trace).push(ms, TraceRow::capture(self.t_s(ms), world.plant(), camera));
    }

    /// Records a line of the device; returns it as an error if the device refuses the scene.
    pub fn receive(&mut self, ms: u64, line: String) -> Result<(), String> {
        match Telemetry::parse(&line) {
            Some(telemetry) => self.trace.attach_telemetry(telemetry),
            // Before time zero only set-up is sent.
            None if ms < self.zero_ms && line.starts_with("err") => return Err(line),
            None => self.answers.push((self.t_s(ms + 1), line)),
        }
        Ok(())
    }

    /// Result of the run; the times of `resets` count from the first boundary.
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
            electrical_j: self.energy_j.1 - self.energy_j.0,
            cost,
            real_time_factor,
        }
    }
}
