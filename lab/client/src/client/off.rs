//! Switching all bridges off, and making sure of it.

use std::time::Duration;

use super::{Client, ClientError, QueryIdentity, QueryState, StationRequest};
use crate::link::{Link, LinkError};

/// Times that the bridges are ordered off until the device confirms it, and the time in which it must do so, altogether.
const OFF_ATTEMPTS: u32 = 3;
const OFF_WITHIN: Duration = Duration::from_secs(6);

impl<L: Link> Client<L> {
    /// Switches the bridges of all fingers off. Only `abort` accepted, and then the state of each finger, mean that they are: an `ok`
    /// may be the answer of something else on the line.
    ///
    /// # Errors
    /// [`ClientError::NotOff`] if the device does not confirm it in three attempts or 6 s; [`LinkError::Gone`] if it can no longer be
    /// reached.
    pub fn switch_off(&mut self) -> Result<(), ClientError> {
        let end = self.link.now() + OFF_WITHIN;
        self.deadline = end;
        let mut attempts = 0;
        let off = loop {
            let off = self.try_to_switch_off();
            match &off {
                Ok(()) | Err(ClientError::Link(LinkError::Gone(_))) => break off,
                // Whoever interrupts this wants the same once more.
                Err(ClientError::Link(LinkError::Interrupted)) => {}
                Err(_) => attempts += 1,
            }
            if attempts == OFF_ATTEMPTS || self.link.now() >= end {
                break off;
            }
        };
        self.deadline = Duration::MAX;
        off.map_err(|error| match error {
            gone @ ClientError::Link(LinkError::Gone(_)) => gone,
            error => error.not_off(),
        })
    }

    fn try_to_switch_off(&mut self) -> Result<(), ClientError> {
        self.ask(&StationRequest::Abort)?;
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
