//! The begin of a session: which device is this, and is it ready?

use thermal_client::client::{ClientError, QueryCause, QueryIdentity, QueryState};
use thermal_client::commissioning::settings;
use thermal_client::link::Link;
use thermal_device::StateName;

use super::fingers::Fingers;
use super::{Executor, SessionEnd, TrialEnd, unanswered};
use crate::dataset::DeviceReport;
use crate::{OperatorQuestion, Plan, Presented, Update};

/// What the firmware must be able to do.
const NEEDED: [&str; 2] = ["course", "checksum"];

impl<L: Link> Executor<'_, L> {
    /// Asks the device who it is, stores that with its settings, and lets the operator clear a fault.
    pub(super) fn connect(&mut self, plan: &Plan) -> Result<(), SessionEnd> {
        let identity = self.client.ask(&QueryIdentity).map_err(ends)?;
        if let Some(missing) = NEEDED.iter().find(|word| !identity.can(word)) {
            return Err(SessionEnd::Unsuitable(format!(
                "its firmware {} has no '{missing}'; flash a current one",
                identity.version
            )));
        }
        let stations = plan.trials.iter().flat_map(|trial| &trial.presented);
        let needed = stations.filter_map(Presented::device_finger).max();
        if let Some(last) = needed.filter(|last| *last >= identity.fingers) {
            return Err(SessionEnd::Unsuitable(format!(
                "it presents something on finger {last} of the device, which has {}, counted from 0",
                identity.fingers
            )));
        }
        self.fingers = Fingers::new(identity.fingers);
        let mut all_settings = Vec::new();
        for finger in 0..identity.fingers {
            let address = self.fingers.address(finger);
            all_settings.push(settings(&mut self.client, address).map_err(ends)?);
        }
        self.recorder.device(&DeviceReport {
            identity,
            settings: all_settings,
        })?;
        for finger in 0..self.fingers.count() as u8 {
            let address = self.fingers.address(finger);
            let status = self.client.ask_finger(address, &QueryState).map_err(ends)?;
            if let StateName::Tripped(fault) = status.state {
                self.recover(fault.name())?;
            }
        }
        Ok(())
    }

    /// Asks the operator what to do about a trip until the fault is cleared.
    pub(super) fn recover(&mut self, fault: &'static str) -> Result<(), SessionEnd> {
        let cause = self.client.ask(&QueryCause).map_err(ends)?;
        let mut explanation = cause.map_or(String::new(), |cause| {
            let celsius = |value: Option<f64>| value.map_or("-".into(), |c| format!("{c:.2} C"));
            format!(
                "display {}, second thermistor {}, sink {}, current {:.2} A",
                celsius(cause.display_c),
                celsius(cause.check_c),
                celsius(cause.sink_c),
                cause.current_a
            )
        });
        loop {
            self.operator(OperatorQuestion::Tripped {
                fault: fault.into(),
                explanation: explanation.clone(),
            })?;
            match self.command(None, &thermal_client::client::PlainCommand::Clear) {
                Ok(()) => return Ok(()),
                Err(TrialEnd::Session(end)) => return Err(end),
                Err(TrialEnd::Void(why)) => {
                    explanation = format!("it cannot be cleared yet: {why}");
                    self.inform(Update::Notice(explanation.clone()));
                }
                Err(TrialEnd::Tripped(_)) => {}
            }
        }
    }
}

/// A question without an answer ends a session that has not begun.
fn ends(error: ClientError) -> SessionEnd {
    match unanswered(error) {
        TrialEnd::Session(end) => end,
        TrialEnd::Void(why) => SessionEnd::Unsuitable(why),
        TrialEnd::Tripped(fault) => SessionEnd::Unsuitable(fault.into()),
    }
}
