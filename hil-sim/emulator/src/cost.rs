//! Instruction counts and estimated cycles of a basic block.
//!
//! Counts are exact: every instruction of an executed block is counted, those skipped inside an IT block
//! included (they pass the pipeline as one-cycle no-operations). Cycles are an estimate after the Cortex-M4
//! Technical Reference Manual (r0p1, tables 3-1 and 7-1): zero-wait-state memory (the flash accelerator hides
//! the wait states of straight code), two cycles of refill for a taken branch, a conditional branch taken half
//! the time, divisions at the middle of their range, no pairing of neighbouring loads.

use super::elf::FLASH_BASE;

/// Cycles from recognition of an exception to its first instruction (TRM section 3.9.1).
pub(crate) const EXCEPTION_ENTRY: u64 = 12;
/// Cycles of a return from an exception (ARM's figure, without floating-point unstacking).
pub(crate) const EXCEPTION_RETURN: u64 = 10;
/// Cycles between two tail-chained exceptions.
pub(crate) const TAIL_CHAIN: u64 = 6;

/// Size and cost of a basic block, and the properties that matter to the run loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(align(4))]
pub(crate) struct Block {
    pub bytes: u16,
    pub instructions: u16,
    pub cycles: u16,
    /// The block holds an instruction of the floating-point unit.
    pub float: bool,
    /// The block holds SEV, which sets the event register of the only core.
    pub sev: bool,
    pub last: Last,
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
        Self {
            blocks: vec![Block::default(); flash_bytes / 2],
        }
    }

    /// The block last executed at an address in the flash.
    #[inline]
    pub fn known(&self, address: u32) -> Option<Block> {
        self.blocks
            .get((address.wrapping_sub(FLASH_BASE) / 2) as usize)
            .copied()
    }

    /// The block of `bytes` bytes at `offset` into the flash; `None` outside it.
    #[inline]
    pub fn flash_block(&mut self, flash: &[u8], offset: usize, bytes: u32) -> Option<Block> {
        let known = self.blocks.get_mut(offset / 2)?;
        if u32::from(known.bytes) != bytes {
            *known = decode(flash.get(offset..offset + bytes as usize)?);
        }
        Some(*known)
    }
}

/// Decodes straight-line code.
pub(crate) fn decode(code: &[u8]) -> Block {
    let mut block = Block {
        bytes: code.len() as u16,
        ..Block::default()
    };
    let half = |at: usize| {
        code.get(at..at + 2)
            .map_or(0, |b| u32::from(u16::from_le_bytes([b[0], b[1]])))
    };
    let mut at = 0;
    while at < code.len() {
        let first = half(at);
        let wide = first >> 11 >= 0b11101;
        let second = if wide { half(at + 2) } else { 0 };
        block.cycles += if wide {
            wide_cost(first, second)
        } else {
            narrow_cost(first)
        };
        block.instructions += 1;
        block.float |= wide && is_float(first);
        block.sev |= first == 0xbf40;
        block.last = match first {
            0xbf10 => Last::Yield,
            0xbf20 => Last::Wfe,
            0xbf30 => Last::Wfi,
            _ => Last::Other,
        };
        at += if wide { 4 } else { 2 };
    }
    block
}

/// Offset and estimated cycles of each instruction of straight-line code.
pub(crate) fn instructions(code: &[u8]) -> impl Iterator<Item = (u32, u16)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let start = at;
        let wide = *code.get(at + 1)? >> 3 >= 0b11101;
        at += if wide { 4 } else { 2 };
        Some((start as u32, decode(code.get(start..at)?).cycles))
    })
}

/// Coprocessor space with coprocessor number 10 or 11 is the floating-point unit.
fn is_float(first: u32) -> bool {
    first & 0xec00 == 0xec00
}

fn narrow_cost(op: u32) -> u16 {
    let registers = (op & 0xff).count_ones() as u16;
    match op >> 12 {
        0x4 if op & 0xff00 == 0x4700 => 3,  // BX, BLX
        0x4 if op & 0xfc87 == 0x4487 => 3,  // ADD or MOV to PC
        0x4 if op & 0xf800 == 0x4800 => 2,  // LDR literal
        0x5 if op & 0x0e00 >= 0x0600 => 2,  // LDR register, LDRSB
        0x6..=0x9 if op & 0x0800 != 0 => 2, // LDR immediate
        0xb if op & 0xfe00 == 0xb400 => 1 + registers + (op >> 8 & 1) as u16, // PUSH
        0xb if op & 0xff00 == 0xbd00 => 4 + registers, // POP with PC
        0xb if op & 0xff00 == 0xbc00 => 1 + registers, // POP
        0xb if op & 0xf500 == 0xb100 => 2,  // CBZ, CBNZ
        0xc => 1 + registers,               // LDM, STM
        0xd => 2,                           // conditional branch
        0xe => 3,                           // B
        _ => 1,
    }
}

fn wide_cost(first: u32, second: u32) -> u16 {
    let registers = second.count_ones() as u16;
    let loads = first & 0x10 != 0;
    match first >> 11 & 3 {
        _ if is_float(first) => float_cost(first, second),
        1 if first & 0x0640 == 0 && loads && second >> 15 == 1 => 3 + registers, // LDM with PC
        1 if first & 0x0640 == 0 => 1 + registers,                               // LDM, STM
        1 if first & 0xfff0 == 0xe8d0 && second & 0xe0 == 0 => 4,                // TBB, TBH
        1 if first & 0x0600 == 0 => 3,  // LDRD, STRD, LDREX
        1 => 1,                         // data processing, shifted register
        2 if second & 0x8000 == 0 => 1, // data processing, immediate
        2 if second & 0x5000 == 0 && first & 0x0380 == 0x0380 => 1, // MSR, MRS, hints
        2 if second & 0x5000 == 0 => 2, // conditional branch
        2 => 3,                         // B, BL
        _ if first & 0x0600 == 0 && loads => 2,
        _ if first & 0xffd0 == 0xfb90 => 7, // SDIV, UDIV: 2 to 12
        _ => 1,                             // stores are buffered; multiplication, also long
    }
}

fn float_cost(first: u32, second: u32) -> u16 {
    let memory = first & 0x0e00 == 0x0c00;
    let pair_or_single = first & 0x0fe0 == 0x0c40 || first & 0x0120 == 0x0100;
    match first >> 4 & 0xb {
        _ if memory && pair_or_single => 2, // VMOV of a pair, VLDR, VSTR
        _ if memory => 1 + (second & 0xff) as u16, // VLDM, VSTM, VPUSH, VPOP
        _ if second & 0x10 != 0 => 1,       // moves to and from core registers
        0x8 => 14,                          // VDIV
        0xb if second & 0xc0 == 0xc0 && first & 0xf == 1 => 14, // VSQRT
        0x0 | 0x1 | 0x9 | 0xa => 3,         // VMLA, VNMLA, VFMA, VFNMA
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(halves: &[u16]) -> Block {
        decode(
            &halves
                .iter()
                .flat_map(|h| h.to_le_bytes())
                .collect::<Vec<_>>(),
        )
    }

    #[test]
    fn costs_are_those_of_the_technical_reference_manual() {
        let cycles = |halves: &[u16]| block(halves).cycles;
        assert_eq!(cycles(&[0x1840]), 1, "adds r0, r0, r1");
        assert_eq!(cycles(&[0x6808]), 2, "ldr r0, [r1]");
        assert_eq!(cycles(&[0x6008]), 1, "str r0, [r1]");
        assert_eq!(cycles(&[0xb5f0]), 6, "push of r4 to r7 and lr: 1 + 5");
        assert_eq!(
            cycles(&[0xbdf0]),
            8,
            "pop of r4 to r7 and pc: 1 + 5 and the refill"
        );
        assert_eq!(cycles(&[0xfb00, 0xf001]), 1, "mul r0, r0, r1");
        assert_eq!(cycles(&[0xfba0, 0x2301]), 1, "umull r2, r3, r0, r1");
        assert_eq!(cycles(&[0xfbb0, 0xf0f1]), 7, "udiv r0, r0, r1");
        assert_eq!(cycles(&[0xee30, 0x0a20]), 1, "vadd.f32 s0, s0, s1");
        assert_eq!(cycles(&[0xee80, 0x0a20]), 14, "vdiv.f32 s0, s0, s1");
        assert_eq!(cycles(&[0xeeb1, 0x0ac0]), 14, "vsqrt.f32 s0, s0");
        assert_eq!(cycles(&[0xee00, 0x0a81]), 3, "vmla.f32 s0, s1, s2");
    }

    #[test]
    fn a_decoded_block_has_its_instruction_count_and_last_instruction() {
        let b = block(&[0xbf40, 0xee30, 0x0a20, 0xbf30]);
        assert_eq!((b.instructions, b.bytes, b.last), (3, 8, Last::Wfi));
        assert!(b.float && b.sev);
    }
}
