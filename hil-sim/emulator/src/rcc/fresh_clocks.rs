//! Clocks that were enabled a moment ago: what is written to a peripheral right behind the enabling of its clock can be lost
//! (errata sheet ES0298, 2.2.7).
//!
//! Remedies are a DSB, or as many instructions as the clock takes to arrive. The sheet also names a read of "the corresponding
//! register"; on other chips of this family, which have the same entry, such reads were observed not to help, so here they count
//! as any other instruction.
use super::ENR_NAMES;

const BUSES: usize = ENR_NAMES.len();

/// Peripherals whose clock was enabled and does not run yet, by the place of their bus in `ENR_NAMES`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct FreshClocks {
    /// Bits that were set in the enable register of the bus.
    bits: [u32; BUSES],
    /// Instructions that are still to pass.
    instructions: [u32; BUSES],
}

impl FreshClocks {
    /// Adds clocks that a store has enabled, and that run after so many further instructions.
    pub(super) fn add(&mut self, bus: usize, bits: u32, instructions: u32) {
        if bits != 0 {
            self.bits[bus] |= bits;
            self.instructions[bus] = instructions;
        }
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.bits == [0; BUSES]
    }

    /// Whether the clock of a bit is one of them.
    pub(super) fn contains(&self, bus: usize, bit: u8) -> bool {
        self.bits[bus] >> bit & 1 != 0
    }

    /// Takes note of an instruction before it runs: every one takes a cycle at least, and a DSB waits for all clocks.
    pub(super) fn note_instruction(&mut self, is_dsb: bool) {
        if is_dsb {
            *self = Self::default();
        }
        for (bits, instructions) in self.bits.iter_mut().zip(&mut self.instructions) {
            match instructions.checked_sub(1) {
                Some(left) => *instructions = left,
                None => *bits = 0,
            }
        }
    }
}
