//! The scene of one finger during a run: its changes to the world, and the recording of trace and answers.

use thermal_client::client::Telemetry;

use crate::World;
use crate::engine::{Cost, DeviceReset};
use crate::host::Host;
use crate::scene::Scene;
use crate::speed::RunClock;
use crate::trace::{Trace, TraceRow};

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the engine.
    pub engine: &'static str,
    /// One row per millisecond.
    pub trace: Trace,
    /// Lines of events, `E …`, with the time of their completion, s.
    pub events: Vec<(f64, String)>,
    /// Every other line of the device except telemetry, with the time of its completion, s.
    pub answers: Vec<(f64, String)>,
    /// Every line to the device that is not blank, with the time at which it was sent, s.
    pub sent: Vec<(f64, String)>,
    /// Resets of the device after power-up; times before time zero are negative.
    pub resets: Vec<DeviceReset>,
    /// Electrical energy taken up by the module during the scene, J.
    pub electrical_j: f64,
    /// Computing cost of the scene without set-up and settling.
    pub cost: Option<Cost>,
    /// When the run began and ended.
    pub clock: RunClock,
}

/// An answer of the device, and what it answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exchange<'a> {
    /// Time at which the answer was complete, s.
    pub t_s: f64,
    /// The line that was sent; none is known for an answer that follows no line.
    pub line: Option<&'a str>,
    /// The answer.
    pub answer: &'a str,
}

impl Outcome {
    /// The answers with the lines that they answer: each line gets one, in order. A reset loses the lines that wait, except
    /// that `save` and `forget` restart the device and are answered then.
    pub fn exchanges(&self) -> Vec<Exchange<'_>> {
        let mut waiting = self.sent.iter().peekable();
        let mut exchanges = Vec::new();
        for (t_s, answer) in &self.answers {
            let reset = self.resets.iter().rfind(|reset| reset.t_s <= *t_s);
            let lost = |(sent_s, line): &(f64, String)| {
                reset.is_some_and(|reset| *sent_s <= reset.t_s)
                    && !matches!(line.as_str(), "save" | "forget")
            };
            while waiting.next_if(|sent| lost(sent)).is_some() {}
            let sent = waiting.next_if(|(sent_s, _)| sent_s <= t_s);
            exchanges.push(Exchange {
                t_s: *t_s,
                line: sent.map(|(_, line)| line.as_str()),
                answer,
            });
        }
        exchanges
    }
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
    events: Vec<(f64, String)>,
    answers: Vec<(f64, String)>,
    sent: Vec<(f64, String)>,
    /// Electrical energy that the tile had taken up at the first row and at the last one, J.
    energy_j: (f64, f64),
}

impl<'a> SceneRecording<'a> {
    /// Prepares the scene for a device with these settings that sends telemetry every `stream_ms`, and whose set-up begins
    /// `set_up_from_ms` after its start.
    pub fn new(scene: &'a Scene, settings: &[String], stream_ms: u32, set_up_from_ms: u64) -> Self {
        let zero_ms = scene.settle_ms();
        let scene_ms = (scene.duration_s * 1e3).round() as u64;
        Self {
            scene,
            host: Host::new(scene, settings, stream_ms, set_up_from_ms),
            zero_ms,
            end_ms: zero_ms + scene_ms,
            trace: Trace::with_capacity(scene_ms as usize + 1),
            events: Vec::new(),
            answers: Vec::new(),
            sent: Vec::new(),
            energy_j: (0.0, 0.0),
        }
    }

    /// Scene time of a millisecond, s.
    fn t_s(&self, ms: u64) -> f64 {
        (ms as f64 - self.zero_ms as f64) / 1e3
    }

    /// The bytes that the host sends at a half millisecond, if any.
    pub fn send(&mut self, half_ms: u64) -> Option<&[u8]> {
        let t_s = self.t_s(0) + half_ms as f64 / 2e3;
        let bytes = self.host.send(half_ms)?;
        let lines = bytes.split(|byte| *byte == b'\n');
        let lines = lines.map(|line| String::from_utf8_lossy(line).into_owned());
        self.sent.extend((lines.filter(|line| !line.trim().is_empty())).map(|line| (t_s, line)));
        Some(bytes)
    }

    /// Applies force and faults of the scene at a boundary.
    pub fn apply_scene(&self, ms: u64, world: &mut World) {
        world.apply_scene(self.scene, self.t_s(ms));
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
            None if line.starts_with("E ") => self.events.push((self.t_s(ms + 1), line)),
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
        clock: RunClock,
    ) -> Outcome {
        let shift = |reset: &DeviceReset| DeviceReset {
            t_s: reset.t_s - self.zero_ms as f64 / 1e3,
            ..*reset
        };
        Outcome {
            engine,
            resets: resets.iter().map(shift).collect(),
            trace: self.trace,
            events: self.events,
            answers: self.answers,
            sent: self.sent,
            electrical_j: self.energy_j.1 - self.energy_j.0,
            cost,
            clock,
        }
    }
}
