//! A whole finger on the native engine: plant, true contact, sensors, converter and the firmware's logic.
use std::hint::black_box;
use std::path::Path;

use anyhow::{Context, bail};
use thermal_client::client::Telemetry;
use thermal_plant::Plant;
use thermal_plant::bridge::BridgeOutputs;
use thermal_sim::World;
use thermal_sim::engine::{Engine, NativeEngine};
use thermal_sim::scene::Scene;

/// Material of the presented object.
pub const OBJECT: &str = "granite";
/// Force of the finger, N.
pub const FORCE_N: f64 = 2.0;
/// Duration of the scene, which sets the depth of the half-spaces, s: that of the demo.
pub const DURATION_S: u32 = 12;

/// Lines of the host and the time at which they are sent, ms.
pub const LINES: [(u64, &str); 5] = [
    (10, "material granite"),
    (13, "object room"),
    (16, "mode contact"),
    (19, "arm"),
    // The device has filtered the skin temperature by then.
    (2600, "start"),
];
/// Time at which the finger lands and the scene begins, ms; the device has settled by then.
pub const LANDING_MS: u64 = 8000;
/// Time from which on run times are measured, ms.
pub const READY_MS: u64 = 9000;
/// Interval of the host's keep-alive lines, ms.
const ALIVE_MS: u64 = 500;
/// Time within which a line is answered and its effect has arrived, ms.
const ANSWER_MS: u64 = 5;

/// A finger on its display.
pub struct Finger {
    engine: NativeEngine,
    received: Vec<u8>,
    /// Milliseconds since switch-on.
    ms: u64,
}

impl Finger {
    /// A finger with its own noise that has been in contact for a second.
    ///
    /// # Errors
    /// The device refused its set-up, or is not in contact.
    pub fn in_contact(seed: u64) -> anyhow::Result<Self> {
        let mut finger = Self::switched_on(seed)?;
        for ms in 0..READY_MS {
            finger.send_lines_of(ms);
            finger.step(force_n(ms));
        }
        finger.check_contact()?;
        Ok(finger)
    }

    /// A finger at switch-on.
    ///
    /// # Errors
    /// None for this scene.
    pub fn switched_on(seed: u64) -> anyhow::Result<Self> {
        let settle_s = LANDING_MS as f64 * 1e-3;
        let text = format!(
            "duration_s = {DURATION_S}\nsettle_s = {settle_s}\nskin_c = 34.0\nroom_c = 24.0\nseed = {seed}\n\
             [object]\nmaterial = \"{OBJECT}\"\n"
        );
        let scene = Scene::parse(&text, Path::new("the benchmark's scene"))?;
        Ok(Self { engine: NativeEngine::new(World::new(&scene)?), received: Vec::new(), ms: 0 })
    }

    /// Sends the lines of a millisecond.
    pub fn send_lines_of(&mut self, ms: u64) {
        for (_, line) in LINES.iter().filter(|(at, _)| *at == ms) {
            self.send(line);
        }
    }

    fn send(&mut self, line: &str) {
        self.engine.send(line.as_bytes());
        self.engine.send(b"\n");
    }

    /// Runs one millisecond: the plant, then the device, as in a simulated run.
    pub fn step(&mut self, force_n: f64) {
        if self.ms.is_multiple_of(ALIVE_MS) {
            self.engine.send(b"\n");
        }
        self.ms += 1;
        self.engine.world().set_force_and_faults(force_n, std::iter::empty());
        let legs = self.engine.legs();
        self.engine.world().step(legs);
        let Ok(()) = self.engine.run_half_ms();
        let Ok(()) = self.engine.run_half_ms();
    }

    /// The present state of the plant.
    pub fn plant(&mut self) -> Plant {
        self.engine.world().plant().clone()
    }

    /// Whether the bridge reports a fault.
    pub fn fault(&mut self) -> bool {
        self.engine.world().bridge_fault()
    }

    /// The present state of the bridge's legs.
    pub fn legs(&mut self) -> BridgeOutputs {
        self.engine.legs()
    }

    /// Requests telemetry of every tick.
    pub fn stream(&mut self) {
        self.send("stream 1");
        for _ in 0..ANSWER_MS {
            self.step(FORCE_N);
        }
        self.received.clear();
        self.engine.receive(&mut self.received);
    }

    /// Runs one millisecond and returns the telemetry of its tick.
    ///
    /// # Errors
    /// The device sent a line other than telemetry.
    pub fn step_and_listen(&mut self) -> anyhow::Result<()> {
        self.step(FORCE_N);
        self.received.clear();
        self.engine.receive(&mut self.received);
        for line in String::from_utf8_lossy(&self.received).lines() {
            black_box(Telemetry::parse(line).with_context(|| format!("{line:?} is no telemetry"))?);
        }
        Ok(())
    }

    /// Checks that the device has accepted the set-up and is in contact.
    ///
    /// # Errors
    /// The device refused a line or is not in contact.
    pub fn check_contact(&mut self) -> anyhow::Result<()> {
        self.send("stream 1");
        for _ in 0..ANSWER_MS {
            self.step(FORCE_N);
        }
        self.send("stream 0");
        for _ in 0..ANSWER_MS {
            self.step(FORCE_N);
        }
        self.received.clear();
        self.engine.receive(&mut self.received);
        let text = String::from_utf8_lossy(&self.received);
        if let Some(refused) = text.lines().find(|line| line.starts_with("err")) {
            bail!("the device refused its set-up: {refused}");
        }
        let last = text.lines().filter_map(Telemetry::parse).next_back();
        match last {
            Some(telemetry) if telemetry.state.name() == "contact" => Ok(()),
            other => bail!("the device is not in contact: {other:?}"),
        }
    }
}

/// Force at a time of the set-up, N.
pub fn force_n(ms: u64) -> f64 {
    if ms < LANDING_MS { 0.0 } else { FORCE_N }
}
