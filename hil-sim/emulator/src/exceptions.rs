//! Exception entry and return on the emulated CPU (ARMv7-M Architecture Reference Manual B1.5.6 to B1.5.8).
//!
//! Floating-point state is stacked at entry and not lazily, which the program does not notice; FPCAR is not kept. Its cycles are
//! those of lazy stacking.
use super::Wiring;
use super::corrections::CONTROL_SFPA;
use super::cost;
use super::elf::{FLASH_BASE, RAM_BASE};
use super::nvic::exception;
use super::state::{Cpu, get, masks, service};
use unicorn_engine::{Prot, RegisterARM as Reg};

/// Why an exception entry or return failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FrameError {
    /// The frame is outside of memory.
    Stack(u32),
    /// No valid EXC_RETURN for the active exceptions, or for the mode in the frame. The exception is no longer active.
    Return(u32),
    /// The CPU is to continue at an address without the Thumb bit. The frame is complete.
    ArmState(u32),
    /// The CPU emulation refused a register.
    Emulator,
}

/// Address of the instruction that clears the exclusive monitor; nothing is there on the chip.
pub(crate) const CLREX_AT: u32 = 0x0ff0_0000;

const CORE: [Reg; 6] = [Reg::R0, Reg::R1, Reg::R2, Reg::R3, Reg::R12, Reg::LR];
/// D0 to D7, which the emulation numbers consecutively.
fn float_registers() -> impl Iterator<Item = i32> {
    (0..8).map(|n| Reg::D0 as i32 + n)
}

/// CONTROL.FPCA, and the bit that the emulation wants beside it.
const FLOAT_CONTEXT: u32 = 1 << 2 | CONTROL_SFPA;
const NO_FLOAT: u32 = 0x10;
const FRAME: u32 = 0x20;
const FLOAT_FRAME: u32 = 0x68;

fn set<W: Wiring>(cpu: &mut Cpu<'_, W>, register: Reg, value: u32) -> Result<(), FrameError> {
    cpu.reg_write(register, u64::from(value)).map_err(|_| FrameError::Emulator)
}

/// Writes IPSR and the flags. The emulation adopts the new mode at the second write.
pub(super) fn set_xpsr<W: Wiring>(cpu: &mut Cpu<'_, W>, xpsr: u32) -> Result<(), FrameError> {
    set(cpu, Reg::XPSR_NZCVQG, xpsr)?;
    set(cpu, Reg::APSR_NZCV, xpsr & 0xf000_0000)
}

/// Stacks the context and enters `exception`; `return_pc` is the address to come back to. A more urgent exception
/// that arrives while stacking is entered instead (late arrival).
pub(crate) fn enter<W: Wiring>(
    cpu: &mut Cpu<'_, W>,
    exception: usize,
    return_pc: u32,
) -> Result<(), FrameError> {
    let control = get(cpu, Reg::CONTROL);
    let xpsr = get(cpu, Reg::XPSR);
    let sp = get(cpu, Reg::SP);
    let float = control & 4 != 0;
    let size = if float { FLOAT_FRAME } else { FRAME };
    let aligned = float || cpu.get_data().chip_ref().ppb.aligns_stack();
    let padding = if aligned { sp & 4 } else { 0 };
    let frame = sp.wrapping_sub(size + padding);
    let mut bytes = [0; FLOAT_FRAME as usize];
    let mut put =
        |at: usize, word: u32| bytes[4 * at..4 * at + 4].copy_from_slice(&word.to_le_bytes());
    for (i, register) in CORE.into_iter().enumerate() {
        put(i, get(cpu, register));
    }
    put(6, return_pc);
    put(7, xpsr & !(1 << 9) | padding << 7);
    if float {
        for (i, register) in float_registers().enumerate() {
            let pair = cpu.reg_read(register).map_err(|_| FrameError::Emulator)?;
            put(8 + 2 * i, pair as u32);
            put(9 + 2 * i, (pair >> 32) as u32);
        }
        put(24, get(cpu, Reg::FPSCR));
    }
    cpu.mem_write(u64::from(frame), &bytes[..size as usize])
        .map_err(|_| FrameError::Stack(frame))?;
    let from_thread = xpsr & 0x1ff == 0;
    let mut exc_return = match (from_thread, control & 2 != 0) {
        (false, _) => 0xffff_fff1,
        (true, false) => 0xffff_fff9,
        (true, true) => 0xffff_fffd,
    };
    if float {
        exc_return &= !NO_FLOAT;
    }
    set(cpu, Reg::SP, frame)?;
    take_privilege(cpu)?;
    // SPSEL can be written in thread mode only, so before IPSR; this also selects the main stack
    set(cpu, Reg::CONTROL, control & 1)?;
    let state = cpu.get_data_mut();
    state.cycles += cost::EXCEPTION_ENTRY;
    if float {
        state.float_state_pending = state.chip_ref().ppb.stacks_float_state_lazily();
        if !state.float_state_pending {
            state.cycles += cost::FLOAT_STATE;
        }
    }
    let now = state.cycles;
    service(cpu, now);
    let late = cpu.get_data().chip_ref().nvic.late_arrival(exception);
    start_handler(cpu, late.unwrap_or(exception), exc_return)
}

/// Clears CONTROL.nPRIV in thread mode: without privilege, the emulation lets nobody write CONTROL. In handler mode it does.
fn take_privilege<W: Wiring>(cpu: &mut Cpu<'_, W>) -> Result<(), FrameError> {
    if cpu.get_data_mut().unprivileged_masks.take().is_none() {
        return Ok(());
    }
    let (xpsr, control) = (get(cpu, Reg::XPSR), get(cpu, Reg::CONTROL));
    set_xpsr(cpu, xpsr | exception::SVCALL as u32)?;
    set(cpu, Reg::CONTROL, control & !1)?;
    set_xpsr(cpu, xpsr)
}

/// Activates `exception` and points the CPU at its handler.
fn start_handler<W: Wiring>(
    cpu: &mut Cpu<'_, W>,
    exception: usize,
    exc_return: u32,
) -> Result<(), FrameError> {
    clear_exclusive_monitor(cpu)?;
    let flags = get(cpu, Reg::XPSR) & 0xf80f_0000;
    set_xpsr(cpu, flags | 1 << 24 | exception as u32)?;
    set(cpu, Reg::LR, exc_return)?;
    let state = cpu.get_data_mut();
    let (now, instructions) = (state.cycles, state.instructions);
    let vector_at = state.chip().ppb.vtor.wrapping_add(4 * exception as u32);
    let pended_at = state.chip().nvic.enter(exception);
    state.exceptions += 1;
    state.refill = 0;
    state.event_register = true;
    state.profile.enter(exception, now.saturating_sub(pended_at), instructions, now);
    let vector = vector(cpu, vector_at)?;
    set(cpu, Reg::PC, vector | 1)?;
    if vector & 1 == 0 {
        return Err(FrameError::ArmState(vector));
    }
    Ok(())
}

/// Reset, exception entry and return clear the exclusive monitor (B1.5.5, B1.5.6, B1.5.8). The CPU emulation has no other way to it than the
/// instruction. Changes PC and the state of an IT block, both of which the caller sets.
fn clear_exclusive_monitor<W: Wiring>(cpu: &mut Cpu<'_, W>) -> Result<(), FrameError> {
    if !std::mem::take(&mut cpu.get_data_mut().exclusive_set) {
        return Ok(());
    }
    const CLREX: [u8; 4] = [0xbf, 0xf3, 0x2f, 0x8f];
    let (at, page) = (u64::from(CLREX_AT), 0x1000);
    let mut execute = || {
        cpu.mem_map(at, page, Prot::EXEC)?;
        cpu.mem_write(at, &CLREX)?;
        cpu.reg_write(Reg::EPSR, 1 << 24)?;
        cpu.emu_start(at | 1, at + CLREX.len() as u64, 0, 0)?;
        cpu.mem_unmap(at, page)
    };
    execute().map_err(|_| FrameError::Emulator)
}

/// Word of the vector table, which is usually in flash.
fn vector<W: Wiring>(cpu: &Cpu<'_, W>, address: u32) -> Result<u32, FrameError> {
    let offset = (address & !FLASH_BASE) as usize;
    let flash = &cpu.get_data().flash;
    let mut word = [0; 4];
    match flash.get(offset..offset + 4) {
        Some(bytes) if address < RAM_BASE => word.copy_from_slice(bytes),
        _ => cpu.mem_read(u64::from(address), &mut word).map_err(|_| FrameError::Stack(address))?,
    }
    Ok(u32::from_le_bytes(word))
}

/// Returns from the running exception, or enters the next pending one directly (tail chaining).
pub(crate) fn leave<W: Wiring>(cpu: &mut Cpu<'_, W>, exc_return: u32) -> Result<(), FrameError> {
    let xpsr = get(cpu, Reg::XPSR);
    let running = (xpsr & 0x1ff) as usize;
    let state = cpu.get_data_mut();
    let (now, instructions) = (state.cycles, state.instructions);
    let valid = matches!(exc_return | NO_FLOAT, 0xffff_fff1 | 0xffff_fff9 | 0xffff_fffd);
    state.chip().note_exception_return();
    let nvic = &mut state.chip().nvic;
    let to_thread = exc_return & 8 != 0;
    let valid = valid && nvic.is_active(running) && !(to_thread && nvic.active_count() > 1);
    nvic.leave(running, now);
    state.event_register = true;
    if running != exception::NMI {
        set(cpu, Reg::FAULTMASK, 0)?;
    }
    if !valid {
        cpu.get_data_mut().profile.leave(instructions, now);
        return Err(FrameError::Return(exc_return));
    }
    let (primask, basepri, faultmask) = masks(cpu);
    let state = cpu.get_data_mut();
    let nvic = &state.chip_ref().nvic;
    let level = nvic.execution_priority(primask, basepri, faultmask);
    if let Some((next, _)) = nvic.best().filter(|(_, priority)| *priority < level) {
        let now = state.cycles + cost::TAIL_CHAIN;
        state.profile.leave(instructions, now);
        return tail_chain(cpu, next, exc_return);
    }
    state.cycles += cost::EXCEPTION_RETURN;
    state.refill = 0;
    if exc_return & NO_FLOAT == 0 && !std::mem::take(&mut state.float_state_pending) {
        state.cycles += cost::FLOAT_STATE;
    }
    let now = state.cycles;
    state.profile.leave(instructions, now);
    unstack(cpu, exc_return, xpsr)
}

/// Enters `exception` on the frame of the one that returns.
pub(crate) fn tail_chain<W: Wiring>(
    cpu: &mut Cpu<'_, W>,
    exception: usize,
    exc_return: u32,
) -> Result<(), FrameError> {
    cpu.get_data_mut().cycles += cost::TAIL_CHAIN;
    let control = get(cpu, Reg::CONTROL);
    set(cpu, Reg::CONTROL, control & !FLOAT_CONTEXT)?;
    start_handler(cpu, exception, exc_return)
}

fn unstack<W: Wiring>(cpu: &mut Cpu<'_, W>, exc_return: u32, xpsr: u32) -> Result<(), FrameError> {
    let control = get(cpu, Reg::CONTROL);
    if exc_return & 8 != 0 {
        // To thread mode: leave handler mode first, so that SP is the stack pointer that SPSEL selects, and with privilege, so
        // that CONTROL can be written.
        if control & 1 != 0 {
            set(cpu, Reg::CONTROL, control & !1)?;
        }
        set_xpsr(cpu, xpsr & !0x1ff)?;
        set(cpu, Reg::CONTROL, control & !3 | (exc_return >> 2 & 1) << 1)?;
    }
    let sp = get(cpu, Reg::SP);
    let float = exc_return & NO_FLOAT == 0;
    let size = if float { FLOAT_FRAME } else { FRAME };
    let mut bytes = [0; FLOAT_FRAME as usize];
    cpu.mem_read(u64::from(sp), &mut bytes[..size as usize]).map_err(|_| FrameError::Stack(sp))?;
    let (words, _) = bytes.as_chunks();
    let word = |at: usize| u32::from_le_bytes(words[at]);
    let stacked = word(7);
    if (exc_return & 8 != 0) != (stacked & 0x1ff == 0) {
        set(cpu, Reg::CONTROL, control)?;
        set_xpsr(cpu, xpsr)?;
        return Err(FrameError::Return(exc_return));
    }
    for (i, register) in CORE.into_iter().enumerate() {
        set(cpu, register, word(i))?;
    }
    if float {
        for (i, register) in float_registers().enumerate() {
            let pair = u64::from(word(8 + 2 * i)) | u64::from(word(9 + 2 * i)) << 32;
            cpu.reg_write(register, pair).map_err(|_| FrameError::Emulator)?;
        }
        set(cpu, Reg::FPSCR, word(24))?;
    }
    clear_exclusive_monitor(cpu)?;
    let aligned = float || cpu.get_data().chip_ref().ppb.aligns_stack();
    let padding = if aligned { stacked >> 7 & 4 } else { 0 };
    set(cpu, Reg::SP, sp.wrapping_add(size) | padding)?;
    let context = if float { FLOAT_CONTEXT } else { 0 };
    let unprivileged = exc_return & 8 != 0 && control & 1 != 0;
    cpu.get_data_mut().unprivileged_masks = unprivileged.then(|| masks(cpu));
    let control = get(cpu, Reg::CONTROL) | control & 1;
    set(cpu, Reg::CONTROL, control & !FLOAT_CONTEXT | context)?;
    set_xpsr(cpu, stacked & !(1 << 9) | 1 << 24)?;
    set(cpu, Reg::PC, word(6) | 1)?;
    if stacked & 1 << 24 == 0 {
        return Err(FrameError::ArmState(word(6)));
    }
    Ok(())
}

/// Sets the registers to their reset values (B1.5.5); the stack pointer and the PC come from the vector table.
pub(crate) fn reset<W: Wiring>(cpu: &mut Cpu<'_, W>) -> Result<(), FrameError> {
    let state = cpu.get_data_mut();
    (state.refill, state.float_state_pending) = (0, false);
    state.flash_waiting.control(0);
    take_privilege(cpu)?;
    clear_exclusive_monitor(cpu)?;
    set_xpsr(cpu, 1 << 24)?;
    let masks = [Reg::PRIMASK, Reg::BASEPRI, Reg::FAULTMASK];
    for register in [Reg::CONTROL, Reg::FPSCR].into_iter().chain(masks) {
        set(cpu, register, 0)?;
    }
    let (sp, pc) = (vector(cpu, 0)?, vector(cpu, 4)?);
    set(cpu, Reg::SP, sp & !3)?;
    set(cpu, Reg::LR, 0xffff_ffff)?;
    set(cpu, Reg::PC, pc)
}
