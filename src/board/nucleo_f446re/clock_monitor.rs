//! The clock monitor: checks the rate of the ticks and the clock settings.
//!
//! All durations of the device are counted in ticks, which the timer TIM2 generates through two
//! prescalers. A wrong bit in the timer or in a prescaler would scale every duration, and nothing
//! else would fail. SysTick counts the clock of the core, independently of TIM2 and its prescalers,
//! also while the core waits for interrupts, and needs no interrupt of its own. The prescaler of
//! the core's clock acts on both, so its register is compared with the value that was set.
//!
//! The monitor cannot detect a wrong frequency of the 8 MHz oscillator, from which both counters
//! are derived.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use stm32f4xx_hal::pac::RCC;
use thermal_display::device::TICK_HZ;
use thermal_display::device::safety::TickRateMonitor;

use super::sample_error::SampleError;
use super::wiring::FINGERS;

/// Reload value of SysTick: the largest that its 24 bits hold.
const RELOAD: u32 = 0xff_ffff;

/// Compares the ticks with SysTick, and the clock settings with those of the start.
pub struct ClockMonitor {
    tick_rate: TickRateMonitor,
    /// The register RCC_CFGR, as the start has set it.
    clock_settings: u32,
}

/// The register RCC_CFGR: source and prescalers of the clocks.
fn clock_settings() -> u32 {
    // SAFETY: a load without side effects, from a register that is written at the start only.
    unsafe { &*RCC::ptr() }.cfgr().read().bits()
}

impl ClockMonitor {
    /// Starts SysTick, on a core clock of `hclk_hz`. Checks are expected once for each finger and
    /// tick.
    pub fn new(mut counter: SYST, hclk_hz: u32) -> Self {
        counter.set_clock_source(SystClkSource::Core);
        counter.set_reload(RELOAD);
        counter.clear_current();
        counter.enable_counter();
        Self {
            tick_rate: TickRateMonitor::new(hclk_hz / (TICK_HZ * FINGERS as u32)),
            clock_settings: clock_settings(),
        }
    }

    /// Checks clocks and rate; to be called when a block of samples is complete.
    ///
    /// # Errors
    /// [`SampleError::Clocks`] if the clock settings have changed, [`SampleError::TickRate`] if the
    /// block is early or late.
    pub fn check(&mut self) -> Result<(), SampleError> {
        if clock_settings() != self.clock_settings {
            return Err(SampleError::Clocks);
        }
        if !self.tick_rate.tick_is_due(SYST::get_current()) {
            return Err(SampleError::TickRate);
        }
        Ok(())
    }
}
