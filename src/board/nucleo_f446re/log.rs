//! What goes into the log besides what the tasks say.

use core::sync::atomic::{AtomicU32, Ordering};

use defmt_rtt as _;
use stm32f4xx_hal::pac::RCC;

/// Milliseconds since the start, counted by the tick.
static UPTIME_MS: AtomicU32 = AtomicU32::new(0);

defmt::timestamp!("{=u32:ms}", UPTIME_MS.load(Ordering::Relaxed));

/// One more tick has passed.
pub fn count_tick() {
    UPTIME_MS.fetch_add(1, Ordering::Relaxed);
}

/// Logs why the processor started, and clears the flags that tell.
pub fn reset_cause(rcc: &RCC) {
    let flags = rcc.csr().read();
    // The reset pin is pulled by every other cause, power-on sets the brown-out flag too: most special first.
    let cause = if flags.wwdgrstf().bit_is_set() {
        "window watchdog"
    } else if flags.wdgrstf().bit_is_set() {
        "watchdog"
    } else if flags.sftrstf().bit_is_set() {
        "software"
    } else if flags.porrstf().bit_is_set() {
        "power-on"
    } else if flags.borrstf().bit_is_set() {
        "brown-out"
    } else if flags.padrstf().bit_is_set() {
        "reset pin"
    } else {
        "other"
    };
    defmt::info!(
        "start after reset: {=str} (RCC_CSR {=u32:#x})",
        cause,
        flags.bits()
    );
    rcc.csr().modify(|_, w| w.rmvf().clear());
}
