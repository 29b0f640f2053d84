//! Timers and watchdogs that stand still while a debugger halts the core (DBGMCU; RM0090 38.16, the same block).
use super::{Chip, TIM1, TIM8, TIM10, TIM11, TIMERS};
use crate::Wiring;

/// DBGMCU_APB1_FZ.
const WWDG_STOP: u32 = 1 << 11;
const IWDG_STOP: u32 = 1 << 12;

impl<W: Wiring> Chip<W> {
    /// A debugger halts the core, or lets it continue: devices whose bit in DBGMCU is set stand still meanwhile.
    pub fn set_halted_by_debugger(&mut self, halted: bool, now: u64) {
        self.halted_by_debugger = halted;
        self.apply_debug_freeze(now);
    }

    /// Brings watchdogs and timers to what DBGMCU and the debugger demand.
    pub(super) fn apply_debug_freeze(&mut self, now: u64) {
        let [_, apb1, apb2] = match self.halted_by_debugger {
            true => self.ppb.dbgmcu,
            false => [0; 3],
        };
        self.iwdg.set_halted(apb1 & IWDG_STOP != 0, now);
        self.clock_wwdg(now);
        for timer in 0..TIMERS {
            let halted = match timer {
                TIM1 => apb2 & 1,
                TIM8 => apb2 >> 1 & 1,
                TIM10 => apb2 >> 17 & 1,
                TIM11 => apb2 >> 18 & 1,
                // TIM2 to TIM7
                _ => apb1 >> (timer - 1) & 1,
            };
            self.tims[timer].set_halted(halted != 0, now);
            self.timer_changed(timer, now);
        }
        self.refresh_next(now);
    }

    /// Whether the window watchdog stands still.
    pub(super) const fn window_watchdog_is_halted(&self) -> bool {
        self.halted_by_debugger && self.ppb.dbgmcu[1] & WWDG_STOP != 0
    }
}
