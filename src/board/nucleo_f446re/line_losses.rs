//! Counters of what was lost on the serial line since the start. Each wraps around after 2^32.

use core::sync::atomic::{AtomicU32, Ordering};

/// Number of losses of one kind.
pub struct LossCounter(AtomicU32);

impl LossCounter {
    const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// Counts one loss.
    pub fn count(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// Number of losses since the start.
    pub fn total(&self) -> u32 {
        self.0.load(Ordering::Relaxed)
    }
}

/// Received bytes that were lost because the byte before them had not been fetched in time.
pub static OVERRUNS: LossCounter = LossCounter::new();
/// Received bytes without a valid stop bit: another bit rate, or a break.
pub static FRAMING_ERRORS: LossCounter = LossCounter::new();
/// Received bytes with a bit whose three samples differ.
pub static NOISY_BYTES: LossCounter = LossCounter::new();
/// Lines of telemetry that were dropped because the line to the host was too slow.
pub static DROPPED_TELEMETRY: LossCounter = LossCounter::new();
