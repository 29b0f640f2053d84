//! Switching all bridges off, and making sure of it.

use super::{Client, ClientError, PlainCommand, QueryIdentity, QueryState};
use crate::link::{Link, LinkError};

/// Times that the bridges are ordered off until the device confirms it.
const OFF_ATTEMPTS: u32 = 3;

impl<L: Link> Client<L> {
    /// Switches the bridges of all fingers off. Only `abort` accepted, and then the state of each finger, mean that they are: an `ok`
    /// may be the answer of something else on the line.
    ///
    /// # Errors
    /// [`ClientError::NotOff`] if the device does not confirm it, after three attempts; [`LinkError::Gone`] if it can no longer be
    /// reached.
    pub fn switch_off(&mut self) -> Result<(), ClientError> {
        let mut off = self.try_to_switch_off();
        for _ in 1..OFF_ATTEMPTS {
            if matches!(off, Ok(()) | Err(ClientError::Link(LinkError::Gone(_)))) {
                break;
            }
            off = self.try_to_switch_off();
        }
        off.map_err(|error| match error {
            gone @ ClientError::Link(LinkError::Gone(_)) => gone,
            error => ClientError::NotOff { why: error.to_string() },
        })
    }

    fn try_to_switch_off(&mut self) -> Result<(), ClientError> {
        self.ask(&PlainCommand::Abort)?;
        let fingers = self.ask(&QueryIdentity)?.fingers;
        for finger in 0..fingers {
            let address = (fingers > 1).then_some(finger);
            let state = self.ask_finger(address, &QueryState)?.state;
            if state.is_driven() {
                self.may_be_driven = true;
                return Err(ClientError::StillDriven { finger, state: state.name() });
            }
        }
        Ok(())
    }
}
