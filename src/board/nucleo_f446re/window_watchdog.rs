//! The window watchdog: resets a device whose tick does not come.

use stm32f4xx_hal::pac::WWDG;
use stm32f4xx_hal::rcc::Rcc;

/// Counts down from here, and resets below 0x40: 64 steps of 4096 * 8 periods of 45 MHz, 46.6 ms (RM0390, 21.4). It
/// stands still with its clock, which is the independent watchdog's part.
const FULL: u8 = 0x7f;

/// The running watchdog; it cannot be stopped.
pub struct WindowWatchdog(WWDG);

impl WindowWatchdog {
    /// Starts it. It may be fed at any time: a tick that comes too early is none of its business.
    pub fn start(wwdg: WWDG, rcc: &mut Rcc) -> Self {
        rcc.apb1enr().modify(|_, w| w.wwdgen().enabled());
        wwdg.cfr().write(|w| {
            w.wdgtb().div8();
            w.w().set(FULL)
        });
        let mut started = Self(wwdg);
        started.feed();
        started
    }

    /// Begins, or begins anew.
    pub fn feed(&mut self) {
        self.0.cr().write(|w| {
            w.t().set(FULL);
            w.wdga().enabled()
        });
    }
}
