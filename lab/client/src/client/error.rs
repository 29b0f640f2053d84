//! Why a command has no reply.

use std::time::Duration;

use super::split_finger;
use crate::link::LinkError;

/// Why a command has no reply.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ClientError {
    /// The device refused the line and said why.
    #[error("the device answers '{line}' with '{answer}'")]
    Refused {
        /// The line.
        line: String,
        /// The answer, with its `err`.
        answer: String,
    },
    /// The device did not answer.
    #[error("the device does not answer '{line}' within {} s", tenths(*timeout))]
    TimedOut {
        /// The line.
        line: String,
        /// How long the client waited.
        timeout: Duration,
    },
    /// The device can no longer be reached, or the wait was interrupted.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The device sent something that is no answer to the line.
    #[error("the answer to '{line}' is not understood: '{answer}'")]
    NotUnderstood {
        /// The line.
        line: String,
        /// What the device sent.
        answer: String,
    },
    /// Something answers, but never to the line that only a thermal display repeats.
    #[error("this does not answer as a thermal display: '{answer}'")]
    NoDisplay {
        /// Its last answer.
        answer: String,
    },
    /// The device has accepted `abort`, and a finger's state is still one in which its bridge is driven.
    #[error("'abort' was accepted, but finger {finger} is in state {state}")]
    StillDriven {
        /// Finger, counted from 0.
        finger: u8,
        /// Word of the state that this finger reports.
        state: &'static str,
    },
    /// The device has not confirmed that its bridges are off.
    #[error(
        "THE BRIDGE MAY STILL BE ON: 'abort' was not confirmed ({why}). PRESS THE EMERGENCY STOP"
    )]
    NotOff {
        /// What happened instead of a confirmation.
        why: String,
    },
    /// The line cannot be sent.
    #[error("'{line}' cannot be sent: a line has 1 to {max} printable ASCII characters", max = thermal_protocol::LINE_MAX_BYTES)]
    Unsendable {
        /// The line.
        line: String,
    },
}

/// Seconds, rounded to tenths.
fn tenths(time: Duration) -> f64 {
    (time.as_secs_f64() * 10.0).round() / 10.0
}

impl ClientError {
    /// [`Self::NotOff`] for this reason.
    #[must_use]
    pub fn not_off(self) -> Self {
        match self {
            Self::NotOff { .. } => self,
            error => Self::NotOff { why: error.to_string() },
        }
    }

    /// The device's reason, without finger and `err`, if it refused the line.
    pub fn refusal(&self) -> Option<&str> {
        let Self::Refused { answer, .. } = self else {
            return None;
        };
        let (_, content) = split_finger(answer);
        content.strip_prefix("err").map(str::trim_start)
    }
}
