//! The execution path of one exception handler, block by block.
use std::collections::BTreeMap;

/// A basic block that was executed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ExecutedBlock {
    /// Address of its first instruction.
    pub address: u32,
    /// Its length.
    pub bytes: u16,
    /// Cycles of refill after a branch and of waiting for the flash.
    pub waited: u16,
}

/// The basic blocks of all activations of one handler, those of handlers that preempted it excluded.
#[derive(Debug, Clone, Default)]
pub struct ExecutionPath {
    /// Number of executions of each block.
    pub all: BTreeMap<ExecutedBlock, u64>,
    /// The blocks of the activation with the most cycles, in order.
    pub worst: Vec<ExecutedBlock>,
    /// Activations that ended.
    pub activations: u64,
    worst_cycles: u64,
    running: Vec<ExecutedBlock>,
}

impl ExecutionPath {
    pub(super) fn record(&mut self, block: ExecutedBlock) {
        self.running.push(block);
    }

    pub(super) fn finish_activation(&mut self, cycles: u64) {
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
