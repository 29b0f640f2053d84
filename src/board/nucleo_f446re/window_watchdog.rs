//! The window watchdog: resets the device when the control tick no longer runs.

use stm32f4xx_hal::pac::WWDG;
use stm32f4xx_hal::rcc::Rcc;

/// Value from which the counter counts down; it resets the device below 0x40. These 64 counts of
/// 4096 * 8 periods of 45 MHz take 46.6 ms (RM0390, 21.4).
///
/// The counter stops if its clock does; the independent watchdog then resets the device.
const START_COUNT: u8 = 0x7f;

/// The started window watchdog (WWDG). It resets the device 46.6 ms after the last feeding; its window
/// is always open, so an early feeding is allowed. Once started, only a reset stops it.
pub struct WindowWatchdog(WWDG);

impl WindowWatchdog {
    /// Starts the watchdog, with a window that is always open: it resets the device if a feeding is
    /// late, never if it is early.
    pub fn start(wwdg: WWDG, rcc: &mut Rcc) -> Self {
        rcc.apb1enr().modify(|_, w| w.wwdgen().enabled());
        wwdg.cfr().write(|w| {
            w.wdgtb().div8();
            w.w().set(START_COUNT)
        });
        let mut watchdog = Self(wwdg);
        watchdog.feed();
        watchdog
    }

    /// Restarts the countdown of 46.6 ms; the first call, by the first control tick, starts it.
    pub fn feed(&mut self) {
        self.0.cr().write(|w| {
            w.t().set(START_COUNT);
            w.wdga().enabled()
        });
    }
}
