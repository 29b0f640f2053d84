//! Engines run the device: the release image in the emulated microcontroller, or the same logic natively.
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

mod native;

pub use native::{NativeDevice, NativeEngine, NativeFiveFingers};

use thermal_plant::bridge::BridgeOutputs;

pub use thermal_client::link::LineSplitter;

use crate::World;
use crate::processor::{MachineFault, NotInjected, ResetCause};

/// Baud rate of the host, as the board sets it.
pub const BAUD: u64 = 1_000_000;

/// A device with its world.
pub trait Engine {
    /// Why the engine can stop early.
    type Stop: std::error::Error + Send + Sync + 'static;

    /// Name of the engine on the command line.
    const NAME: &'static str;

    /// The world.
    fn world(&mut self) -> &mut World;

    /// The bridge legs as the device drives them now.
    fn legs(&mut self) -> BridgeOutputs;

    /// Runs the device by half a millisecond.
    ///
    /// # Errors
    /// The device did something that is not modelled.
    fn run_half_ms(&mut self) -> Result<(), Self::Stop>;

    /// Sends bytes to the device, starting now.
    fn send(&mut self, bytes: &[u8]);

    /// Appends the bytes received from the device since the last call.
    fn receive(&mut self, into: &mut Vec<u8>);

    /// Injects a fault of the processor `after_us` µs (less than 500) after the start of the present half millisecond. An
    /// engine without a processor injects it at once.
    ///
    /// # Errors
    /// The engine has no such part, or refuses the fault.
    fn inject(&mut self, fault: &MachineFault, after_us: u32) -> Result<(), NotInjected>;

    /// Raises the trigger input `after_us` µs (less than 500) after the start of the present half millisecond, until its end
    /// or until shortly before the next call in it.
    ///
    /// # Errors
    /// The device did something that is not modelled.
    fn trigger(&mut self, after_us: u32) -> Result<(), Self::Stop>;

    /// Resets of the device after power-up, oldest first.
    fn resets(&self) -> Vec<DeviceReset>;

    /// Restarts the measurement of [`Self::cost`].
    fn reset_cost(&mut self) {}

    /// Cost of the device's program; `None` for an engine that does not measure it.
    fn cost(&self) -> Option<Cost> {
        None
    }
}

/// A reset of the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceReset {
    /// Time since the first boundary, s.
    pub t_s: f64,
    /// Its cause.
    pub cause: ResetCause,
}

/// Computing cost of the program, emulated; cycles are estimates.
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
    /// Fraction of the time in which the CPU is not asleep.
    pub load: f64,
    /// Largest stack use, bytes; `None` if the image does not define the end of its stack.
    pub stack_bytes: Option<u32>,
}
