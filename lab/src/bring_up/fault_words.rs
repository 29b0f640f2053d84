//! What the device's fault words mean to a person at the bench.

use thermal_client::{FaultWords, fault_words};
use thermal_device::safety::Fault;

/// What to look at when the device reports a fault; `None` for a word that is none.
pub fn explanation(word: &str) -> Option<String> {
    let fault = Fault::ALL.iter().find(|fault| fault.name() == word)?;
    let FaultWords { meaning, remedy } = fault_words(*fault);
    Some(format!("{meaning}: {remedy}"))
}
