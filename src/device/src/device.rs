//! A device with several fingers: one station for each, and commands to one of them or to all.

use core::array;

use crate::command::{Addressed, Command, Refused, Reply};
use crate::drive::Outputs;
use crate::safety::{Fault, ThermalDose, TripCause};
use crate::sense::Samples;
use crate::telemetry::Telemetry;
use crate::{Finger, Station};
use thermal_settings::{Settings, StoredSettings};

/// One [`Station`] for each finger; the stations share no state.
#[derive(Clone, Debug)]
pub struct Device<const FINGERS: usize> {
    stations: [Station; FINGERS],
}

impl<const FINGERS: usize> Device<FINGERS> {
    /// A device whose bridges are off and that no fault has tripped. Evaluates `f64` in software,
    /// once for all fingers.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        Self::with_cause(None, settings)
    }

    /// A device as [`new`](Self::new) makes it, whose fingers are all tripped by `cause`, if there
    /// is one: the fault that ended the previous run of the program.
    #[must_use]
    #[inline(never)]
    pub fn with_cause(cause: Option<TripCause>, settings: &Settings) -> Self {
        let mut station = Station::new(settings);
        if let Some(cause) = cause {
            station.trip(cause);
        }
        Self {
            stations: array::from_fn(|_| station.clone()),
        }
    }

    /// Applies the stored settings of each finger. Evaluates `f64` in software, once for each
    /// finger.
    #[inline(never)]
    pub fn restore_settings(&mut self, stored: &[StoredSettings; FINGERS]) {
        for (station, stored) in self.stations.iter_mut().zip(stored) {
            station.apply(&stored.settings());
        }
    }

    /// Thermal dose of a finger so far.
    #[must_use]
    pub const fn dose(&self, finger: Finger<FINGERS>) -> &ThermalDose {
        self.stations[finger.index()].dose()
    }

    /// Sets the thermal dose that a finger had accumulated before a restart.
    pub const fn restore_dose(&mut self, finger: Finger<FINGERS>, dose: ThermalDose) {
        self.stations[finger.index()].restore_dose(dose);
    }

    /// Runs one control tick of a finger.
    pub fn step(&mut self, finger: Finger<FINGERS>, samples: &Samples) -> Outputs {
        self.stations[finger.index()].step(samples)
    }

    /// Trips all fingers by a fault that is detected outside of the stations.
    pub fn trip_all(&mut self, fault: Fault) {
        self.stations
            .iter_mut()
            .for_each(|station| station.raise(fault));
    }

    /// Whether a fault is latched at this finger.
    #[must_use]
    pub const fn is_tripped(&self, finger: Finger<FINGERS>) -> bool {
        self.stations[finger.index()].is_tripped()
    }

    /// Cause of the earliest trip that is still latched, of all fingers.
    #[must_use]
    pub fn earliest_cause(&self) -> Option<&TripCause> {
        let tripped = self.stations.iter().filter(|station| station.is_tripped());
        tripped
            .min_by_key(|station| station.latch().tripped_at())?
            .latch()
            .cause()
    }

    /// Restarts the time-out that trips a finger when the host falls silent.
    pub fn note_host_activity(&mut self) {
        self.stations
            .iter_mut()
            .for_each(Station::note_host_activity);
    }

    /// Telemetry of a finger's last tick, if the interval of its stream has elapsed.
    #[must_use]
    pub fn telemetry(&self, finger: Finger<FINGERS>) -> Option<Addressed<Telemetry>> {
        let content = self.stations[finger.index()].telemetry()?;
        Some(Addressed {
            finger: finger.address(),
            content,
        })
    }

    /// Executes a command, in bounded and short time, on one finger, or on all if `finger` is
    /// `None`.
    ///
    /// A query to all is answered by the first finger. `clear` to all succeeds if a fault was
    /// cleared at one finger at least.
    ///
    /// # Errors
    /// The first refusal, if the state of a finger does not permit the command; the other fingers
    /// have executed it.
    pub fn execute(
        &mut self,
        finger: Option<Finger<FINGERS>>,
        command: Command,
    ) -> Result<Addressed<Reply>, Addressed<Refused>> {
        if let Some(one) = finger {
            let finger = Some(one.number());
            return match self.stations[one.index()].execute(command) {
                Ok(content) => Ok(Addressed { finger, content }),
                Err(content) => Err(Addressed { finger, content }),
            };
        }
        let (mut refused, mut nothing_to_clear, mut executed) = (None, None, false);
        for (finger, station) in Finger::<FINGERS>::all().zip(&mut self.stations) {
            let finger = finger.address();
            match station.execute(command) {
                Ok(Reply::Done) => executed = true,
                Ok(content) => return Ok(Addressed { finger, content }),
                Err(content @ Refused::NothingToClear) => {
                    nothing_to_clear = nothing_to_clear.or(Some(Addressed { finger, content }))
                }
                Err(content) => refused = refused.or(Some(Addressed { finger, content })),
            }
        }
        let refused = refused.or(nothing_to_clear.filter(|_| !executed));
        refused.map_or(Ok(Addressed::device(Reply::Done)), Err)
    }
}
