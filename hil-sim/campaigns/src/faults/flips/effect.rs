//! The effect of a bit flip.

use serde::Serialize;
use thermal_sim::named_enum;
use thermal_sim::run::Outcome;

use crate::faults::RunAssessment;
use crate::faults::assessment::WORKING_STATES;

named_enum! {
    /// Effect of a bit flip on the finger and the device.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum FlipEffect {
        /// Trace and answers equal those of the run without the flip.
        Nothing = "no effect",
        /// Something in the trace or the answers differs, and no limit is broken.
        Differs = "differs, safe",
        /// The device no longer answers the host, and no limit is broken.
        Silent = "silent",
        /// The device tripped, by itself or after a reset.
        Tripped = "tripped",
        /// The device was reset and is off without a fault.
        Reset = "reset",
        /// The run ended because something happened that the emulator does not model.
        Ended = "ended",
        /// Not injected: the emulator has no such bit or does not model its flip.
        Refused = "not injected",
        /// A limit was broken: skin temperature, dose, or current more than 50 ms after a symptom.
        Broken = "limit broken",
    }
}

impl FlipEffect {
    /// Classifies a run that reached its end, by comparison with the run without the flip.
    pub(super) fn of(assessment: &RunAssessment, outcome: &Outcome, reference: &Outcome) -> Self {
        let same =
            outcome.trace.rows() == reference.trace.rows() && outcome.answers == reference.answers;
        match assessment.reason.as_str() {
            _ if !assessment.breaches.is_empty() => Self::Broken,
            _ if same && outcome.resets == reference.resets => Self::Nothing,
            "silent" => Self::Silent,
            "off" => Self::Reset,
            state if WORKING_STATES.contains(&state) => Self::Differs,
            _ => Self::Tripped,
        }
    }
}

/// Largest difference of the display temperature from the run without the flip, K.
pub(super) fn deviation_k(outcome: &Outcome, reference: &Outcome) -> f64 {
    let rows = outcome.trace.rows().iter().zip(reference.trace.rows());
    rows.map(|(row, reference)| (row.display_c - reference.display_c).abs()).fold(0.0, f64::max)
}
