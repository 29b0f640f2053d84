//! Instruction counts and estimated cycles of a basic block.
//!
//! Counts are exact: every instruction of an executed block is counted, those skipped inside an IT block
//! included (they pass the pipeline as one-cycle no-operations). Cycles are an estimate after the Cortex-M4
//! Technical Reference Manual (r0p1, sections 3.3 and 7.2): a load costs one cycle less directly after a load on whose
//! result its address does not depend, and a cycle more directly after data processing that makes its address; the result of a floating-point operation is ready one cycle later for the next
//! instruction; a division of the floating-point unit runs beside integer instructions. The refill of the pipeline after a
//! taken branch is charged with the block to which it leads ([`Block::refill`]), so a conditional branch that is not taken costs
//! none.
//! Waiting for the flash is `flash_waiting.rs`'s.

use super::corrections;
use super::elf::FLASH_BASE;
use super::instruction::{Float, Instruction, Pipeline};

/// Cycles from recognition of an exception to its first instruction (TRM section 3.9.1).
pub(crate) const EXCEPTION_ENTRY: u64 = 12;
/// Cycles of a return from an exception (ARM's figure, without floating-point unstacking).
pub(crate) const EXCEPTION_RETURN: u64 = 10;
/// Cycles between two tail-chained exceptions.
pub(crate) const TAIL_CHAIN: u64 = 6;
/// Cycles to save or restore S0 to S15 and FPSCR: one a word (ARM's application note 298: 29 instead of 12).
pub(crate) const FLOAT_STATE: u64 = 17;

/// Size and cost of a basic block, and the properties that matter to the run loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(align(4))]
pub(crate) struct Block {
    pub bytes: u16,
    pub instructions: u16,
    pub cycles: u16,
    /// Cycles of refill if another block than the one behind it follows.
    pub refill: u8,
    /// Cycles more when a branch leads here: a wide instruction across two words of the fetch.
    pub split: bool,
    /// Line of the flash (128 bits) with the last constant that the block loads from beside the code; 0: none.
    pub constants: u16,
    /// The block holds an instruction of the floating-point unit.
    pub float: bool,
    /// The block holds SEV, which sets the event register of the only core.
    pub sev: bool,
    pub exclusive: Exclusive,
    /// The block holds an instruction that writes PRIMASK, BASEPRI or FAULTMASK; the emulation ends a block behind it.
    pub writes_masks: bool,
    /// The block holds an instruction that `corrections` watches.
    pub suspect: bool,
    pub last: Last,
}

impl Block {
    /// Whether the run loop has more to do than to count the block.
    #[inline]
    pub fn is_special(self) -> bool {
        self.float || self.sev || self.writes_masks || self.exclusive != Exclusive::Unchanged
    }
}

/// What a block leaves of the exclusive monitor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Exclusive {
    /// As it was.
    #[default]
    Unchanged,
    /// Perhaps set, by LDREX.
    Set,
    /// Clear, by STREX or CLREX.
    Clear,
}

/// Last instruction of a block; the run loop distinguishes these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Last {
    #[default]
    Other,
    Wfi,
    Wfe,
    Yield,
}

/// Costs of all blocks executed so far, by address; code in the flash does not change while the machine runs.
pub(crate) struct CostTable {
    blocks: Vec<Block>,
}

impl CostTable {
    pub fn new(flash_bytes: usize) -> Self {
        Self { blocks: vec![Block::default(); flash_bytes / 2] }
    }

    /// The block last executed at an address in the flash.
    #[inline]
    pub fn known(&self, address: u32) -> Option<Block> {
        self.blocks.get((address.wrapping_sub(FLASH_BASE) / 2) as usize).copied()
    }

    /// The block of `bytes` bytes at `offset` into the flash; `None` outside it.
    #[inline]
    pub fn flash_block(&mut self, flash: &[u8], offset: usize, bytes: u32) -> Option<Block> {
        let known = self.blocks.get_mut(offset / 2)?;
        if u32::from(known.bytes) != bytes {
            *known = decode(offset as u32, flash.get(offset..offset + bytes as usize)?);
        }
        Some(*known)
    }
}

/// Decodes straight-line code at an address.
pub(crate) fn decode(address: u32, code: &[u8]) -> Block {
    let mut block = Block { bytes: code.len() as u16, ..Block::default() };
    let mut conditional = false;
    for (at, instruction, cycles) in timed(code) {
        block.cycles += cycles;
        block.instructions += 1;
        block.refill = instruction.refill;
        if let Some(offset) = instruction.constant {
            let from = (address & !FLASH_BASE) + at;
            block.constants = ((from & !3).wrapping_add_signed(offset) / 16) as u16;
        }
        block.split |= at == 0 && instruction.bytes == 4 && address & 2 != 0;
        block.float |= instruction.float != Float::None;
        block.sev |= instruction.code == 0xbf40;
        conditional |= instruction.code & 0xff00 == 0xbf00 && instruction.code & 0xf != 0;
        let second = code.get(at as usize + 2..).and_then(<[u8]>::first_chunk);
        let second = second.map_or(0, |half| u16::from_le_bytes(*half));
        block.writes_masks |= writes_masks(instruction.code, second.into());
        block.suspect |= corrections::is_suspect(instruction.code, second.into());
        match exclusive_access(instruction.code, second.into()) {
            Exclusive::Unchanged => {}
            // a store that its condition skips leaves the monitor as it was
            Exclusive::Clear if conditional => {}
            access => block.exclusive = access,
        }
        block.last = match instruction.code {
            0xbf10 => Last::Yield,
            0xbf20 => Last::Wfe,
            0xbf30 => Last::Wfi,
            _ => Last::Other,
        };
    }
    block
}

/// Offset and estimated cycles of each instruction of straight-line code.
pub(crate) fn instructions(code: &[u8]) -> impl Iterator<Item = (u32, u16)> {
    timed(code).map(|(at, _, cycles)| (at, cycles))
}

/// Offset, meaning and cycles of each instruction of straight-line code. What a division still takes at the end is charged to
/// the last instruction.
fn timed(code: &[u8]) -> impl Iterator<Item = (u32, Instruction, u16)> {
    let mut pipeline = Pipeline::default();
    let mut at = 0;
    std::iter::from_fn(move || {
        let instruction = Instruction::decode(code.get(at..)?)?;
        let start = at;
        at += instruction.bytes;
        let mut cycles = pipeline.cycles(&instruction);
        if at >= code.len() {
            cycles += pipeline.division;
        }
        Some((start as u32, instruction, cycles))
    })
}

/// LDREX, STREX and their forms for bytes and half-words, CLREX.
fn exclusive_access(first: u32, second: u32) -> Exclusive {
    let narrow = matches!(second >> 4 & 0xf, 4 | 5);
    match first & 0xfff0 {
        0xe850 => Exclusive::Set,
        0xe8d0 if narrow => Exclusive::Set,
        0xe840 => Exclusive::Clear,
        0xe8c0 if narrow => Exclusive::Clear,
        0xf3b0 if second == 0x8f2f => Exclusive::Clear,
        _ => Exclusive::Unchanged,
    }
}

/// MSR to PRIMASK, BASEPRI, BASEPRI_MAX or FAULTMASK, and CPS (ARMv7-M B5.2.1 to B5.2.3).
fn writes_masks(first: u32, second: u32) -> bool {
    let msr = first & 0xfff0 == 0xf380 && second & 0xff00 == 0x8800;
    msr && matches!(second & 0xff, 0x10..=0x13) || first & 0xffe8 == 0xb660
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(halves: &[u16]) -> Block {
        let code: Vec<_> = halves.iter().flat_map(|h| h.to_le_bytes()).collect();
        decode(FLASH_BASE, &code)
    }

    fn cycles(halves: &[u16]) -> u16 {
        block(halves).cycles
    }

    /// Cycles with the refill of a taken branch.
    fn taken(halves: &[u16]) -> u16 {
        cycles(halves) + u16::from(block(halves).refill)
    }

    #[test]
    fn costs_are_those_of_the_technical_reference_manual() {
        assert_eq!(cycles(&[0x1840]), 1, "adds r0, r0, r1");
        assert_eq!(cycles(&[0x6808]), 2, "ldr r0, [r1]");
        assert_eq!(cycles(&[0x6008]), 1, "str r0, [r1]");
        assert_eq!(cycles(&[0x5088]), 2, "str r0, [r1, r2]");
        assert_eq!(cycles(&[0xb5f0]), 6, "push of r4 to r7 and lr: 1 + 5");
        assert_eq!(cycles(&[0xe9d1, 0x2300]), 3, "ldrd r2, r3, [r1]");
        assert_eq!(cycles(&[0xe851, 0x0f00]), 2, "ldrex r0, [r1]");
        assert_eq!(cycles(&[0xfb00, 0xf001]), 1, "mul r0, r0, r1");
        assert_eq!(cycles(&[0xfba0, 0x2301]), 1, "umull r2, r3, r0, r1");
        assert_eq!(cycles(&[0xfbe0, 0x2361]), 1, "umaal r2, r3, r0, r1");
        assert_eq!(cycles(&[0xfbb0, 0xf0f1]), 7, "udiv r0, r0, r1: 2 to 12");
        assert_eq!(cycles(&[0xee30, 0x0a20]), 1, "vadd.f32 s0, s0, s1");
        assert_eq!(cycles(&[0xee00, 0x0a81]), 3, "vmla.f32 s0, s1, s2");
        assert_eq!(cycles(&[0xed91, 0x0a00]), 2, "vldr s0, [r1]");
        assert_eq!(cycles(&[0xed91, 0x0b00]), 3, "vldr d0, [r1]");
    }

    #[test]
    fn a_taken_branch_refills_the_pipeline() {
        assert_eq!(cycles(&[0xd0fe]), 1, "beq, not taken");
        assert_eq!(taken(&[0xd0fe]), 3, "beq");
        assert_eq!(taken(&[0x4770]), 3, "bx lr");
        assert_eq!(taken(&[0xbdf0]), 9, "pop of r4 to r7 and pc: 1 + 5 + 3");
        assert_eq!(taken(&[0xf851, 0xf002]), 5, "ldr pc, [r1, r2]: at least 5");
        assert_eq!(taken(&[0xe8df, 0xf000]), 6, "tbb [pc, r0]: at least 6");
        let wide = [0xf240, 0x0000u16].map(u16::to_le_bytes).concat();
        assert!(decode(FLASH_BASE + 2, &wide).split && !decode(FLASH_BASE + 4, &wide).split);
    }

    /// The pairs of the manual's section on load and store timings.
    #[test]
    fn loads_go_through_the_pipeline_behind_independent_loads() {
        assert_eq!(cycles(&[0x6808, 0x6811]), 3, "ldr r0, [r1]; ldr r1, [r2]");
        assert_eq!(cycles(&[0x5888, 0x6158]), 3, "ldr r0, [r1, r2]; str r0, [r3, #20]");
        assert_eq!(cycles(&[0x5888, 0x5099]), 3, "ldr r0, [r1, r2]; str r1, [r3, r2]");
        assert_eq!(
            cycles(&[0x5948, 0x6811, 0x685a]),
            4,
            "ldr r0, [r1, r5]; ldr r1, [r2]; ldr r2, [r3, #4]"
        );
        assert_eq!(cycles(&[0x6809, 0x680a]), 4, "ldr r1, [r1]; ldr r2, [r1]");
        assert_eq!(cycles(&[0x3104, 0x680a]), 4, "adds r1, #4; ldr r2, [r1]");
        assert_eq!(cycles(&[0x3104, 0x6812]), 3, "adds r1, #4; ldr r2, [r2]");
        assert_eq!(cycles(&[0xb087, 0xb410]), 4, "sub sp, #28; push of r4");
    }

    #[test]
    fn floating_point_results_come_late_and_divisions_run_beside_integer_instructions() {
        let add = [0xee30, 0x0a20]; // vadd.f32 s0, s0, s1
        let other = [0xee32, 0x2aa2]; // vadd.f32 s4, s5, s5
        let sequence = |parts: &[&[u16]]| cycles(&parts.concat());
        assert_eq!(sequence(&[&add, &add]), 3);
        assert_eq!(sequence(&[&add, &other, &add]), 3);
        let divide: [u16; 2] = [0xee80, 0x0a20]; // vdiv.f32 s0, s0, s1
        let square_root: [u16; 2] = [0xeeb1, 0x0ac0]; // vsqrt.f32 s0, s0
        assert_eq!(sequence(&[&divide]), 14);
        assert_eq!(sequence(&[&square_root]), 14);
        assert_eq!(sequence(&[&divide, &[0x1840; 5]]), 14);
        assert_eq!(sequence(&[&divide, &[0x1840; 20]]), 21);
        assert_eq!(sequence(&[&divide, &other]), 15);
    }

    #[test]
    fn a_decoded_block_has_its_instruction_count_and_last_instruction() {
        let b = block(&[0xbf40, 0xee30, 0x0a20, 0xbf30]);
        assert_eq!((b.instructions, b.bytes, b.last), (3, 8, Last::Wfi));
        assert!(b.float && b.sev);
        // ldr r0, [pc, #16] at the second half-word: 4 ahead of the word that holds it, and 16.
        assert_eq!(block(&[0xbf00, 0x4804]).constants, 1);
    }

    #[test]
    fn a_decoded_block_tells_whether_it_leaves_the_exclusive_monitor_set() {
        const LDREX: [u16; 2] = [0xe850, 0x0f00];
        const STREX: [u16; 2] = [0xe840, 0x1000];
        const LDRD: [u16; 2] = [0xe9d0, 0x0100];
        let exclusive = |halves: &[[u16; 2]]| block(halves.as_flattened()).exclusive;
        assert_eq!(exclusive(&[LDRD]), Exclusive::Unchanged);
        assert_eq!(exclusive(&[LDREX]), Exclusive::Set);
        assert_eq!(exclusive(&[LDREX, STREX]), Exclusive::Clear);
        assert_eq!(exclusive(&[LDREX, [0xf3bf, 0x8f2f]]), Exclusive::Clear, "clrex");
        let it_eq_nop = [0xbf08, 0xbf00];
        assert_eq!(exclusive(&[LDREX, it_eq_nop, STREX]), Exclusive::Set);
    }
}
