//! Whether ticks come at their rate, and whether the clocks are those that were set.
//!
//! Everything that lasts is counted in ticks. What makes them is one timer, TIM2, behind two prescalers; a wrong bit in any
//! of them would stretch or shorten all of that, while everything else works. SysTick counts the core's clock and shares
//! none of these with it; it goes on while the core waits for interrupts, and needs no interrupt itself. What both share is
//! looked at: the register that divides the core's clock.
//!
//! What is in front of it, the 8 MHz themselves, this cannot tell.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use stm32f4xx_hal::pac::RCC;
use thermal_display::device::TICK_HZ;
use thermal_display::device::safety::Pace;

use super::sampler::SampleError;
use super::wiring::FINGERS;

/// All of the counter's 24 bits.
const ROUND: u32 = 0xff_ffff;

/// The counter, and what it showed.
pub struct Timekeeper {
    pace: Pace,
    /// RCC_CFGR as it was set.
    clocks: u32,
}

/// RCC_CFGR.
fn clocks() -> u32 {
    // SAFETY: a load without effect from a register that only the start writes.
    unsafe { &*RCC::ptr() }.cfgr().read().bits()
}

impl Timekeeper {
    /// Starts the counter, for blocks of samples that are taken one for each finger a tick, with a core clock of `hclk_hz`.
    pub fn new(mut counter: SYST, hclk_hz: u32) -> Self {
        counter.set_clock_source(SystClkSource::Core);
        counter.set_reload(ROUND);
        counter.clear_current();
        counter.enable_counter();
        Self {
            pace: Pace::new(hclk_hz / (TICK_HZ * FINGERS as u32)),
            clocks: clocks(),
        }
    }

    /// A block of samples is there.
    ///
    /// # Errors
    /// It has not come when it was due, or the clocks are others.
    pub fn take(&mut self) -> Result<(), SampleError> {
        if clocks() != self.clocks {
            return Err(SampleError::Clocks);
        }
        if !self.pace.keeps(SYST::get_current()) {
            return Err(SampleError::Pace);
        }
        Ok(())
    }
}
