//! The cycle counter of the core (DWT_CYCCNT), and statistics of what it measures.

use cortex_m::peripheral::{DCB, DWT, Peripherals};

/// Starts the counter.
pub fn start() {
    // SAFETY: nothing else uses the trace unit.
    let mut core = unsafe { Peripherals::steal() };
    DCB::enable_trace(&mut core.DCB);
    DWT::unlock();
    core.DWT.enable_cycle_counter();
}

/// Cycles of the core, modulo 2^32.
pub fn now() -> u32 {
    DWT::cycle_count()
}

/// Calls `work` and returns its result with its cycles.
pub fn measure<T>(work: impl FnOnce() -> T) -> (T, u32) {
    let start = now();
    let result = work();
    (result, now().wrapping_sub(start))
}

/// Mean and largest of several costs.
#[derive(Default)]
pub struct Costs {
    sum: u64,
    count: u32,
    pub max: u32,
}

impl Costs {
    pub fn add(&mut self, cycles: u32) {
        self.sum += u64::from(cycles);
        self.count += 1;
        self.max = self.max.max(cycles);
    }

    pub fn mean(&self) -> u64 {
        self.sum.checked_div(self.count.into()).unwrap_or(0)
    }
}
