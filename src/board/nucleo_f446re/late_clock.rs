//! A device that has started without the 8 MHz clock of the debug probe waits for it.
//!
//! The probe gives its clock when the host's USB line is plugged in, which may be seconds after the
//! supply. Until then the device runs on its internal oscillator, answers, and is tripped by
//! [`Fault::Clock`](thermal_display::device::safety::Fault::Clock). When the clock has come and has
//! not failed for a second, the device restarts and comes up with the clock.
//!
//! The ready flag alone does not show that the clock goes on, so the clock security system watches
//! it during that second. If it finds a failure, it switches the input of the clock off and raises
//! the non-maskable interrupt; the wait then begins anew.

use stm32f4xx_hal::pac::RCC;

/// Ticks of 1 ms for which the clock must be ready without a failure: longer than plugs bounce.
const STABLE_TICKS: u16 = 1000;

/// Waits for the clock.
#[derive(Default)]
pub struct LateClock {
    stable_ticks: u16,
}

impl LateClock {
    /// Counts a tick of 1 ms. Returns whether the clock has been ready for a second without a
    /// failure, so that the device may restart.
    pub fn count_tick_and_check_stable(&mut self) -> bool {
        // SAFETY: the driver of the clocks has set them up and writes no register any more.
        let rcc = unsafe { RCC::steal() };
        let control = rcc.cr().read();
        if control.hseon().is_on() && control.hserdy().is_ready() {
            if !control.csson().is_on() {
                rcc.cr().modify(|_, w| w.csson().on());
            }
            self.stable_ticks = self.stable_ticks.saturating_add(1);
        } else {
            rcc.cr().modify(|_, w| w.hsebyp().bypassed().hseon().on());
            self.stable_ticks = 0;
        }
        self.stable_ticks >= STABLE_TICKS
    }
}

/// Called by the non-maskable interrupt. If the clock that has failed does not drive the device,
/// because the device still waits for it, acknowledges the failure and returns `true`; the program
/// continues.
pub fn acknowledge_failure_while_waiting() -> bool {
    // SAFETY: the interrupt may come between a load and a store of these registers by
    // `count_tick_and_check_stable`, which then only switches the clock security on once more.
    let rcc = unsafe { RCC::steal() };
    let waits = rcc.pllcfgr().read().pllsrc().is_hsi();
    if waits {
        rcc.cir().write(|w| w.cssc().clear());
        rcc.cr().modify(|_, w| w.csson().off());
    }
    waits
}
