//! The begin of a session: which device is this, and is it ready?

use std::collections::BTreeSet;

use thermal_client::client::{
    AvailableFields, BoardReport, Client, ClientError, DeviceRequest, Identity, QueryBoard,
    QueryCause, QueryIdentity, QueryState, StationRequest,
};
use thermal_client::commissioning::settings;
use thermal_client::link::Link;
use thermal_device::safety::Fault;

use super::fingers::Fingers;
use super::{Executor, SessionEnd};
use crate::dataset::DeviceReport;
use crate::planned_dose::decay_before_s;
use crate::{OperatorQuestion, Plan, PlannedTrial, Presented, Session, Update};

/// What the firmware must be able to do.
const NEEDED: [&str; 2] = ["course", "checksum"];

impl<L: Link> Executor<'_, L> {
    /// Asks the device who it is, stores that with its settings, and lets the operator clear a fault.
    pub(super) fn connect(&mut self, plan: &Plan) -> Result<(), SessionEnd> {
        let identity = check_device(&mut self.client, self.session, plan)?;
        let (mut all_settings, mut has_flux_sensor) = (Vec::new(), Vec::new());
        for finger in 0..identity.fingers {
            let address = (identity.fingers > 1).then_some(finger);
            all_settings.push(settings(&mut self.client, address).map_err(ends)?);
            has_flux_sensor.push(self.client.flux_report(address).map_err(ends)?.is_some());
        }
        let fields = has_flux_sensor.iter().map(|has| AvailableFields::of(&identity, *has));
        self.fingers = Fingers::new(fields.collect());
        let board = if identity.can("board") {
            Some(self.client.ask(&QueryBoard).map_err(ends)?)
        } else {
            None
        };
        let report = DeviceReport {
            identity,
            is_simulated: board.as_ref().map(BoardReport::is_simulated),
            program: board.and_then(|board| board.program),
            settings: all_settings,
            has_flux_sensor,
        };
        self.recorder.device(&report)?;
        // Another program may have left it driven.
        self.switch_off()?;
        self.clear_trips(None)?;
        self.ask_for_skin_sensors()
    }

    /// Asks the operator to put the skin thermistors where the session file has them.
    fn ask_for_skin_sensors(&mut self) -> Result<(), SessionEnd> {
        let stations = self.session.stations.iter();
        let places: Vec<_> = stations
            .filter_map(|station| {
                let sensor = station.skin_sensor?;
                Some(format!("{sensor} on the {}", station.finger))
            })
            .collect();
        if !places.is_empty() {
            let ready = format!("skin thermistors of the device: {}", places.join(", "));
            self.operator(OperatorQuestion::Ready(ready))?;
        }
        Ok(())
    }

    /// Meets the device at the begin of a trial, whatever has happened to it since the one before.
    pub(super) fn meet_device(&mut self, trial: &PlannedTrial) -> Result<(), SessionEnd> {
        if self.fingers.count() == 0 {
            return Ok(());
        }
        // First of all, because a device that has restarted has forgotten it, and its other answers would count as damaged.
        // Whether it answers at all, the next question shows.
        let checksums = self.client.ask(&DeviceRequest::Checksum { switch: true.into() });
        if let Err(ClientError::Link(error)) = checksums {
            return Err(error.into());
        }
        self.clear_trips(Some(trial))
    }

    /// Lets the operator clear the faults by which fingers of the device have tripped, before a trial or, at the begin of the session,
    /// before none.
    fn clear_trips(&mut self, trial: Option<&PlannedTrial>) -> Result<(), SessionEnd> {
        for finger in 0..self.fingers.count() as u8 {
            while let Some(fault) = self.fault_of(finger)? {
                let explanation = self.cause_of_trip(finger)?;
                if let Some(trial) = trial.filter(|_| fault == Fault::Dose) {
                    self.let_dose_decay(trial, finger)?;
                }
                let fault = fault.name().into();
                self.operator(OperatorQuestion::Tripped { fault, explanation })?;
                let address = self.fingers.address(finger);
                match self.client.ask_finger(address, &StationRequest::Clear) {
                    Ok(()) => {}
                    Err(ClientError::Link(error)) => return Err(error.into()),
                    Err(refused) => {
                        self.inform(Update::Notice(format!("it cannot be cleared yet: {refused}")));
                    }
                }
            }
        }
        Ok(())
    }

    /// Lets as much of the dose decay as a trial adds, which would trip the device at once otherwise.
    fn let_dose_decay(&mut self, trial: &PlannedTrial, finger: u8) -> Result<(), SessionEnd> {
        let off_s = decay_before_s(self.session, trial, finger);
        self.inform(Update::Notice(format!(
            "the skin at display {finger} has taken its dose; the display stays off for {:.0} min, until so much of it has decayed \
             as trial {} adds",
            (off_s / 60.0).ceil(),
            trial.number
        )));
        let until_s = self.now_s() + off_s;
        // The device says again and again that it is tripped.
        self.wait_between_trials(until_s)
    }

    /// The fault by which a finger of the device has tripped.
    fn fault_of(&mut self, finger: u8) -> Result<Option<Fault>, SessionEnd> {
        let address = self.fingers.address(finger);
        let status = self.client.ask_finger(address, &QueryState).map_err(ends)?;
        Ok(status.state.fault())
    }

    /// What was measured when a finger of the device tripped.
    fn cause_of_trip(&mut self, finger: u8) -> Result<String, SessionEnd> {
        let address = self.fingers.address(finger);
        let cause = self.client.ask_finger(address, &QueryCause).map_err(ends)?;
        let celsius = |value: Option<f64>| value.map_or("-".into(), |c| format!("{c:.2} C"));
        Ok(cause.map_or(String::new(), |cause| {
            format!(
                "display {}, second thermistor {}, sink {}, current {:.2} A",
                celsius(cause.display_c),
                celsius(cause.check_c),
                celsius(cause.sink_c),
                cause.current_a
            )
        }))
    }
}

/// Refuses a device that cannot run a session, before anything is recorded.
///
/// # Errors
/// The firmware lacks a capability, the device has too few fingers, a tile that the session uses was never tuned, or the device does
/// not answer.
pub fn check_device<L: Link>(
    client: &mut Client<L>,
    session: &Session,
    plan: &Plan,
) -> Result<Identity, SessionEnd> {
    let identity = client.ask(&QueryIdentity).map_err(ends)?;
    if let Some(missing) = NEEDED.iter().find(|word| !identity.can(word)) {
        return Err(SessionEnd::Unsuitable(format!(
            "its firmware {} has no '{missing}'; flash a current one",
            identity.version
        )));
    }
    let stations = plan.trials.iter().flat_map(|trial| &trial.presented);
    let displays: BTreeSet<u8> = stations.filter_map(Presented::device_finger).collect();
    let sensors = plan.trials.iter().map(|trial| session.skin_sensors(trial));
    let needed = [
        ("it presents something on", displays.last().copied()),
        ("it measures the skin by", sensors.flatten().max()),
    ];
    for (what, last) in needed {
        if let Some(last) = last.filter(|last| *last >= identity.fingers) {
            return Err(SessionEnd::Unsuitable(format!(
                "{what} finger {last} of the device, which has {}, counted from 0",
                identity.fingers
            )));
        }
    }
    // Set-points of a tile that was never tuned move too slowly for what a session presents.
    for finger in displays {
        let address = (identity.fingers > 1).then_some(finger);
        if client.ask_finger(address, &QueryState).map_err(ends)?.is_tuned == Some(false) {
            return Err(SessionEnd::Unsuitable(format!(
                "the tile of its finger {finger} was never tuned, so that it moves by 1 K/s only; commission it first (thermal-lab commission)"
            )));
        }
    }
    Ok(identity)
}

/// What a question without an answer means for the session.
fn ends(error: ClientError) -> SessionEnd {
    match error {
        ClientError::Link(error) => error.into(),
        ClientError::TimedOut { .. } => SessionEnd::Gone(error.to_string()),
        other => SessionEnd::Unsuitable(other.to_string()),
    }
}
