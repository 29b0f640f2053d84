//! The faults: those of a thermal display that a study lists, and more.
//!
//! What is detectable and which reason is right stands here before anything runs.

mod cooling;
mod electrics;
mod host;
mod processor;
mod sensors;

use super::FaultCase;

/// All of them, in the order of the table.
#[must_use]
pub fn fault_cases() -> Vec<FaultCase> {
    [
        sensors::WIRES,
        sensors::READINGS,
        sensors::SWAPPED,
        sensors::OTHERS,
        electrics::FAULT_CASES,
        cooling::FAULT_CASES,
        host::FAULT_CASES,
        processor::FAULT_CASES,
    ]
    .concat()
}
