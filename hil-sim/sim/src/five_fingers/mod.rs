//! Five fingers on one device, each with its own plant and scene.
//!
//! # Time
//! The device serves its fingers in turn, 0.2 ms apart, so each finger has millisecond boundaries of its own: between
//! the fourth and the fifth of its 16 scans, as those of the one-finger engines are. The simulated sensors move by a
//! sixteenth of a millisecond's change from scan to scan, though the scans of a finger take 0.18 ms only: a plant gets
//! the same as on the one-finger board, and the device reads its sensors 0.4 ms older than they would be.
//!
//! A line to a finger is sent right after that finger's tick. Lines to later fingers follow one millisecond each later,
//! because at 1 Mbaud they would delay each other. The fingers are set up one after the other, because the device takes
//! up to a millisecond for some lines, and keeps one upload.

mod runner;

use std::time::Instant;

pub use crate::engine::NativeFiveFingers;
pub use runner::{FiveFingerRunner, run_scenes_on};

use crate::World;
use crate::commissioning;
use crate::engine::{Cost, DeviceReset, LineSplitter};
use crate::host::SET_UP_FROM_MS;
use crate::processor::{Injection, MachineFault, NotInjected};
use crate::run::{Outcome, RunError};
use crate::scene::Scene;
use crate::scene_recording::SceneRecording;
use crate::speed::RunClock;
use crate::trigger_edges::TriggerEdges;
use thermal_plant::bridge::BridgeOutputs;

/// Number of fingers of the device.
pub const FINGERS: usize = 5;

/// Interval of each finger's telemetry, ms: five lines of 100 bytes every millisecond would not fit 1 Mbaud.
pub const STREAM_MS: u32 = 10;
/// Time for the telemetry of the last row to arrive, ms.
const DRAIN_MS: u64 = 10;

/// A device for five fingers with their worlds.
pub trait FiveFingerEngine {
    /// Why the engine can stop early.
    type Stop: std::error::Error + Send + Sync + 'static;

    /// Name of the engine on the command line.
    const NAME: &'static str;

    /// Runs the device to the next boundary of a finger; the fingers take turns.
    ///
    /// # Errors
    /// The device did something that is not modelled.
    fn run_to(&mut self, finger: usize) -> Result<(), Self::Stop>;

    /// A finger's world.
    fn world(&mut self, finger: usize) -> &mut World;

    /// The legs of a finger's bridge as the device drives them now.
    fn legs(&mut self, finger: usize) -> BridgeOutputs;

    /// Sends bytes to the device, starting now.
    fn send(&mut self, bytes: &[u8]);

    /// Appends the bytes received from the device since the last call.
    fn receive(&mut self, into: &mut Vec<u8>);

    /// Injects a fault of the processor, which all fingers share, or of a select line of the multiplexers.
    ///
    /// # Errors
    /// The fault does not apply to the engine, or its machine refuses it.
    fn inject(&mut self, fault: &MachineFault) -> Result<(), NotInjected>;

    /// Raises the trigger input now, until the next boundary.
    ///
    /// # Errors
    /// The device did something that is not modelled.
    fn trigger(&mut self) -> Result<(), Self::Stop>;

    /// Resets of the device after power-up; time counts from the first finger's first boundary.
    fn resets(&self) -> Vec<DeviceReset>;

    /// Restarts the measurement of [`Self::cost`].
    fn reset_cost(&mut self) {}

    /// Cost of one finger's tick and CPU load of all fingers; `None` for an engine that does not measure it.
    fn cost(&self) -> Option<Cost> {
        None
    }
}

/// Runs a scene on each finger and returns their results; `progress` is called with the fraction done. Faults of the
/// processor in any of the scenes are injected into the one that all fingers share, and edges of their triggers raise the input
/// that all share, at whole milliseconds, before the first finger's boundary.
///
/// # Errors
/// The engine stopped, the device refused a scene, or a fault of the processor could not be injected.
pub fn run<H: FiveFingerEngine>(
    scenes: &[Scene; FINGERS],
    engine: &mut H,
    mut progress: impl FnMut(f64),
) -> Result<[Outcome; FINGERS], RunError<H::Stop>> {
    let began = Instant::now();
    let settings: Vec<_> = (scenes
        .iter()
        .map(|scene| commissioning::settings_for_scene(&scene.on_five_fingers()))
        .collect::<Result<_, _>>())
    .map_err(RunError::Commission)?;
    let enrolled = scenes.iter().map(commissioning::with_person);
    let enrolled: Vec<_> = enrolled.collect::<Result<_, _>>().map_err(RunError::Commission)?;
    let loop_began = Instant::now();
    let mut set_up_from_ms = SET_UP_FROM_MS;
    let mut fingers: [_; FINGERS] = std::array::from_fn(|finger| {
        let (scene, settings) = (&*enrolled[finger], &settings[finger]);
        let recording = SceneRecording::new(scene, settings, STREAM_MS, set_up_from_ms);
        set_up_from_ms = recording.host.set_up_ms();
        recording
    });
    let last = |of: fn(&SceneRecording<'_>) -> u64| fingers.iter().map(of).max().unwrap_or(0);
    let zero_ms = last(|finger| finger.zero_ms);
    let end_ms = last(|finger| finger.end_ms);
    let last_ms = end_ms + DRAIN_MS;
    let injections = injections(scenes, zero_ms, end_ms)?;
    let mut edges = scenes.each_ref().map(|_| TriggerEdges::new(-1000 * zero_ms as i64 - 500));
    let mut received = LineSplitter::default();
    for ms in 0..=last_ms {
        if ms == zero_ms {
            engine.reset_cost();
        }
        for (_, fault) in injections.iter().filter(|(at_ms, _)| *at_ms == ms) {
            engine.inject(fault)?;
        }
        if is_triggered(scenes, &mut edges, ms as i64 - zero_ms as i64) {
            engine.trigger().map_err(RunError::Stop)?;
        }
        for index in 0..FINGERS {
            engine.run_to(index).map_err(RunError::Stop)?;
            // The tick of the previous finger has ended.
            let (previous, previous_ms) = match index.checked_sub(1) {
                Some(previous) => (previous, Some(ms)),
                None => (FINGERS - 1, ms.checked_sub(1)),
            };
            // Each finger is sent its lines a millisecond later than the previous one.
            let finger_ms = previous_ms.and_then(|ms| ms.checked_sub(previous as u64));
            if let Some(line) = finger_ms.and_then(|ms| fingers[previous].send(2 * ms + 1)) {
                engine.send(&addressed(previous, line));
            }
            let legs = engine.legs(index);
            let world = engine.world(index);
            fingers[index].apply_scene(ms, world);
            fingers[index].record(ms, world);
            world.step(legs);
        }
        engine.receive(received.received());
        for line in received.complete() {
            let (index, line) = source_finger(line);
            (fingers[index].receive(ms, line))
                .map_err(|line| RunError::Refused(format!("finger {index}: {line}")))?;
        }
        progress(ms as f64 / last_ms as f64);
    }
    let clock = RunClock::at_last_row(began, loop_began, last_ms);
    let (cost, resets) = (engine.cost(), engine.resets());
    Ok(fingers.map(|finger| finger.outcome(H::NAME, &resets, cost, clock)))
}

/// Whether the trigger input that the fingers share has an edge at a millisecond since time zero, of any of their scenes; the edges
/// before it have been asked for.
pub(crate) fn is_triggered(
    scenes: &[Scene; FINGERS],
    edges: &mut [TriggerEdges; FINGERS],
    ms: i64,
) -> bool {
    let mut any = false;
    for (scene, edges) in scenes.iter().zip(edges) {
        // Rounded to milliseconds.
        while edges.next_before(scene, 1000 * ms + 500).is_some() {
            any = true;
        }
    }
    any
}

/// A line to a finger. A blank line has no address.
fn addressed(finger: usize, line: &[u8]) -> Vec<u8> {
    if line == b"\n" {
        return line.into();
    }
    [format!("@{finger} ").as_bytes(), line].concat()
}

/// The finger that has sent a line, and the line without its address. Lines of the device as a whole are attributed to the first
/// finger.
fn source_finger(line: String) -> (usize, String) {
    let addressed = line.split_at_checked(3);
    match addressed.map(|(address, rest)| (address.as_bytes(), rest)) {
        Some(([b'@', digit @ b'0'..=b'4', b' '], rest)) => {
            (usize::from(digit - b'0'), rest.to_owned())
        }
        _ => (0, line),
    }
}

/// The faults of the processor in all scenes with their times since the start, ms.
fn injections<S: std::error::Error + 'static>(
    scenes: &[Scene; FINGERS],
    zero_ms: u64,
    end_ms: u64,
) -> Result<Vec<(u64, MachineFault)>, RunError<S>> {
    let of_all = scenes.iter().flat_map(|scene| &scene.injections);
    let since_start = |&Injection { t_s, fault }| {
        let ms = (t_s * 1e3).round() + zero_ms as f64;
        if (0.0..=end_ms as f64).contains(&ms) {
            return Ok((ms as u64, fault));
        }
        let time_s = |ms: u64| (ms as f64 - zero_ms as f64) / 1e3;
        Err(RunError::InjectionTime { fault, t_s, from_s: time_s(0), to_s: time_s(end_ms) })
    };
    of_all.map(since_start).collect()
}
