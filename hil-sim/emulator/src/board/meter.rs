//! Instructions and cycles of the image since the start of a measurement.

use thermal_sim::engine::Cost;

use crate::{Machine, Wiring};

/// The interrupt that a control tick runs in.
pub const TICK: &str = "DMA2_STREAM0";

/// Totals at the start of the measurement.
#[derive(Clone, Copy, Debug)]
pub struct Meter {
    cycles: u64,
    awake: f64,
}

impl Meter {
    /// Starts the measurement.
    pub fn new<W: Wiring>(machine: &mut Machine<W>) -> Self {
        machine.restart_interrupt_stats();
        let stats = machine.stats();
        Self { cycles: stats.cycles, awake: stats.cycles as f64 * (1.0 - stats.sleep_share) }
    }

    /// The cost since the start; `None` before the first control tick.
    pub fn cost<W: Wiring>(&self, machine: &Machine<W>) -> Option<Cost> {
        let stats = machine.stats();
        let tick = stats.interrupts.iter().find(|interrupt| interrupt.name == TICK)?;
        let awake = stats.cycles as f64 * (1.0 - stats.sleep_share) - self.awake;
        Some(Cost {
            instructions_mean: tick.instructions_mean,
            instructions_max: tick.instructions_max,
            cycles_mean: tick.cycles_mean,
            cycles_max: tick.cycles_max,
            latency_max: tick.latency_max,
            load: awake / (stats.cycles - self.cycles) as f64,
            stack_bytes: machine.stack_high_water(),
        })
    }
}
