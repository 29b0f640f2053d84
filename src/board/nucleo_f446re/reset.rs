//! The cause of the last reset, from the flags of the reset and clock controller.

use stm32f4xx_hal::pac::RCC;
use thermal_display::device::safety::Fault;

/// Cause of a reset (RM0390, 6.3.21).
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Reset {
    /// The supply was switched on; the content of the RAM is arbitrary.
    PowerOn,
    /// The window watchdog: the control tick did not run.
    WindowWatchdog,
    /// The independent watchdog: a task did not check in, or a handler of a fatal error waited for
    /// the reset.
    Watchdog,
    /// The program requested the reset, to store settings or after a fatal error.
    Software,
    /// The supply voltage was too low; the RAM has kept its content.
    BrownOut,
    /// The reset pin was pulled low, by the button or by the debug probe.
    Pin,
    /// A reset on entry to a low-power mode, which the firmware never requests.
    Other,
}

impl Reset {
    /// Reads the reset flags, which accumulate until they are [cleared](Self::clear).
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

    /// Clears the reset flags, so that the next reset is told from this one.
    pub fn clear(rcc: &RCC) {
        rcc.csr().modify(|_, w| w.rmvf().clear());
    }

    /// The fault that this reset indicates; `None` if it was requested by the user, by the probe or
    /// by the host, or caused by the supply.
    pub const fn fault(self, restart_is_planned: bool) -> Option<Fault> {
        match self {
            Self::WindowWatchdog => Some(Fault::TickLost),
            Self::Watchdog => Some(Fault::Watchdog),
            Self::Software if restart_is_planned => None,
            Self::Software | Self::Other => Some(Fault::UnaskedReset),
            Self::PowerOn | Self::BrownOut | Self::Pin => None,
        }
    }
}
