//! The cause of the last reset, from the flags of the reset and clock controller.

use stm32f4xx_hal::pac::RCC;
use thermal_display::device::safety::Fault;

/// Cause of the last reset, by the flags of the register RCC_CSR (RM0390, 6.3.21).
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum ResetCause {
    /// The supply was switched on; the content of the RAM is arbitrary.
    PowerOn,
    /// Reset by the window watchdog: no control tick with valid samples ran for 46.6 ms, for
    /// example because a handler of a fatal error waited for this reset.
    WindowWatchdog,
    /// Reset by the independent watchdog: it was not fed for 68 to 188 ms, because the tick, host
    /// or idle task did not run, or because a handler of a fatal error waited for the reset while
    /// the window watchdog did not run.
    Watchdog,
    /// A reset by software. The program resets the device only to store settings, or because the
    /// clock has come for which it waited; any other such reset is a fault.
    Software,
    /// The supply voltage was too low; the RAM has kept its content.
    BrownOut,
    /// The reset pin was pulled low, by the button or by the debug probe.
    Pin,
    /// A reset on entry to a low-power mode, which the firmware never requests.
    Other,
}

impl ResetCause {
    /// Reads the cause of the last reset from the reset flags, which accumulate until they are
    /// [cleared](Self::clear_flags). If several flags are set, the first one in this order counts:
    /// power-on, window watchdog, independent watchdog, software, brown-out, low-power mode, pin.
    pub fn read(rcc: &RCC) -> Self {
        let flags = rcc.csr().read();
        // The most specific flag is tested first: power-on sets the flag of the brown-out too, and
        // every reset sets that of the pin.
        if flags.porrstf().bit_is_set() {
            Self::PowerOn
        } else if flags.wwdgrstf().bit_is_set() {
            Self::WindowWatchdog
        } else if flags.wdgrstf().bit_is_set() {
            Self::Watchdog
        } else if flags.sftrstf().bit_is_set() {
            Self::Software
        } else if flags.borrstf().bit_is_set() {
            Self::BrownOut
        } else if flags.lpwrrstf().bit_is_set() {
            Self::Other
        } else {
            Self::Pin
        }
    }

    /// Its name in the answer to `board`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::PowerOn => "power-on",
            Self::WindowWatchdog => "window-watchdog",
            Self::Watchdog => "independent-watchdog",
            Self::Software => "software",
            Self::BrownOut => "brown-out",
            Self::Pin => "reset-pin",
            Self::Other => "low-power",
        }
    }

    /// Clears the reset flags, so that the next start finds only the flags of the next reset.
    pub fn clear_flags(rcc: &RCC) {
        rcc.csr().modify(|_, w| w.rmvf().clear());
    }

    /// The fault that this reset indicates: [`Fault::TickLost`] for the window watchdog,
    /// [`Fault::Watchdog`] for the independent watchdog, [`Fault::UnaskedReset`] for a low-power
    /// reset and for an unplanned reset by software. `None` for a planned one
    /// (`restart_is_planned`), for power-on, brown-out, and a
    /// reset by the pin.
    pub const fn indicated_fault(self, restart_is_planned: bool) -> Option<Fault> {
        match self {
            Self::WindowWatchdog => Some(Fault::TickLost),
            Self::Watchdog => Some(Fault::Watchdog),
            Self::Software if restart_is_planned => None,
            Self::Software | Self::Other => Some(Fault::UnaskedReset),
            Self::PowerOn | Self::BrownOut | Self::Pin => None,
        }
    }
}
