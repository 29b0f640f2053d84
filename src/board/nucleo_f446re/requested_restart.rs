//! A restart that the program requests and that is no fault.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::SCB;

/// Value of [`REQUESTED`] from the request on until the next start. After power-up the RAM is unlikely
/// to hold it by chance, and a reset by the program does not follow a power-up.
const REQUESTED_MAGIC: u32 = 0x7265_7374;

// SAFETY: the start-up code does not initialise the section, which holds nothing else; all bit
// patterns are valid.
#[unsafe(link_section = ".uninit.restart")]
static REQUESTED: AtomicU32 = AtomicU32::new(0);

/// Resets the device. The next start does not take this reset for a fault.
pub fn restart() -> ! {
    REQUESTED.store(REQUESTED_MAGIC, Ordering::Relaxed);
    SCB::sys_reset()
}

/// Whether the last reset was requested by [`restart`]. True once: the request is erased.
pub fn was_requested() -> bool {
    REQUESTED.swap(0, Ordering::Relaxed) == REQUESTED_MAGIC
}
