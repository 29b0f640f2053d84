//! The core's write buffer: a store to a slow bus may still be under way at the return of a handler, and the core can then enter
//! the wrong handler next (Arm's errata notice of the Cortex-M4, 838869). A DSB behind the last store waits for it.

/// Longest time of a store to a peripheral, in instructions: three clocks of APB1, at a quarter of the core's. Each instruction
/// takes a cycle at least.
const STORE_INSTRUCTIONS: u8 = 12;

/// The last store to a peripheral, while it may be under way.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct WriteBuffer(Option<(u32, u8)>);

impl WriteBuffer {
    /// Takes note of a store to a register.
    pub(super) fn store(&mut self, register: u32) {
        self.0 = Some((register, STORE_INSTRUCTIONS));
    }

    /// The register whose store may be under way.
    pub(super) fn register(self) -> Option<u32> {
        self.0.map(|(register, _)| register)
    }

    /// Takes note of an instruction before it runs.
    pub(super) fn note_instruction(&mut self, is_dsb: bool) {
        self.0 = self.0.filter(|(_, left)| !is_dsb && *left > 0).map(|(at, left)| (at, left - 1));
    }
}
