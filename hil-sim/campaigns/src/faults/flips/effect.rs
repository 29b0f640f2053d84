//! What a flip was for the finger.

use serde::Serialize;
use thermal_sim::run::Outcome;

use crate::faults::RunAssessment;

/// The first that is so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FlipEffect {
    /// The emulated machine has no such bit, or does not model its flip: nothing has run.
    Refused,
    /// The run ended with something that is not modelled.
    Ended,
    /// A limit was broken: skin, dose, or current later than 50 ms after a sign.
    Broken,
    /// The device tripped, by itself or after a reset.
    Tripped,
    /// It was reset, and is off without a fault.
    Reset,
    /// The host hears nothing any more, no limit is broken.
    Silent,
    /// Something in the trace differs, no limit is broken.
    Differs,
    /// Trace and answers are those without the flip.
    Nothing,
}

impl FlipEffect {
    /// All, in the order of the table.
    pub const ALL: [Self; 8] = [
        Self::Nothing,
        Self::Differs,
        Self::Silent,
        Self::Tripped,
        Self::Reset,
        Self::Ended,
        Self::Refused,
        Self::Broken,
    ];

    /// A few words for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Refused => "not injected",
            Self::Ended => "ended",
            Self::Broken => "limit broken",
            Self::Tripped => "tripped",
            Self::Reset => "reset",
            Self::Silent => "silent",
            Self::Differs => "differs, safe",
            Self::Nothing => "no effect",
        }
    }

    /// Of a run that came to its end.
    pub(super) fn of(assessment: &RunAssessment, outcome: &Outcome, reference: &Outcome) -> Self {
        let same =
            outcome.trace.rows() == reference.trace.rows() && outcome.answers == reference.answers;
        match assessment.reason.as_str() {
            _ if !assessment.breaches.is_empty() => Self::Broken,
            _ if same && outcome.resets == reference.resets => Self::Nothing,
            "silent" => Self::Silent,
            "off" => Self::Reset,
            "self-test" | "ready" | "armed" | "preset" | "contact" => Self::Differs,
            _ => Self::Tripped,
        }
    }
}

/// Most that the display was off its reference, K.
pub(super) fn deviation_k(outcome: &Outcome, reference: &Outcome) -> f64 {
    let rows = outcome.trace.rows().iter().zip(reference.trace.rows());
    rows.map(|(row, reference)| (row.display_c - reference.display_c).abs())
        .fold(0.0, f64::max)
}
