//! Why the processor started.

use stm32f4xx_hal::pac::RCC;
use thermal_display::device::safety::Fault;

/// What reset it (RM0390, 6.3.21).
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Reset {
    /// The supply came up; the RAM is noise.
    PowerOn,
    /// The tick did not come.
    WindowWatchdog,
    /// A task did not check in, or the program was at an end.
    Watchdog,
    /// A program asked for it.
    Software,
    /// The supply was low, the RAM has kept what it held.
    BrownOut,
    /// The reset pin was pulled: the button, or the probe.
    Pin,
    /// A low-power mode that no program of this device enters.
    Other,
}

impl Reset {
    /// By the flags since they were last [cleared](Self::clear).
    pub fn of(rcc: &RCC) -> Self {
        let flags = rcc.csr().read();
        // Power-on clears those of before, and sets that of the brown-out too; every reset pulls the pin: most special first.
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

    /// Clears the flags; they gather until then.
    pub fn clear(rcc: &RCC) {
        rcc.csr().modify(|_, w| w.rmvf().clear());
    }

    /// The fault that it is; none where somebody wanted it or the supply did it: the device is then off, as after power-up.
    pub const fn fault(self, is_planned: bool) -> Option<Fault> {
        match self {
            Self::WindowWatchdog => Some(Fault::TickLost),
            Self::Watchdog => Some(Fault::Watchdog),
            Self::Software if is_planned => None,
            Self::Software | Self::Other => Some(Fault::UnaskedReset),
            Self::PowerOn | Self::BrownOut | Self::Pin => None,
        }
    }
}
