//! The faults: those of a thermal display that a study lists, and more.
//!
//! What is detectable and which reason is right stands here before anything runs.

mod cooling;
mod electrics;
mod host;
mod processor;
mod sensors;

use super::Entry;

/// All of them, in the order of the table.
#[must_use]
pub fn entries() -> Vec<Entry> {
    [
        sensors::WIRES,
        sensors::READINGS,
        sensors::SWAPPED,
        sensors::OTHERS,
        electrics::ENTRIES,
        cooling::ENTRIES,
        host::ENTRIES,
        processor::ENTRIES,
    ]
    .concat()
}
