//! Instructions and cycles of each exception handler.
use super::execution_path::{ExecutedBlock, ExecutionPath};
use super::nvic::{self, EXCEPTIONS};

/// Statistics of one exception handler since power-up or the last restart.
#[derive(Debug, Clone, PartialEq)]
pub struct InterruptStats {
    /// Name in the reference manual's vector table.
    pub name: &'static str,
    /// Times entered.
    pub count: u64,
    /// Instructions of one activation, those of handlers that preempted it excluded.
    pub instructions_mean: f64,
    /// Fewest instructions of one activation.
    pub instructions_min: u64,
    /// Most instructions of one activation.
    pub instructions_max: u64,
    /// Estimated cycles of one activation with its entry and return, preemption excluded.
    pub cycles_mean: f64,
    /// Fewest cycles of one activation.
    pub cycles_min: u64,
    /// Most cycles of one activation.
    pub cycles_max: u64,
    /// Longest time from request to first instruction, cycles; accurate to a basic block.
    pub latency_max: u64,
}

/// Statistics since power-up.
#[derive(Debug, Clone, PartialEq)]
pub struct Stats {
    /// Instructions executed, exact to the present basic block.
    pub instructions: u64,
    /// CPU cycles passed, sleep included.
    pub cycles: u64,
    /// Exceptions entered.
    pub exceptions: u64,
    /// Share of the cycles spent asleep, 0 to 1.
    pub sleep_share: f64,
    /// Longest time for which PRIMASK, BASEPRI or FAULTMASK has masked exceptions that the running code does not mask by its
    /// own priority, cycles since the last restart of the interrupts' statistics; what preempts it excluded.
    pub masked_max: u64,
    /// Every exception that was entered at least once, by number.
    pub interrupts: Vec<InterruptStats>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Total {
    count: u64,
    instructions: u64,
    instructions_min: u64,
    instructions_max: u64,
    cycles: u64,
    cycles_min: u64,
    cycles_max: u64,
    latency_max: u64,
}

#[derive(Debug, Clone, Copy)]
/// An activation of a handler that has not returned.
struct Activation {
    exception: usize,
    instructions: u64,
    cycles: u64,
}

/// Attributes instructions and cycles to the exception handlers, preemption excluded.
pub(crate) struct Profile {
    totals: Vec<Total>,
    open: Vec<Activation>,
    charged_to: (u64, u64),
    /// Number of open activations when the innermost of them began to mask exceptions, and its cycles then; in thread mode the
    /// cycles since power-up.
    masked_from: Option<(usize, u64)>,
    masked_max: u64,
    /// The exception whose blocks are recorded, and the record.
    watched: Option<(usize, Box<ExecutionPath>)>,
    /// Its handler is running.
    pub watching: bool,
}

impl Profile {
    pub fn new() -> Self {
        Self {
            totals: vec![Total::default(); EXCEPTIONS],
            open: Vec::with_capacity(16),
            charged_to: (0, 0),
            masked_from: None,
            masked_max: 0,
            watched: None,
            watching: false,
        }
    }

    /// Attributes what ran since the last switch to the innermost activation.
    fn charge(&mut self, instructions: u64, cycles: u64) {
        if let Some(top) = self.open.last_mut() {
            top.instructions += instructions - self.charged_to.0;
            top.cycles += cycles - self.charged_to.1;
        }
        self.charged_to = (instructions, cycles);
    }

    pub fn enter(&mut self, exception: usize, latency: u64, instructions: u64, cycles: u64) {
        self.charge(instructions, cycles);
        self.open.push(Activation { exception, instructions: 0, cycles: 0 });
        self.update_watching();
        let total = &mut self.totals[exception];
        total.latency_max = total.latency_max.max(latency);
    }

    pub fn leave(&mut self, instructions: u64, cycles: u64) {
        self.charge(instructions, cycles);
        if let Some(done) = self.open.pop() {
            if let Some((watched, path)) = &mut self.watched
                && *watched == done.exception
            {
                path.finish_activation(done.cycles);
            }
            let total = &mut self.totals[done.exception];
            if total.count == 0 {
                (total.instructions_min, total.cycles_min) = (done.instructions, done.cycles);
            }
            total.count += 1;
            total.instructions += done.instructions;
            total.instructions_min = total.instructions_min.min(done.instructions);
            total.instructions_max = total.instructions_max.max(done.instructions);
            total.cycles += done.cycles;
            total.cycles_min = total.cycles_min.min(done.cycles);
            total.cycles_max = total.cycles_max.max(done.cycles);
        }
        self.update_watching();
    }

    /// Begins or ends the time for which the running code masks exceptions.
    pub fn set_masked(&mut self, masked: bool, instructions: u64, cycles: u64) {
        self.charge(instructions, cycles);
        let now = self.open.last().map_or(cycles, |top| top.cycles);
        match self.masked_from {
            None if masked => self.masked_from = Some((self.open.len(), now)),
            // A handler that preempts restores the masks at its end.
            Some((depth, from)) if !masked && depth == self.open.len() => {
                self.masked_from = None;
                self.masked_max = self.masked_max.max(now.saturating_sub(from));
            }
            _ => {}
        }
    }

    /// Longest time for which the running code has masked exceptions, cycles.
    pub const fn masked_max(&self) -> u64 {
        self.masked_max
    }

    fn update_watching(&mut self) {
        let running = self.open.last().map(|open| open.exception);
        self.watching =
            running.is_some() && running == self.watched.as_ref().map(|(watched, _)| *watched);
    }

    /// Records the blocks of an exception from its next activation on.
    pub fn watch(&mut self, exception: usize) {
        self.watched = Some((exception, Box::default()));
    }

    /// Records a block of the watched exception.
    #[cold]
    pub fn record(&mut self, block: ExecutedBlock) {
        if let Some((_, path)) = &mut self.watched {
            path.record(block);
        }
    }

    pub fn path(&self) -> Option<&ExecutionPath> {
        self.watched.as_ref().map(|(_, path)| &**path)
    }

    /// Ends every activation, at a reset.
    pub fn end_all(&mut self) {
        self.open.clear();
        self.masked_from = None;
        self.update_watching();
    }

    /// Clears the statistics; running activations are counted when they end.
    pub fn restart(&mut self) {
        self.totals.fill(Total::default());
        self.masked_max = 0;
    }

    pub fn interrupts(&self) -> Vec<InterruptStats> {
        let mean = |sum: u64, count: u64| sum as f64 / count as f64;
        self.totals
            .iter()
            .enumerate()
            .filter(|(_, t)| t.count > 0)
            .map(|(n, t)| InterruptStats {
                name: nvic::name(n),
                count: t.count,
                instructions_mean: mean(t.instructions, t.count),
                instructions_min: t.instructions_min,
                instructions_max: t.instructions_max,
                cycles_mean: mean(t.cycles, t.count),
                cycles_min: t.cycles_min,
                cycles_max: t.cycles_max,
                latency_max: t.latency_max,
            })
            .collect()
    }
}
