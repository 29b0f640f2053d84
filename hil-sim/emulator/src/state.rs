//! State shared by the hooks of the CPU emulation: the chip, the cycle count, and why the CPU paused.
use super::Wiring;
use super::chip::Chip;
use super::corrections::Correction;
use super::cost::{self, Block, CostTable, Exclusive, Last};
use super::elf::{FLASH_BASE, RAM_BASE};
use super::exceptions::CLREX_AT;
use super::execution_path::ExecutedBlock;
use super::faults::{Fault, PRIVATE_BUS, RESERVED_ADDRESS};
use super::flash_waiting::FlashWaiting;
use super::profile::Profile;
use super::ram::Ram;
use super::stop::{Access, Refusal};
use std::collections::BTreeSet;
use std::sync::Arc;
use thermal_sim::processor::FlashTiming;
use unicorn_engine::{RegisterARM as Reg, Unicorn};

/// Access control register of the flash.
const FLASH_ACR: u32 = 0x4002_3c00;

pub(crate) type Cpu<'u, W> = Unicorn<'u, State<W>>;

/// A register access that a model refused.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Refused {
    pub refusal: Refusal,
    pub address: u32,
    pub access: Access,
    pub value: u32,
    pub pc: u32,
}

/// Why the CPU emulation returned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    /// A hook stopped the CPU before the block at the PC.
    Requested,
    /// No hook did: a sleep instruction, or an error that the return value gives.
    Unspecified,
    /// The emulation raised its exception of that number.
    Exception(u32),
    /// The block at the PC uses the floating-point unit, which CPACR denies.
    FloatDenied,
}

pub(crate) struct State<W> {
    /// `None` while it is serviced, so that chip and memory can be borrowed together.
    chip: Option<Box<Chip<W>>>,
    pub cost: CostTable,
    pub flash: Arc<[u8]>,
    pub flash_waiting: FlashWaiting,
    pub profile: Profile,
    pub cycles: u64,
    pub instructions: u64,
    pub exceptions: u64,
    /// Start of the running block: the time of every register access in it.
    pub block_at: u64,
    pub block_pc: u32,
    pub block: Block,
    /// Address behind the last block, and the cycles of refill if the CPU goes on elsewhere.
    following: u32,
    pub refill: u8,
    /// The floating-point state of the preempted program is not yet on the stack, only its place (lazy stacking).
    pub float_state_pending: bool,
    /// Cycle before which the run goes on; see [`Self::set_limit`].
    limit: u64,
    /// The last block may have changed PRIMASK, BASEPRI or FAULTMASK.
    masks_written: bool,
    /// Until this cycle no block needs a look at the chip: no event is due, no exception may be taken, nothing pauses the run. 0: the
    /// chip may have changed, and the next block looks.
    undisturbed_until: u64,
    /// Stop the CPU before the next block.
    pub pause_requested: bool,
    pub exit: Exit,
    pub refused: Option<Refused>,
    /// Fault of a hook, taken before the next block.
    pub raised: Option<Fault>,
    /// The access to unmapped memory that ended the emulation: address, value, and whether it was a store to flash.
    pub invalid: Option<(u32, u32, bool)>,
    /// Event register of WFE (ARMv7-M B1.5.18).
    pub event_register: bool,
    /// The masks while thread mode runs without privilege, in which the emulation shows them as 0.
    pub unprivileged_masks: Option<Masks>,
    /// What the instruction at an address left wrong.
    pub correction: Option<(u32, Correction)>,
    /// Offset into the flash and length of the blocks with instructions that are watched, and of one that is to be.
    pub watched: BTreeSet<(u32, u32)>,
    pub to_watch: Option<(u32, u32)>,
    /// An LDREX has perhaps set the exclusive monitor of the CPU emulation.
    pub exclusive_set: bool,
}

impl<W: Wiring> State<W> {
    pub fn new(chip: Chip<W>, flash: Arc<[u8]>, timing: FlashTiming) -> Self {
        Self {
            chip: Some(Box::new(chip)),
            cost: CostTable::new(flash.len()),
            flash,
            flash_waiting: FlashWaiting::new(timing),
            profile: Profile::new(),
            cycles: 0,
            instructions: 0,
            exceptions: 0,
            block_at: 0,
            block_pc: 0,
            block: Block::default(),
            following: 0,
            refill: 0,
            float_state_pending: false,
            limit: 0,
            masks_written: false,
            undisturbed_until: 0,
            pause_requested: false,
            exit: Exit::Unspecified,
            refused: None,
            raised: None,
            invalid: None,
            event_register: false,
            unprivileged_masks: None,
            correction: None,
            watched: BTreeSet::new(),
            to_watch: None,
            exclusive_set: false,
        }
    }

    /// The chip, for changes.
    ///
    /// # Panics
    /// If called from within [`service`]; no device does that.
    #[inline]
    pub fn chip(&mut self) -> &mut Chip<W> {
        self.undisturbed_until = 0;
        self.chip.as_mut().expect("the chip is in its place outside of service()")
    }

    #[inline]
    pub fn chip_ref(&self) -> &Chip<W> {
        self.chip.as_ref().expect("the chip is in its place outside of service()")
    }

    /// Fast path of most blocks: counts a block of known cost if no event is due before it.
    #[inline]
    fn charge_known_block(&mut self, address: u32, bytes: u32) -> bool {
        if self.cycles >= self.undisturbed_until {
            return false;
        }
        let Some(block) = self.cost.known(address) else {
            return false;
        };
        if u32::from(block.bytes) != bytes || block.is_special() {
            return false;
        }
        self.charge(address, block);
        true
    }

    /// Sets until when blocks need no look at the chip; called when the present block does not pause the run.
    #[inline(always)]
    fn set_undisturbed(&mut self) {
        let chip = self.chip_ref();
        self.undisturbed_until =
            if chip.nvic.may_preempt() { 0 } else { chip.next.min(self.limit) };
    }

    /// Counts a block that is about to run, and the refill if a branch leads to it.
    #[inline]
    fn charge(&mut self, address: u32, block: Block) {
        let before = self.cycles;
        if address != self.following && self.refill > 0 {
            self.cycles += u64::from(self.refill) + u64::from(block.split);
        }
        self.cycles += self.flash_waiting.block(
            self.cycles,
            (address, block.bytes),
            block.cycles,
            block.constants,
        );
        self.following = address + u32::from(block.bytes);
        self.refill = block.refill;
        self.block_pc = address;
        self.block_at = self.cycles;
        self.block = block;
        self.cycles += u64::from(block.cycles);
        self.instructions += u64::from(block.instructions);
        if self.profile.watching {
            let waited = (self.cycles - u64::from(block.cycles) - before) as u16;
            self.profile.record(ExecutedBlock { address, bytes: block.bytes, waited });
        }
    }

    /// Passes the time for which the busy flash stalls the code in it.
    fn wait_for_flash(&mut self) {
        self.cycles = self.cycles.max(self.chip_ref().flash.busy_until());
    }

    /// The program has not the privilege for an access to the private peripheral bus.
    fn deny(&mut self, address: u32) {
        self.raise(Fault { address: Some(address), ..PRIVATE_BUS });
    }

    /// The run pauses at the first block from this cycle on.
    pub fn set_limit(&mut self, cycle: u64) {
        (self.limit, self.undisturbed_until) = (cycle, 0);
    }

    /// Stops the CPU before the next block.
    pub fn request_pause(&mut self) {
        (self.pause_requested, self.undisturbed_until) = (true, 0);
    }

    /// Has a correction made behind the instruction at an address: before the next that is watched, or the next block.
    pub fn correct_behind(&mut self, address: u32, correction: Correction) {
        self.correction = Some((address, correction));
        self.request_pause();
    }

    /// Whether a block with instructions to be watched must not run yet.
    fn must_watch(&mut self, address: u32, bytes: u32) -> bool {
        let block = (address & !FLASH_BASE, bytes);
        let unwatched = address < RAM_BASE && !self.watched.contains(&block);
        if unwatched {
            self.to_watch = Some(block);
            self.request_pause();
        }
        unwatched
    }

    /// Takes a fault before the next block.
    pub fn raise(&mut self, fault: Fault) {
        self.request_pause();
        self.raised = Some(fault);
    }

    fn refuse(&mut self, refusal: Refusal, address: u32, access: Access, value: u32) {
        self.request_pause();
        if refusal == Refusal::BusError {
            self.raise(RESERVED_ADDRESS);
        } else if self.refused.is_none() {
            self.refused = Some(Refused { refusal, address, access, value, pc: self.block_pc });
        }
    }
}

/// Runs `work` with exclusive access to the chip, and with a function that services it with access to the memories.
pub(crate) fn with_chip<W: Wiring, R>(
    cpu: &mut Cpu<'_, W>,
    work: impl FnOnce(&mut Chip<W>, &mut dyn FnMut(&mut Chip<W>, u64)) -> R,
) -> Option<R> {
    let state = cpu.get_data_mut();
    state.undisturbed_until = 0;
    let mut chip = state.chip.take()?;
    let mut ram = Ram::new(cpu);
    let result = work(&mut chip, &mut |chip, now| chip.service(now, &mut ram));
    ram.flush();
    cpu.get_data_mut().chip = Some(chip);
    Some(result)
}

/// Handles the device events up to `now`.
pub(crate) fn service<W: Wiring>(cpu: &mut Cpu<'_, W>, now: u64) {
    if cpu.get_data().chip_ref().next <= now {
        with_chip(cpu, |chip, service| service(chip, now));
    }
}

/// Value of a core register.
pub(crate) fn get<D>(cpu: &Unicorn<'_, D>, register: Reg) -> u32 {
    cpu.reg_read(register).map_or(0, |v| v as u32)
}

/// The emulation's number of core register 0 to 14; it numbers R0 to R12 consecutively.
pub(crate) fn core_register(n: u32) -> i32 {
    match n {
        13 => Reg::SP as i32,
        14 => Reg::LR as i32,
        _ => Reg::R0 as i32 + n as i32,
    }
}

/// The two half-words of code at an address; `None` where no memory is.
pub(crate) fn half_words<W: Wiring>(cpu: &Cpu<'_, W>, address: u32) -> Option<(u32, u32)> {
    let at = (address & 0x07ff_ffff) as usize;
    let mut code = [0; 4];
    match cpu.get_data().flash.get(at..at + 4) {
        Some(bytes) if address < RAM_BASE => code.copy_from_slice(bytes),
        _ => cpu.mem_read(address.into(), &mut code).ok()?,
    }
    let [a, b, c, d] = code;
    Some((u16::from_le_bytes([a, b]).into(), u16::from_le_bytes([c, d]).into()))
}

/// PRIMASK, BASEPRI, FAULTMASK.
pub(crate) type Masks = (u32, u32, u32);

/// The masks now.
pub(crate) fn masks<W: Wiring>(cpu: &Cpu<'_, W>) -> Masks {
    cpu.get_data().unprivileged_masks.unwrap_or_else(|| {
        (get(cpu, Reg::PRIMASK), get(cpu, Reg::BASEPRI), get(cpu, Reg::FAULTMASK))
    })
}

/// The exception to be taken now, if any.
#[inline]
pub(crate) fn takeable<W: Wiring>(cpu: &Cpu<'_, W>) -> Option<usize> {
    let nvic = &cpu.get_data().chip_ref().nvic;
    let (exception, priority) = nvic.best()?;
    if priority >= nvic.active_priority() {
        return None;
    }
    let (primask, basepri, faultmask) = masks(cpu);
    (priority < nvic.execution_priority(primask, basepri, faultmask)).then_some(exception)
}

/// Called before each basic block: pauses if an event or exception is due, else counts the block's cost.
#[inline]
pub(crate) fn on_block<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32, bytes: u32) {
    if !cpu.get_data_mut().charge_known_block(address, bytes) {
        charge_or_pause(cpu, address, bytes);
    }
}

/// Slow path: a block before which an event may be due, or whose cost is not known yet.
#[cold]
fn charge_or_pause<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32, bytes: u32) {
    if address == CLREX_AT {
        return;
    }
    let state = cpu.get_data_mut();
    let now = state.cycles;
    state.block_pc = address;
    if std::mem::take(&mut state.masks_written) {
        note_masking(cpu);
    }
    let state = cpu.get_data_mut();
    if state.chip_ref().next <= now {
        service(cpu, now);
    }
    let pause = {
        let state = cpu.get_data_mut();
        let (limit, chip) = (state.limit, state.chip_ref());
        state.pause_requested || now >= limit || chip.reset.is_some() || chip.misuse.is_some()
    } || takeable(cpu).is_some();
    let state = cpu.get_data_mut();
    if pause {
        state.exit = Exit::Requested;
    } else {
        let offset = if address >= FLASH_BASE { address - FLASH_BASE } else { address } as usize;
        let block = match state.cost.flash_block(&state.flash, offset, bytes) {
            Some(block) => block,
            None => {
                let code =
                    cpu.mem_read_as_vec(u64::from(address), bytes as usize).unwrap_or_default();
                cost::decode(address, &code)
            }
        };
        let state = cpu.get_data_mut();
        if block.suspect && state.must_watch(address, bytes) {
            state.exit = Exit::Requested;
        } else if !block.float || state.chip_ref().ppb.float_enabled() {
            state.event_register |= block.sev;
            match block.exclusive {
                Exclusive::Unchanged => {}
                access => state.exclusive_set = access == Exclusive::Set,
            }
            if block.float && std::mem::take(&mut state.float_state_pending) {
                state.cycles += cost::FLOAT_STATE;
            }
            state.set_undisturbed();
            state.charge(address, block);
            if block.writes_masks {
                // The next block looks at the masks.
                state.masks_written = true;
                state.undisturbed_until = 0;
            }
            return;
        } else {
            state.exit = Exit::FloatDenied;
        }
    }
    let state = cpu.get_data_mut();
    state.block = Block::default();
    if let Err(error) = cpu.emu_stop() {
        debug_assert!(false, "{error:?}");
    }
}

/// Tells the profile whether the program masks more exceptions now than the running handler does by its own priority.
fn note_masking<W: Wiring>(cpu: &mut Cpu<'_, W>) {
    let (primask, basepri, faultmask) = masks(cpu);
    // the priorities of this chip have four bits
    if basepri & 0xf != 0
        && let Err(error) = cpu.reg_write(Reg::BASEPRI, u64::from(basepri & 0xf0))
    {
        debug_assert!(false, "{error:?}");
    }
    let state = cpu.get_data_mut();
    let nvic = &state.chip_ref().nvic;
    let masked =
        nvic.execution_priority(primask, basepri, faultmask) < nvic.execution_priority(0, 0, 0);
    let (instructions, cycles) = (state.instructions, state.cycles);
    state.profile.set_masked(masked, instructions, cycles);
}

/// Subtracts the cost of the instructions of a block from `pc` on, which did not run.
pub(crate) fn refund<W: Wiring>(state: &mut State<W>, pc: u32) {
    let ran = pc.wrapping_sub(state.block_pc);
    if ran >= u32::from(state.block.bytes) {
        return;
    }
    // the STREX that was counted on may not have run
    state.exclusive_set |= state.block.exclusive == Exclusive::Clear;
    let start = (state.block_pc & 0x07ff_ffff) as usize;
    let code = state.flash.get(start..start + ran as usize).unwrap_or_default();
    let part = cost::decode(state.block_pc, code);
    state.cycles = state.block_at + u64::from(part.cycles);
    state.instructions -= u64::from(state.block.instructions - part.instructions);
    state.block = Block { last: Last::Other, ..part };
}

/// Whether the program may not access the address: one of the private peripheral bus, from thread mode without privilege
/// (ARMv7-M B3.1.1).
fn is_denied<D>(cpu: &Unicorn<'_, D>, address: u32) -> bool {
    address >= 0xe000_0000 && get(cpu, Reg::CONTROL) & 1 != 0 && get(cpu, Reg::XPSR) & 0x1ff == 0
}

/// Load from a device register.
pub(crate) fn on_read<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32, bytes: u8) -> u32 {
    let ipsr = if address & !3 == 0xe000_ed04 { get(cpu, Reg::XPSR) & 0x1ff } else { 0 };
    let denied = is_denied(cpu, address);
    let state = cpu.get_data_mut();
    if denied {
        state.deny(address);
        return 0;
    }
    let now = state.block_at;
    let (register, shift, mask) = match bit_band(address) {
        Some((register, bit)) => (register, bit, 1),
        None => {
            (address & !3, 8 * (address & 3), u32::MAX >> (32 - 8 * u32::from(bytes.clamp(1, 4))))
        }
    };
    match state.chip().read(register, now, ipsr) {
        Ok(value) => value >> shift & mask,
        Err(refusal) => {
            state.refuse(refusal, register, Access::Read(bytes), 0);
            0
        }
    }
}

/// Store to a device register.
pub(crate) fn on_write<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32, bytes: u8, value: u32) {
    let denied = is_denied(cpu, address);
    let state = cpu.get_data_mut();
    if denied {
        return state.deny(address);
    }
    let now = state.block_at;
    let (register, result) = match bit_band(address) {
        // the bus matrix turns the store into a read and a write of the whole register (ARMv7-M B3.1)
        Some((register, bit)) => {
            let result = state.chip().read(register, now, 0).and_then(|old| {
                let new = old & !(1 << bit) | (value & 1) << bit;
                state.chip().write(register, 4, new, now)
            });
            (register, result)
        }
        None => (address, state.chip().write(address, bytes, value, now)),
    };
    if let Err(refusal) = result {
        state.refuse(refusal, register, Access::Write(bytes), value);
    }
    // a new clock moves the cycle at which the run shall pause
    if register & 0xffff_fc00 == 0x4002_3800 {
        state.request_pause();
    }
    if register == FLASH_ACR {
        state.flash_waiting.control(value);
    }
    state.wait_for_flash();
}

/// Load from the flash of the settings.
pub(crate) fn on_flash_read<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32, bytes: u8) -> u32 {
    cpu.get_data_mut().chip().flash.load(address, bytes)
}

/// Store to the flash of the settings.
pub(crate) fn on_flash_write<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32, bytes: u8, value: u32) {
    let state = cpu.get_data_mut();
    let now = state.block_at;
    if let Err(refusal) = state.chip().store_flash(address, bytes, value, now) {
        state.refuse(refusal, address, Access::Write(bytes), value);
    }
    state.wait_for_flash();
}

/// Register and bit behind an address of the peripheral bit-band alias.
fn bit_band(address: u32) -> Option<(u32, u32)> {
    let offset = address.checked_sub(0x4200_0000).filter(|o| *o < 0x0200_0000)?;
    Some((0x4000_0000 + (offset >> 5 & !3), offset >> 2 & 31))
}
