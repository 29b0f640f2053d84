//! The way that one exception handler takes through the code, block by block.
use std::collections::BTreeMap;

/// A basic block that ran: address and bytes.
pub type Ran = (u32, u16);

/// The basic blocks of all activations of one handler, those of handlers that preempted it excluded.
#[derive(Debug, Clone, Default)]
pub struct Path {
    /// How often each block ran.
    pub all: BTreeMap<Ran, u64>,
    /// The blocks of the activation that took most cycles, in their order.
    pub worst: Vec<Ran>,
    /// Activations that ended.
    pub activations: u64,
    worst_cycles: u64,
    running: Vec<Ran>,
}

impl Path {
    pub(super) fn ran(&mut self, block: Ran) {
        self.running.push(block);
    }

    pub(super) fn ended(&mut self, cycles: u64) {
        for block in &self.running {
            *self.all.entry(*block).or_default() += 1;
        }
        if cycles > self.worst_cycles {
            self.worst_cycles = cycles;
            std::mem::swap(&mut self.worst, &mut self.running);
        }
        self.running.clear();
        self.activations += 1;
    }
}
