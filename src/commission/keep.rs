//! Settings that outlive the power: `save` and `forget`.
//!
//! The flash is written by a device that does nothing else. So an order is obeyed by starting anew: what is to be stored waits in a
//! memory that a reset does not clear, and is stored before anything else happens; then the order is answered.

use super::Desk;
use super::service::Service;
use crate::State;
use crate::protocol::{Addressed, Command, Error, Reply, Request};
use crate::settings::{Kept, StoredBytes, encode};

/// What is to be stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// `save`: the settings of all fingers.
    Save,
    /// `forget`: factory defaults.
    Forget,
}

impl Order {
    /// The command.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Save => "save",
            Self::Forget => "forget",
        }
    }
}

impl<const FINGERS: usize> Desk<FINGERS> {
    /// For a device of this class that was commissioned so.
    #[must_use]
    pub fn restored(kept: &[Kept; FINGERS]) -> Self {
        Self {
            fingers: kept.each_ref().map(|kept| Service::new(kept.settings())),
        }
    }

    /// The bytes that an order stores.
    #[must_use]
    pub fn record(&self, order: Order) -> StoredBytes {
        match order {
            Order::Save => encode(Some(
                &self.fingers.each_ref().map(|one| Kept::of(one.settings())),
            )),
            Order::Forget => encode::<FINGERS>(None),
        }
    }

    /// Accepts an order if nobody can feel a device that starts anew: all bridges are off.
    pub(super) fn accept(
        &self,
        order: Order,
        finger: Option<u8>,
        mut execute: impl FnMut(Request) -> Result<Addressed<Reply>, Addressed<Error>>,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        if finger.is_some() && FINGERS > 1 {
            let said = Error::WholeDevice(order.name());
            return Err(Addressed { finger, said });
        }
        for one in 0..FINGERS as u8 {
            let asked = execute(Request {
                finger: Some(one),
                said: Command::Status,
            })?;
            let is_off = matches!(&asked.said, Reply::Status(status) if is_off(status.state));
            if !is_off {
                let finger = (FINGERS > 1).then_some(one).or(finger);
                let said = Error::NeedsOff(order.name());
                return Err(Addressed { finger, said });
            }
        }
        Ok(Addressed {
            finger,
            said: Reply::Restart(order),
        })
    }
}

const fn is_off(state: State) -> bool {
    matches!(state, State::Off | State::Ready | State::Tripped(_))
}
