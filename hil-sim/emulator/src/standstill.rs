//! The CPU while it executes nothing: asleep, locked up (ARMv7-M B1.5.15), or hung.
use super::Wiring;
use super::mcu::Machine;
use super::nvic::THREAD_PRIORITY;
use super::state::{get, masks, with_chip};
use super::stop::Stop;
use unicorn_engine::RegisterARM as Reg;

/// What the PC holds in lockup.
const LOCKUP_PC: u32 = 0xffff_fffe;

/// Why the CPU executes nothing. Timers, DMA, watchdogs and pins go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Standstill {
    /// WFI or WFE: a pending exception more urgent than this wakes it (PRIMASK does not count).
    Asleep { threshold: i32 },
    /// A fault that no handler can take: only an NMI gets through, and only from HardFault's priority.
    LockedUp { priority: i32 },
    /// Held by an injected fault, or without a clock: until a reset.
    Hung,
}

impl Standstill {
    /// Priority that a pending exception must beat to end it.
    const fn threshold(self) -> i32 {
        match self {
            Self::Asleep { threshold } => threshold,
            Self::LockedUp { priority } => priority,
            Self::Hung => -THREAD_PRIORITY,
        }
    }
}

impl<W: Wiring + 'static> Machine<W> {
    pub(super) fn fall_asleep(&mut self) {
        let (_, basepri, faultmask) = masks(&self.cpu);
        let nvic = &self.chip().nvic;
        let threshold = nvic.execution_priority(0, basepri, faultmask);
        self.standstill = Some(Standstill::Asleep { threshold });
    }

    pub(super) fn wait_for_event(&mut self) {
        if !std::mem::take(&mut self.cpu.get_data_mut().event_register) {
            self.fall_asleep();
        }
    }

    /// Locks the CPU up at `priority`; without a watchdog that could end it the run ends with `stop`.
    pub(super) fn lock_up(&mut self, priority: i32, stop: Stop) -> Result<(), Stop> {
        if !self.chip().is_watched() {
            return Err(stop);
        }
        if let Err(error) = self.cpu.reg_write(Reg::PC, LOCKUP_PC.into()) {
            return Err(super::mcu::emulator(error));
        }
        self.standstill = Some(Standstill::LockedUp { priority });
        Ok(())
    }

    /// An NMI handler has returned into lockup.
    pub(super) fn is_back_in_lockup(&self) -> bool {
        get(&self.cpu, Reg::PC) & !1 == LOCKUP_PC
    }

    /// Passes time until an exception starts the CPU again, a reset, or `limit`.
    pub(super) fn stand_until(&mut self, limit: u64, standstill: Standstill) {
        let start = self.now();
        let end = with_chip(&mut self.cpu, |chip, service| {
            let mut now = start;
            loop {
                let woken = chip
                    .nvic
                    .best()
                    .is_some_and(|(_, priority)| priority < standstill.threshold());
                if woken || chip.reset.is_some() || now >= limit {
                    if matches!(standstill, Standstill::Asleep { .. }) {
                        chip.count_sleep(now - start);
                    }
                    return (now, woken);
                }
                now = chip.next.clamp(now, limit);
                service(chip, now);
            }
        });
        if let Some((now, woken)) = end {
            self.cpu.get_data_mut().cycles = now;
            if woken {
                self.standstill = None;
            }
        }
    }
}
