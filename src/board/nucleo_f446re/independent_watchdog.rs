//! The independent watchdog: resets the device when a task no longer checks in.

use stm32f4xx_hal::pac::IWDG;

/// Counts of the independent watchdog from a feeding to the reset: 100 ms at the nominal rate of 1
/// kHz.
///
/// The watchdog's oscillator runs at 17 to 47 kHz (datasheet, LSI), so the reset comes after 68 to
/// 188 ms. 68 ms is far above the few milliseconds between two feedings. In 188 ms, full drive
/// changes the display's temperature by a few kelvin; an independent comparator monitors that
/// temperature.
const TIMEOUT_COUNTS: u16 = 100;

/// Starts the counter of the independent watchdog with the period that its registers hold. Before
/// [`IndependentWatchdog::start`] has set them, that is their reset value, 4096 counts of 4 periods
/// of the watchdog's oscillator: 0.35 to 0.96 s. Also for handlers of errors that occur so early.
pub fn start_counter() {
    // SAFETY: one store of a key that starts the watchdog and has no other effect, whatever else
    // accesses the register.
    unsafe { &*IWDG::ptr() }.kr().write(|w| w.key().start());
}

/// The running independent watchdog (IWDG). Only a reset stops it. It also counts while a debugger
/// halts the core, and then resets the device, because a halted core does not control the bridges.
pub struct IndependentWatchdog(IWDG);

impl IndependentWatchdog {
    /// Starts the independent watchdog with its period of 68 to 188 ms, in the order of RM0390,
    /// 20.3.
    ///
    /// The driver of `stm32f4xx-hal` is not used: it starts the counter last and does not wait
    /// until the settings have taken effect, so the period would be 33 s until the first feeding.
    pub fn start(iwdg: IWDG) -> Self {
        start_counter();
        iwdg.kr().write(|w| w.key().unlock());
        iwdg.pr().write(|w| w.pr().divide_by32());
        iwdg.rlr().write(|w| w.rl().set(TIMEOUT_COUNTS - 1));
        // The settings take effect after five periods of the oscillator, 0.3 ms at most. If the
        // oscillator does not run there is no watchdog, and the device must not start: it stays in
        // this loop with the bridges off.
        while iwdg.sr().read().bits() != 0 {}
        let mut watchdog = Self(iwdg);
        watchdog.feed();
        watchdog
    }

    /// Restarts the period of 68 to 188 ms, at the end of which the independent watchdog resets the
    /// device.
    pub fn feed(&mut self) {
        self.0.kr().write(|w| w.key().feed());
    }
}
