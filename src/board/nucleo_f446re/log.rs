//! Transport and time stamps of the debug log.

use core::sync::atomic::{AtomicU32, Ordering};

use defmt_rtt as _;

/// Time stamp of the log: milliseconds since the control tick began to run.
static UPTIME_MS: AtomicU32 = AtomicU32::new(0);

defmt::timestamp!("{=u32:ms}", UPTIME_MS.load(Ordering::Relaxed));

/// Advances the time stamp of the log by one tick, a millisecond.
pub fn count_tick() {
    UPTIME_MS.fetch_add(1, Ordering::Relaxed);
}
