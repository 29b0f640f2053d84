//! The halted CPU: asleep, locked up (ARMv7-M B1.5.15), or hung.
use super::Wiring;
use super::mcu::Machine;
use super::nvic::THREAD_PRIORITY;
use super::state::{get, masks, with_chip};
use super::stop::Stop;
use unicorn_engine::RegisterARM as Reg;

/// Value of the PC in lockup.
const LOCKUP_PC: u32 = 0xffff_fffe;

/// Why the CPU is halted. Timers, DMA, watchdogs and pins continue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Halt {
    /// WFI or WFE: a pending exception more urgent than this wakes it (PRIMASK does not count).
    Asleep { threshold: i32 },
    /// Lockup: only an NMI is taken, and only at HardFault's priority.
    LockedUp { priority: i32 },
    /// Halted until a reset by an injected fault, or for lack of a clock.
    Hung,
}

impl Halt {
    /// A pending exception must be more urgent than this to end the halt.
    const fn threshold(self) -> i32 {
        match self {
            Self::Asleep { threshold } => threshold,
            Self::LockedUp { priority } => priority,
            Self::Hung => -THREAD_PRIORITY,
        }
    }
}

impl<W: Wiring + 'static> Machine<W> {
    pub(super) fn enter_sleep(&mut self) {
        let (_, basepri, faultmask) = masks(&self.cpu);
        let nvic = &self.chip().nvic;
        let threshold = nvic.execution_priority(0, basepri, faultmask);
        self.halt = Some(Halt::Asleep { threshold });
    }

    pub(super) fn wait_for_event(&mut self) {
        if !std::mem::take(&mut self.cpu.get_data_mut().event_register) {
            self.enter_sleep();
        }
    }

    /// Locks the CPU up at `priority`; if no watchdog can end that, the run ends with `stop`.
    pub(super) fn lock_up(&mut self, priority: i32, stop: Stop) -> Result<(), Stop> {
        if !self.chip().is_watched() {
            return Err(stop);
        }
        if let Err(error) = self.cpu.reg_write(Reg::PC, LOCKUP_PC.into()) {
            return Err(super::mcu::emulator(error));
        }
        self.halt = Some(Halt::LockedUp { priority });
        Ok(())
    }

    /// Whether an NMI handler has returned into lockup.
    pub(super) fn is_back_in_lockup(&self) -> bool {
        get(&self.cpu, Reg::PC) & !1 == LOCKUP_PC
    }

    /// Advances time to an exception that ends the halt, a reset, or `limit`.
    pub(super) fn wait_while_halted(&mut self, limit: u64, halt: Halt) {
        let start = self.now();
        let end = with_chip(&mut self.cpu, |chip, service| {
            let mut now = start;
            loop {
                let woken =
                    chip.nvic.best().is_some_and(|(_, priority)| priority < halt.threshold());
                if woken || chip.reset.is_some() || now >= limit {
                    if matches!(halt, Halt::Asleep { .. }) {
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
                self.halt = None;
            }
        }
    }
}
