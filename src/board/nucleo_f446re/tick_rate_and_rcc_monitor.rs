//! The clock monitor: checks the rate of the ticks and the clock settings.
//!
//! All durations of the device are counted in ticks, which the timer TIM2 generates through two
//! prescalers. A wrong bit in the timer or in a prescaler would scale every duration, and nothing
//! else would fail. SysTick counts the clock of the core, independently of TIM2 and its prescalers,
//! also while the core waits for interrupts, and needs no interrupt of its own. The prescaler of
//! the core's clock acts on both, so its register is compared with the value that was set.
//!
//! The clock security system, which acts when the 8 MHz clock stops, must stay on; its bit is in
//! another register.
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

/// Value from which SysTick counts down, again and again: the largest that its 24 bits hold. A
/// round takes 93 ms at 180 MHz, much longer than a tick, so the counts between two ticks are
/// unambiguous.
const SYSTICK_RELOAD: u32 = 0xff_ffff;

/// Checks in every tick, with the counter SysTick, that the ticks come at the right rate, and that
/// the clock settings are still those of the start. An error turns all bridges off and stops
/// sampling.
pub struct TickRateAndRccMonitor {
    tick_rate: TickRateMonitor,
    /// Value of the register RCC_CFGR when the monitor was created. If the register changes
    /// afterwards, sampling stops with [`SampleError::Clocks`].
    rcc_cfgr_at_start: u32,
    /// Whether the clock security system was on when the monitor was created. If it is then switched
    /// off, sampling stops with [`SampleError::Clocks`]. Off at first, it may be switched on: a
    /// device that waits for the clock does that.
    clock_security_must_be_on: bool,
}

/// Reads the register RCC_CFGR: source and prescalers of the clocks.
fn read_rcc_cfgr() -> u32 {
    // SAFETY: a load without side effects, from a register that is written at the start only.
    unsafe { &*RCC::ptr() }.cfgr().read().bits()
}

/// Whether the clock security system is on.
fn clock_security_is_on() -> bool {
    // SAFETY: a load without side effects.
    unsafe { &*RCC::ptr() }.cr().read().csson().is_on()
}

impl TickRateAndRccMonitor {
    /// Starts SysTick on the core clock, whose frequency is `hclk_hz` (Hz), and stores the present
    /// clock settings for later comparison.
    /// [`check_rcc_cfgr_and_tick_rate`](Self::check_rcc_cfgr_and_tick_rate) must then be called once
    /// for each finger and tick of 1 ms.
    pub fn new(mut counter: SYST, hclk_hz: u32) -> Self {
        counter.set_clock_source(SystClkSource::Core);
        counter.set_reload(SYSTICK_RELOAD);
        counter.clear_current();
        counter.enable_counter();
        Self {
            tick_rate: TickRateMonitor::new(hclk_hz / (TICK_HZ * FINGERS as u32)),
            rcc_cfgr_at_start: read_rcc_cfgr(),
            clock_security_must_be_on: clock_security_is_on(),
        }
    }

    /// Checks the clock settings and the tick rate. To be called once for each finger and tick, as
    /// soon as a block of samples is complete: SysTick measures the time of each call. A call is
    /// due at the time of the first call plus a whole number of periods of 1 ms divided by the
    /// number of fingers.
    ///
    /// # Errors
    /// [`SampleError::Clocks`] if the register RCC_CFGR has changed since the start, or the clock
    /// security system has been switched off; [`SampleError::TickRate`] if the call is early or late by more than a quarter of a period.
    pub fn check_rcc_cfgr_and_tick_rate(&mut self) -> Result<(), SampleError> {
        if read_rcc_cfgr() != self.rcc_cfgr_at_start {
            return Err(SampleError::Clocks);
        }
        if self.clock_security_must_be_on && !clock_security_is_on() {
            return Err(SampleError::Clocks);
        }
        if !self.tick_rate.tick_is_on_schedule(SYST::get_current()) {
            return Err(SampleError::TickRate);
        }
        Ok(())
    }
}
