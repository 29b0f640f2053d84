//! Effects of injected faults on the peripherals.
use super::{Chip, TIM1, TIM8, TIMERS};
use crate::Wiring;
use crate::nvic::exception;
use crate::rcc::AfterHse;
use crate::stop::Answer;
use thermal_sim::processor::ResetCause;

impl<W: Wiring> Chip<W> {
    /// Whether a watchdog runs, which will reset a CPU that is locked up.
    pub fn is_watched(&self) -> bool {
        self.iwdg.due != u64::MAX || self.wwdg.is_running() && self.stopped_at.is_none()
    }

    /// Stops the external oscillator. `false`: with it stop all clocks but that of the independent watchdog, and pins keep
    /// their present level.
    pub fn stop_hse(&mut self, now: u64) -> Answer<bool> {
        let after = self.rcc.stop_hse()?;
        if self.rcc.clock_failure_interrupt() {
            self.nvic.set_exception_line(exception::NMI, true, now);
            for timer in [TIM1, TIM8] {
                self.tims[timer].sync(now);
                if self.tims[timer].clock_failed() {
                    self.timer_changed(timer, now);
                }
            }
        }
        match after {
            AfterHse::Unaffected => {}
            AfterHse::Internal(old) => self.clocks_changed(old, now),
            AfterHse::Nothing => {
                for timer in 0..TIMERS {
                    self.tims[timer].sync(now);
                    self.timer_changed(timer, now);
                }
                self.stopped_at = Some(now);
                self.bridge_changed(now);
            }
        }
        self.refresh_next(now);
        Ok(after != AfterHse::Nothing)
    }

    /// The external oscillator comes, or comes back.
    pub fn start_hse(&mut self, now: u64) {
        self.rcc.start_hse(now);
    }

    /// Flips stored bits of BDTR of TIM1 or TIM8. `false`: the address is that of another register.
    pub fn flip_bdtr(&mut self, address: u32, mask: u32, now: u64) -> bool {
        let timer = match address {
            0x4001_0044 => TIM1,
            0x4001_0444 => TIM8,
            _ => return false,
        };
        self.tims[timer].flip_bdtr(mask, now);
        self.timer_changed(timer, now);
        self.sample_inputs(now);
        true
    }

    /// No conversion of a converter, by its index, ends until it is reset.
    pub fn stop_adc(&mut self, converter: usize, now: u64) {
        self.adcs[converter].stop_converting();
        self.refresh_next(now);
    }

    /// Ends a stream as a bus error does: disabled, with the transfer-error flag (RM0390 9.3.19). `false`: it was not enabled.
    pub fn stop_stream(&mut self, controller: usize, stream: usize, now: u64) -> bool {
        let was_enabled = self.dma[controller].fail(stream);
        let (irq, level) = self.dma[controller].request_line(stream);
        self.nvic.set_line(irq, level, now);
        was_enabled
    }

    /// Services the independent watchdog, the only device that runs while the chip has no clock.
    pub(super) fn service_without_clock(&mut self, now: u64) {
        if self.iwdg.due <= now {
            self.iwdg.due = u64::MAX;
            self.reset = Some(ResetCause::IndependentWatchdog);
        }
        self.refresh_next(now);
    }
}
