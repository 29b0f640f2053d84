//! The independent watchdog: resets the device when a task no longer checks in.

use stm32f4xx_hal::pac::IWDG;

/// Counts from a feeding to the reset; at the nominal count rate of 1 kHz, 100 ms.
///
/// The oscillator runs at 17 to 47 kHz (datasheet, LSI), so the period is 68 to 188 ms. The
/// shortest period is far above the few milliseconds between two feedings. In the longest one, full
/// drive changes the display's temperature by a few kelvin, which its independent comparator
/// monitors.
const PERIOD_COUNTS: u16 = 100;

/// Starts the watchdog with its present period: after a reset, 0.35 to 0.96 s (4 times 4096 periods
/// of its oscillator).
pub fn start() {
    // SAFETY: one store of a key that starts the watchdog and has no other effect, whatever else
    // accesses the register.
    unsafe { &*IWDG::ptr() }.kr().write(|w| w.key().start());
}

/// The running watchdog. It cannot be stopped, and it also runs while a debugger halts the core,
/// because a halted core does not control the bridge.
pub struct Watchdog(IWDG);

impl Watchdog {
    /// Starts the watchdog in the order of RM0390, 20.3.
    ///
    /// The driver of `stm32f4xx-hal` is not used: it starts the counter last and does not wait
    /// until the settings have taken effect, so the period would be 33 s until the first feeding.
    pub fn start(iwdg: IWDG) -> Self {
        start();
        iwdg.kr().write(|w| w.key().unlock());
        iwdg.pr().write(|w| w.pr().divide_by32());
        iwdg.rlr().write(|w| w.rl().set(PERIOD_COUNTS - 1));
        // The settings take effect after five periods of the oscillator, 0.3 ms at most. If the
        // oscillator does not run there is no watchdog, and the device must not start: it stays in
        // this loop with the bridges off.
        while iwdg.sr().read().bits() != 0 {}
        let mut watchdog = Self(iwdg);
        watchdog.feed();
        watchdog
    }

    /// Restarts the period of 68 to 188 ms, after which the watchdog resets the device.
    pub fn feed(&mut self) {
        self.0.kr().write(|w| w.key().feed());
    }
}
