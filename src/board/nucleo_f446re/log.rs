//! What goes into the log besides what the tasks say.

use core::sync::atomic::{AtomicU32, Ordering};

use defmt_rtt as _;

/// Milliseconds since the start, counted by the tick.
static UPTIME_MS: AtomicU32 = AtomicU32::new(0);

defmt::timestamp!("{=u32:ms}", UPTIME_MS.load(Ordering::Relaxed));

/// One more tick has passed.
pub fn count_tick() {
    UPTIME_MS.fetch_add(1, Ordering::Relaxed);
}
