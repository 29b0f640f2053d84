//! Exceptions that the program itself causes: supervisor calls, faults and their escalation, lockup (ARMv7-M B1.5).
use super::Wiring;
use super::debugger::Halted;
use super::exceptions::{self, FrameError};
use super::mcu::Machine;
use super::nvic::{NMI_PRIORITY, exception};
use super::state::{self, get, masks};
use super::stop::{Access, Stop};
use unicorn_engine::{RegisterARM as Reg, uc_error};

/// A fault of the core.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fault {
    pub(super) exception: usize,
    /// Bits for CFSR.
    pub(super) status: u32,
    pub(super) address: Option<u32>,
    pub(super) cause: &'static str,
}

impl Fault {
    pub(super) const fn new(exception: usize, status: u32, cause: &'static str) -> Self {
        Self { exception, status, address: None, cause }
    }
}

const fn usage(status: u32, cause: &'static str) -> Fault {
    Fault::new(exception::USAGE_FAULT, status, cause)
}

pub(super) const NO_MEMORY: Fault =
    Fault::new(exception::BUS_FAULT, 1 << 8, "instruction fetch where no memory is");
pub(super) const EXECUTE_NEVER: Fault =
    Fault::new(exception::MEM_MANAGE, 1, "instruction fetch from a region of devices");
pub(super) const RESERVED_ADDRESS: Fault = Fault::new(
    exception::BUS_FAULT,
    1 << 10, // imprecise
    "access to a reserved peripheral address",
);
pub(super) const PRIVATE_BUS: Fault = Fault::new(
    exception::BUS_FAULT,
    1 << 9 | 1 << 15,
    "access to the private peripheral bus without privilege",
);
pub(super) const UNDEFINED: Fault = usage(1 << 16, "undefined instruction");
pub(super) const INVALID_STATE: Fault = usage(1 << 17, "branch to an ARM address");
pub(super) const INVALID_RETURN: Fault = usage(1 << 18, "invalid exception return");
pub(super) const NO_COPROCESSOR: Fault =
    usage(1 << 19, "floating-point instruction while CPACR denies it");
pub(super) const UNALIGNED: Fault = usage(1 << 24, "unaligned access");

/// Whether the default memory map forbids execution at an address (ARMv7-M B3.1).
const fn never_executes(address: u32) -> bool {
    matches!(address >> 29, 2 | 5..)
}

impl<W: Wiring + 'static> Machine<W> {
    /// Handles an exception that the CPU emulation raised, by its number there.
    pub(super) fn cpu_exception(&mut self, number: u32, pc: u32) -> Result<(), Stop> {
        match number {
            2 => self.supervisor_call(pc),
            7 if self.chip().ppb.debugger_is_attached() => {
                let halted = self.breakpoint(pc);
                self.halt_under_debugger(halted);
                Ok(())
            }
            7 => {
                // no debugger is attached and the debug monitor is off (C1.5): a HardFault with DEBUGEVT
                self.chip_mut().ppb.hfsr |= 1 << 31;
                self.fault(Fault::new(exception::HARD_FAULT, 0, "BKPT"), pc)
            }
            // in thread mode, EXC_RETURN is an address like any other
            8 if get(&self.cpu, Reg::XPSR) & 0x1ff == 0 => self.fault(EXECUTE_NEVER, pc),
            8 => match exceptions::leave(&mut self.cpu, pc | 1) {
                Err(FrameError::Return(exc_return)) => {
                    let Some(taken) = self.escalate(INVALID_RETURN, pc)? else {
                        return Ok(());
                    };
                    let result = exceptions::tail_chain(&mut self.cpu, taken, exc_return);
                    self.checked_frame(result, "unstacking")
                }
                other => self.checked_frame(other, "unstacking"),
            },
            17 => self.fault(NO_COPROCESSOR, pc),
            18 => self.fault(INVALID_STATE, pc),
            // a data abort: without a memory protection unit, that of an exclusive access that is not aligned
            4 => {
                state::refund(self.cpu.get_data_mut(), pc);
                self.fault(UNALIGNED, pc)
            }
            _ => Err(Stop::Emulator(format!(
                "exception {number} of the CPU emulation at {pc:#010x}"
            ))),
        }
    }

    /// SVC: taken at once, or a HardFault when its priority does not allow it (B1.5.4).
    fn supervisor_call(&mut self, pc: u32) -> Result<(), Stop> {
        let (primask, basepri, faultmask) = masks(&self.cpu);
        let state = self.cpu.get_data_mut();
        let now = state.cycles;
        let nvic = &mut state.chip().nvic;
        let level = nvic.execution_priority(primask, basepri, faultmask);
        if nvic.priority_of(exception::SVCALL) < level {
            nvic.pend(exception::SVCALL, now);
            return self.enter(exception::SVCALL, pc);
        }
        self.chip_mut().ppb.hfsr |= 1 << 30;
        let cause = "SVC at or above its own priority";
        self.fault(Fault::new(exception::HARD_FAULT, 0, cause), pc)
    }

    /// Handles an access to an address without memory.
    pub(super) fn access_fault(
        &mut self,
        error: uc_error,
        address: u32,
        value: u32,
        to_flash: bool,
        pc: u32,
    ) -> Result<(), Stop> {
        if to_flash {
            return Err(Stop::NotModelled {
                register: "flash programming".into(),
                address,
                access: Access::Write(4),
                value,
                place: self.place(pc),
            });
        }
        let cause = match error {
            uc_error::FETCH_UNMAPPED | uc_error::FETCH_PROT => {
                let fault = if never_executes(pc) { EXECUTE_NEVER } else { NO_MEMORY };
                return self.fault(fault, pc);
            }
            uc_error::READ_UNMAPPED | uc_error::READ_PROT => "load where no memory is",
            _ => "store where no memory is",
        };
        let fault = Fault {
            address: Some(address),
            ..Fault::new(exception::BUS_FAULT, 1 << 9 | 1 << 15, cause)
        };
        self.fault(fault, pc)
    }

    /// Takes a fault.
    pub(super) fn fault(&mut self, fault: Fault, pc: u32) -> Result<(), Stop> {
        match self.escalate(fault, pc)? {
            Some(taken) => self.enter(taken, pc),
            None => Ok(()),
        }
    }

    /// The exception that a fault pends: its own if enabled and urgent enough, else HardFault. `None`: lockup, or a halt under a debugger.
    fn escalate(&mut self, fault: Fault, pc: u32) -> Result<Option<usize>, Stop> {
        let (primask, basepri, faultmask) = masks(&self.cpu);
        let state = self.cpu.get_data_mut();
        let now = state.cycles;
        let chip = state.chip();
        let level = chip.nvic.execution_priority(primask, basepri, faultmask);
        chip.ppb.cfsr |= fault.status;
        if let Some(address) = fault.address {
            chip.ppb.fault_address = address;
        }
        let own = chip.ppb.fault_enabled(fault.exception)
            && chip.nvic.priority_of(fault.exception) < level;
        let taken = if own { fault.exception } else { exception::HARD_FAULT };
        if taken != fault.exception {
            chip.ppb.hfsr |= 1 << 30;
        }
        if chip.nvic.priority_of(taken) >= level {
            let stop =
                Stop::Lockup { cause: fault.cause.into(), priority: level, place: self.place(pc) };
            self.lock_up(level, stop)?;
            return Ok(None);
        }
        if taken == exception::HARD_FAULT && chip.ppb.catches_hard_fault() {
            let (cause, place) = (fault.cause, self.place(pc));
            self.halt_under_debugger(Halted::HardFault { cause, place });
            return Ok(None);
        }
        chip.nvic.pend(taken, now);
        Ok(Some(taken))
    }

    pub(super) fn enter(&mut self, exception: usize, pc: u32) -> Result<(), Stop> {
        let result = exceptions::enter(&mut self.cpu, exception, pc);
        self.checked_frame(result, "stacking")
    }

    /// Locks the CPU up when a frame does not fit into memory: the handler of the derived fault has no stack either, nor has the NMI's.
    fn checked_frame(&mut self, result: Result<(), FrameError>, what: &str) -> Result<(), Stop> {
        match result {
            Ok(()) => Ok(()),
            Err(FrameError::Stack(address)) => {
                let priority = self.chip().nvic.active_priority();
                let stop = Stop::Lockup {
                    cause: format!("exception {what} at {address:#010x}, where no memory is"),
                    priority,
                    place: self.place(self.cpu.get_data().block_pc),
                };
                self.lock_up(NMI_PRIORITY, stop)
            }
            Err(FrameError::ArmState(pc)) => self.fault(INVALID_STATE, pc),
            Err(error) => Err(Stop::Emulator(format!("{error:?} while {what}"))),
        }
    }
}
