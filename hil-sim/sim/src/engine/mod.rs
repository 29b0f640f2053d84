//! What runs the device: the release image in the emulated microcontroller, or the same logic natively.
//!
//! # Time
//! Boundaries lie at 0.23 ms after the first conversion, modulo 1 ms. At each the plant advances by
//! [`STEP_S`](thermal_plant::STEP_S) under the legs as they are; then the device runs to the next, and its 16 scans see the
//! plant on its way there:
//!
//! ```text
//! ms     0         0.23             0.73        0.94 0.96  1.0       1.23
//!        | scans 0-3 | scans 4-11     | scans 12-15 |tick| | scans 0-3 |
//!                    ^ boundary       (host)                           ^ boundary: the tick's duty counts
//! ```
//!
//! So a duty acts 0.27 ms after its tick; an image whose tick takes longer is off by one step, which the comparison
//! of both engines would show.

mod lines;
mod native;

pub use lines::Lines;
pub use native::Native;

use thermal_plant::bridge::BridgeOutputs;

use crate::World;
use crate::processor::{MachineFault, NotInjected, ResetCause};

/// Baud rate of the host, as the board sets it.
pub const BAUD: u64 = 1_000_000;

/// A device and the world around it.
pub trait Engine {
    /// Why it can stop before its time.
    type Stop: std::error::Error + Send + Sync + 'static;

    /// Name, as the command line has it.
    const NAME: &'static str;

    /// The world.
    fn world(&mut self) -> &mut World;

    /// The bridge's legs, as the device drives them now.
    fn legs(&mut self) -> BridgeOutputs;

    /// Runs the device by half a millisecond.
    ///
    /// # Errors
    /// The device cannot go on.
    fn run_half_ms(&mut self) -> Result<(), Self::Stop>;

    /// Bytes leave the host now, one after the other.
    fn send(&mut self, bytes: &[u8]);

    /// Appends what the host has received since it last asked.
    fn receive(&mut self, into: &mut Vec<u8>);

    /// A fault of the processor happens so long, µs (less than 500), after the present half millisecond's begin. An engine
    /// without a processor has nothing in between: it happens at once.
    ///
    /// # Errors
    /// The engine has no such part, or refuses the fault.
    fn inject(&mut self, fault: &MachineFault, after_us: u32) -> Result<(), NotInjected>;

    /// Resets of the device after its power-up, the oldest first.
    fn resets(&self) -> Vec<DeviceReset>;

    /// Starts the measurement of [`Self::cost`] anew.
    fn reset_cost(&mut self);

    /// What the device's program costs, if the engine knows.
    fn cost(&self) -> Option<Cost>;
}

/// A reset of the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceReset {
    /// Time since the first boundary, s.
    pub t_s: f64,
    /// What caused it.
    pub cause: ResetCause,
}

/// What the program costs, emulated; cycles are estimates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Instructions of one control tick, mean.
    pub instructions_mean: f64,
    /// Instructions of the longest control tick.
    pub instructions_max: u64,
    /// Cycles of one control tick, mean.
    pub cycles_mean: f64,
    /// Cycles of the longest control tick.
    pub cycles_max: u64,
    /// Longest time from the request of a control tick to its first instruction, cycles.
    pub latency_max: u64,
    /// Part of the time in which the CPU does not sleep.
    pub load: f64,
    /// Most of the stack that was ever used, bytes; none if the image does not say where its stack ends.
    pub stack_bytes: Option<u32>,
}
