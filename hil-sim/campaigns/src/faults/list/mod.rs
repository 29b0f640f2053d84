//! The list of fault cases. Symptoms and correct trip causes are stated here, before any run.

mod cooling;
mod electrics;
mod host;
mod processor;
mod sensors;

use super::FaultCase;

/// All fault cases in the order of the table.
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
