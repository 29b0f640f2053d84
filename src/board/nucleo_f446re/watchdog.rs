//! The independent watchdog.

use stm32f4xx_hal::pac::IWDG;

/// Periods of the nominal 1 kHz counter until reset: 100 ms nominally.
///
/// The oscillator has 17 to 47 kHz (datasheet, LSI), so it is 68 to 188 ms. The lower bound is far above
/// the few milliseconds between two feedings; in the upper one full drive moves the display by a few
/// degrees, which its independent comparator watches.
const PERIOD: u16 = 100;

/// Lets it run, with the period that it has: 0.35 to 0.96 s as after a reset (4096 times 4 of its oscillator).
pub fn start() {
    // SAFETY: a key that only starts it, in one store, whoever else is at it.
    unsafe { &*IWDG::ptr() }.kr().write(|w| w.key().start());
}

/// The running watchdog; it cannot be stopped, and goes on while a debugger halts the core: halted,
/// nobody controls the bridge.
pub struct Watchdog(IWDG);

impl Watchdog {
    /// Starts it.
    ///
    /// The library's driver starts the counter last and does not wait for its settings to arrive; until the
    /// first feeding the period would be 33 s. This is the order of RM0390, 20.3.
    pub fn start(iwdg: IWDG) -> Self {
        start();
        iwdg.kr().write(|w| w.key().unlock());
        iwdg.pr().write(|w| w.pr().divide_by32());
        iwdg.rlr().write(|w| w.rl().set(PERIOD - 1));
        // Five periods of the oscillator, 0.3 ms at most. If that does not run there is no watchdog, and
        // without one the device must not start: it stays here, with the bridge off.
        while iwdg.sr().read().bits() != 0 {}
        let mut watchdog = Self(iwdg);
        watchdog.feed();
        watchdog
    }

    /// Begins a new period.
    pub fn feed(&mut self) {
        self.0.kr().write(|w| w.key().feed());
    }
}
