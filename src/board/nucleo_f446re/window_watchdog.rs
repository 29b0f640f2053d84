//! The window watchdog: resets the device when the control tick no longer runs.

use stm32f4xx_hal::pac::WWDG;
use stm32f4xx_hal::rcc::Rcc;

/// Value to which a feeding sets the counter of the window watchdog. The counter counts down and
/// resets the device when it falls below 0x40: after 64 counts of 4096 * 8 periods of 45 MHz, 46.6
/// ms (RM0390, 21.4).
///
/// The counter stops if its clock does; the independent watchdog then resets the device.
const COUNTDOWN_START: u8 = 0x7f;

/// The running window watchdog (WWDG). It resets the device 46.6 ms after the last feeding; its
/// window is always open, so an early feeding is allowed. Once started, only a reset stops it.
pub struct WindowWatchdog(WWDG);

impl WindowWatchdog {
    /// Starts the window watchdog: from now on, a feeding must follow within 46.6 ms. The window is
    /// always open, so a feeding is never too early.
    pub fn start(wwdg: WWDG, rcc: &mut Rcc) -> Self {
        rcc.apb1enr().modify(|_, w| w.wwdgen().enabled());
        // The first writes behind the enabling of a clock can be lost (errata sheet ES0298, 2.2.7).
        cortex_m::asm::dsb();
        wwdg.cfr().write(|w| {
            w.wdgtb().div8();
            w.w().set(COUNTDOWN_START)
        });
        let mut watchdog = Self(wwdg);
        watchdog.feed();
        watchdog
    }

    /// Restarts the countdown of 46.6 ms, at the end of which the window watchdog resets the
    /// device. Called in every control tick that has valid samples.
    pub fn feed(&mut self) {
        self.0.cr().write(|w| {
            w.t().set(COUNTDOWN_START);
            w.wdga().enabled()
        });
    }
}
