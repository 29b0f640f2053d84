//! What an injected fault does to the devices.
use super::{Chip, TIM1, TIM8, TIMERS};
use crate::Wiring;
use crate::nvic::exception;
use crate::rcc::AfterHse;
use crate::stop::Answer;
use thermal_sim::processor::ResetCause;

impl<W: Wiring> Chip<W> {
    /// A watchdog runs that will end whatever the CPU is caught in.
    pub fn is_watched(&self) -> bool {
        self.iwdg.due != u64::MAX || self.wwdg.is_running() && self.stopped_at.is_none()
    }

    /// The external oscillator stops. `false`: with it every clock but that of the independent watchdog; pins keep the
    /// level that they have at the moment.
    pub fn stop_hse(&mut self, now: u64) -> Answer<bool> {
        let after = self.rcc.stop_hse()?;
        if self.rcc.security_interrupt() {
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

    /// The converter never ends a conversion again, until it is reset.
    pub fn stop_adc(&mut self, now: u64) {
        self.adc.stop_converting();
        self.refresh_next(now);
    }

    /// A bus error ends a stream: disabled, with the transfer-error flag (RM0390 9.3.19). `false`: it was not enabled.
    pub fn stop_stream(&mut self, controller: usize, stream: usize, now: u64) -> bool {
        let was_enabled = self.dma[controller].fail(stream);
        let (irq, level) = self.dma[controller].request_line(stream);
        self.nvic.set_line(irq, level, now);
        was_enabled
    }

    /// Nothing but the independent watchdog lives while no clock reaches the chip.
    pub(super) fn service_without_clock(&mut self, now: u64) {
        if self.iwdg.due <= now {
            self.iwdg.due = u64::MAX;
            self.reset = Some(ResetCause::IndependentWatchdog);
        }
        self.refresh_next(now);
    }
}
