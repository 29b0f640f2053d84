//! Five fingers on one device: a plant each, a scene each.
//!
//! # Time
//! The device serves its fingers in turn, 0.2 ms apart, so each finger has millisecond boundaries of its own: between
//! the fourth and the fifth of its 16 scans, as those of the one-finger engines are. The simulated sensors move by a
//! sixteenth of a millisecond's change from scan to scan, though the scans of a finger take 0.18 ms only: a plant sees
//! the same as on the one-finger board, and the device its sensors 0.4 ms older than they would be.
//!
//! A line to a finger leaves right after that finger's tick, and those to later fingers so many milliseconds later: at
//! 1 Mbaud they would be in each other's way.

mod native;

use std::time::Instant;

pub use native::NativeHand;

use crate::World;
use crate::commission;
use crate::engine::{Cost, DeviceReset};
use crate::host::Host;
use crate::run::{Outcome, RunError, broken, in_scene};
use crate::scene::Scene;
use crate::telemetry::Telemetry;
use crate::trace::{Row, Trace};
use thermal_plant::bridge::Legs;

/// Fingers of the device.
pub const FINGERS: usize = 5;

/// Interval of each finger's telemetry, ms: five lines of 100 bytes every millisecond would not fit 1 Mbaud.
const STREAM_MS: u32 = 10;
/// Time after the last row in which its telemetry arrives, ms.
const DRAIN_MS: u64 = 10;

/// A device for five fingers and the worlds around it.
pub trait Hand {
    /// Why it can stop before its time.
    type Stop: std::error::Error + Send + Sync + 'static;

    /// Name of the engine, as the command line has it.
    const NAME: &'static str;

    /// Runs the device to a finger's next boundary. The fingers follow each other in turn.
    ///
    /// # Errors
    /// The device cannot go on.
    fn run_to(&mut self, finger: usize) -> Result<(), Self::Stop>;

    /// A finger's world.
    fn world(&mut self, finger: usize) -> &mut World;

    /// The legs of a finger's bridge, as the device drives them now.
    fn legs(&mut self, finger: usize) -> Legs;

    /// A line to a finger leaves the host, after its tick.
    fn send(&mut self, finger: usize, line: &[u8]);

    /// The complete lines that have come since the last call, and whose they are.
    fn receive(&mut self) -> Vec<(usize, String)>;

    /// Resets of the device after its power-up; time counts from the first finger's first boundary.
    fn resets(&self) -> Vec<DeviceReset>;

    /// Starts the measurement of [`Self::cost`] anew.
    fn reset_cost(&mut self);

    /// What a tick of one finger costs, and the load of all, if the engine knows.
    fn cost(&self) -> Option<Cost>;
}

/// Runs a scene on each finger; `progress` is told the part that is done. Returns what each finger has given.
///
/// # Errors
/// The engine stopped, or the device refused a scene.
pub fn run<H: Hand>(
    scenes: &[Scene; FINGERS],
    hand: &mut H,
    mut progress: impl FnMut(f64),
) -> Result<[Outcome; FINGERS], RunError<H::Stop>> {
    let settings: Vec<_> = (scenes
        .iter()
        .map(commission::of_scene)
        .collect::<Result<_, _>>())
    .map_err(RunError::Commission)?;
    if let Some(injection) = scenes.iter().find_map(|scene| scene.injections.first()) {
        return Err(RunError::Shared(injection.fault));
    }
    let began = Instant::now();
    let mut fingers =
        [0, 1, 2, 3, 4].map(|finger| Finger::new(finger, &scenes[finger], &settings[finger]));
    let last = |of: fn(&Finger<'_>) -> u64| fingers.iter().map(of).max().unwrap_or(0);
    let (zero_ms, end_ms) = (last(|finger| finger.zero_ms), last(|finger| finger.end_ms));
    for ms in 0..=end_ms + DRAIN_MS {
        if ms == zero_ms {
            hand.reset_cost();
        }
        for index in 0..FINGERS {
            hand.run_to(index).map_err(RunError::Stop)?;
            // The tick of the finger before is over.
            let (before, its_ms) = match index.checked_sub(1) {
                Some(before) => (before, Some(ms)),
                None => (FINGERS - 1, ms.checked_sub(1)),
            };
            if let Some(line) = its_ms.and_then(|ms| fingers[before].line(ms)) {
                hand.send(before, &line);
            }
            fingers[index].boundary(ms, hand);
        }
        for (index, line) in hand.receive() {
            fingers[index].hear(ms, line).map_err(RunError::Refused)?;
        }
        progress(ms as f64 / (end_ms + DRAIN_MS) as f64);
    }
    let simulated_s = (end_ms + DRAIN_MS) as f64 * 1e-3;
    let real_time_factor = simulated_s / began.elapsed().as_secs_f64();
    let cost = hand.cost();
    let resets = hand.resets();
    Ok(fingers.map(|finger| Outcome {
        engine: H::NAME,
        resets: in_scene(&resets, finger.zero_ms),
        trace: finger.trace,
        answers: finger.answers,
        electrical_j: finger.spent_j.1 - finger.spent_j.0,
        cost,
        real_time_factor,
    }))
}

/// One finger's scene as it goes on.
struct Finger<'a> {
    index: usize,
    scene: &'a Scene,
    host: Host,
    zero_ms: u64,
    end_ms: u64,
    trace: Trace,
    answers: Vec<(f64, String)>,
    /// What its tile has taken from the bridge before the scene, and with it.
    spent_j: (f64, f64),
}

impl<'a> Finger<'a> {
    fn new(index: usize, scene: &'a Scene, settings: &[String]) -> Self {
        let zero_ms = scene.settle_ms();
        Self {
            index,
            scene,
            host: Host::new(scene, settings, STREAM_MS),
            zero_ms,
            end_ms: zero_ms + (scene.duration_s * 1e3).round() as u64,
            trace: Trace::default(),
            answers: Vec::new(),
            spent_j: (0.0, 0.0),
        }
    }

    fn t_s(&self, ms: u64) -> f64 {
        (ms as f64 - self.zero_ms as f64) / 1e3
    }

    /// The line that leaves in a millisecond, if any.
    fn line(&mut self, ms: u64) -> Option<Vec<u8>> {
        let half_ms = 2 * ms.checked_sub(self.index as u64)? + 1;
        self.host.send(half_ms).map(<[u8]>::to_vec)
    }

    /// What the scene changes at a boundary; then a step of the plant under the legs as they are.
    fn boundary(&mut self, ms: u64, hand: &mut impl Hand) {
        let t_s = self.t_s(ms);
        let legs = hand.legs(self.index);
        let world = hand.world(self.index);
        world.set(self.scene.force_n(t_s), broken(self.scene, t_s));
        if (self.zero_ms..=self.end_ms).contains(&ms) {
            self.spent_j.1 = world.plant().energy().electrical_j;
            if ms == self.zero_ms {
                self.spent_j.0 = self.spent_j.1;
            }
            let camera = world.look(ms - self.zero_ms);
            self.trace.push(ms, Row::now(t_s, world.plant(), camera));
        }
        world.step(legs);
    }

    /// Takes a line of the device; gives it back if it refuses the scene.
    fn hear(&mut self, ms: u64, line: String) -> Result<(), String> {
        match Telemetry::parse(&line) {
            Some(telemetry) => self.trace.join(telemetry),
            // Before time zero only set-up is sent.
            None if ms < self.zero_ms && line.starts_with("err") => {
                return Err(format!("finger {}: {line}", self.index));
            }
            None => self.answers.push((self.t_s(ms + 1), line)),
        }
        Ok(())
    }
}
