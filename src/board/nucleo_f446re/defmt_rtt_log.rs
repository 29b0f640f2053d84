//! Transport and time stamps of the debug log.

use core::sync::atomic::{AtomicU32, Ordering};

use defmt_rtt as _;

/// Time stamp of the log: milliseconds since the first control tick after the start.
static UPTIME_MS: AtomicU32 = AtomicU32::new(0);

defmt::timestamp!("{=u32:ms}", UPTIME_MS.load(Ordering::Relaxed));

/// Advances the time stamp of the log by one millisecond; called in every control tick of the first
/// finger, and from nowhere else.
pub fn advance_uptime_by_1_ms() {
    let now = UPTIME_MS.load(Ordering::Relaxed);
    UPTIME_MS.store(now.wrapping_add(1), Ordering::Relaxed);
}
