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
use crate::recording::Recording;
use crate::run::{Outcome, RunError};
use crate::scene::Scene;
use thermal_plant::bridge::BridgeOutputs;

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
    fn legs(&mut self, finger: usize) -> BridgeOutputs;

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
    let mut fingers: [_; FINGERS] =
        std::array::from_fn(|finger| Recording::new(&scenes[finger], &settings[finger], STREAM_MS));
    let last = |of: fn(&Recording<'_>) -> u64| fingers.iter().map(of).max().unwrap_or(0);
    let zero_ms = last(|finger| finger.zero_ms);
    let last_ms = last(|finger| finger.end_ms) + DRAIN_MS;
    for ms in 0..=last_ms {
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
            // To each finger a millisecond later than to the one before it.
            let since_ms = its_ms.and_then(|ms| ms.checked_sub(before as u64));
            if let Some(line) = since_ms.and_then(|ms| fingers[before].host.send(2 * ms + 1)) {
                hand.send(before, line);
            }
            let legs = hand.legs(index);
            let world = hand.world(index);
            fingers[index].change(ms, world);
            fingers[index].keep(ms, world);
            world.step(legs);
        }
        for (index, line) in hand.receive() {
            (fingers[index].hear(ms, line))
                .map_err(|line| RunError::Refused(format!("finger {index}: {line}")))?;
        }
        progress(ms as f64 / last_ms as f64);
    }
    let real_time_factor = last_ms as f64 * 1e-3 / began.elapsed().as_secs_f64();
    let (cost, resets) = (hand.cost(), hand.resets());
    Ok(fingers.map(|finger| finger.outcome(H::NAME, &resets, cost, real_time_factor)))
}
