//! The procedure: all stages in the order of power.
//!
//! Limits are worked out from the netlists and the bill of materials in `hardware/`; a test compares the nominal values with
//! the netlists.

mod bare_board;
mod bridge;
mod chip;
mod comparator;
mod needs;
mod sensors;
mod supply;
mod tile;

use super::check::{Check, Expected, ManualStep, Reading, Routine, Stage, StageId, Step};
use super::unit::Unit;

pub use sensors::KNOWN_OHM;

/// All stages in their order.
pub const STAGES: [Stage; 13] = [
    bare_board::STAGE,
    supply::RAILS,
    chip::CHIP,
    bridge::LINE,
    chip::RESET,
    sensors::STAGE,
    supply::SUPPLY,
    comparator::LATCH,
    comparator::EDGES,
    bridge::LOAD,
    tile::TILE,
    tile::COMMISSIONING,
    tile::RUN,
];

/// Something to do by hand, as text and as lines to the surroundings.
const fn manual(say: &'static str, lines: &'static [&'static str]) -> Step {
    Step::Manual(ManualStep { say, lines })
}

/// What the program does with the device.
const fn routine(routine: Routine) -> Step {
    Step::Routine(routine)
}

/// A reading of an instrument.
const fn meter(
    name: &'static str,
    what: &'static str,
    point: &'static str,
    how: &'static str,
) -> CheckBuilder {
    read(name, what, Reading::Meter { point, how })
}

/// A reading of any kind.
const fn read(name: &'static str, what: &'static str, reading: Reading) -> CheckBuilder {
    CheckBuilder(Check {
        name,
        what,
        reading,
        expected: Expected::Words(&[]),
        basis: "",
        low: "",
        high: "",
        blocks: None,
    })
}

/// A check whose fields are given one after another.
struct CheckBuilder(Check);

impl CheckBuilder {
    const fn range(mut self, least: f64, most: f64, unit: Unit) -> Self {
        self.0.expected = Expected::Range(least, most, unit);
        self
    }

    const fn words(mut self, words: &'static [&'static str]) -> Self {
        self.0.expected = Expected::Words(words);
        self
    }

    const fn basis(mut self, basis: &'static str) -> Self {
        self.0.basis = basis;
        self
    }

    const fn low(mut self, low: &'static str) -> Self {
        self.0.low = low;
        self
    }

    const fn high(mut self, high: &'static str) -> Self {
        self.0.high = high;
        self
    }

    /// What is broken, whichever way the value is off.
    const fn finding(self, finding: &'static str) -> Self {
        self.low(finding).high(finding)
    }

    const fn blocks(mut self, stage: StageId) -> Self {
        self.0.blocks = Some(stage);
        self
    }

    const fn step(self) -> Step {
        Step::Check(self.0)
    }
}
