//! A device with several fingers: one station for each, and commands to one of them or to all.

use core::array;

use crate::command::{Addressed, Command, Refused, Reply};
use crate::drive::BoardOutputs;
use crate::safety::{Fault, ThermalDose, TripCause};
use crate::sense::Samples;
use crate::telemetry::Telemetry;
use crate::{Finger, Station};
use thermal_settings::{Settings, StoredSettings};

/// The whole device without its hardware: one [`Station`] for each of its `FINGERS` fingers. The stations
/// share no state, so a fault of one finger leaves the others running.
#[derive(Clone, Debug)]
pub struct Device<const FINGERS: usize> {
    stations: [Station; FINGERS],
}

impl<const FINGERS: usize> Device<FINGERS> {
    /// A device whose stations are all off and not tripped, with the same settings for every finger.
    /// Converts the settings from `f64`, about a millisecond, so it is for the start only.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        Self::with_trip_cause(None, settings)
    }

    /// A device with the same settings for every finger, all of whose stations are tripped by `cause`,
    /// the fault that has ended the previous run of the program, or off if that is `None`.
    #[must_use]
    #[inline(never)]
    pub fn with_trip_cause(cause: Option<TripCause>, settings: &Settings) -> Self {
        let mut station = Station::new(settings);
        if let Some(cause) = cause {
            station.trip(cause);
        }
        Self {
            stations: array::from_fn(|_| station.clone()),
        }
    }

    /// Applies to each finger's station its own stored calibration and tile. Converts them from `f64`,
    /// so it is called at the start only, before the first tick.
    #[inline(never)]
    pub fn restore_settings(&mut self, stored: &[StoredSettings; FINGERS]) {
        for (station, stored) in self.stations.iter_mut().zip(stored) {
            station.apply_settings(&stored.settings());
        }
    }

    /// Thermal dose that a finger's display could have given to skin so far; the board stores it after
    /// every tick, to keep it through a reset.
    #[must_use]
    pub const fn dose(&self, finger: Finger<FINGERS>) -> &ThermalDose {
        self.stations[finger.index()].dose()
    }

    /// Continues a finger's thermal dose from `dose`, stored before a reset. Called once, at the start.
    pub const fn restore_dose(&mut self, finger: Finger<FINGERS>, dose: ThermalDose) {
        self.stations[finger.index()].restore_dose(dose);
    }

    /// Runs one control tick of a finger's station with the samples of the last millisecond; returns what
    /// its bridge must do until the next tick.
    pub fn step(&mut self, finger: Finger<FINGERS>, samples: &Samples) -> BoardOutputs {
        self.stations[finger.index()].step(samples)
    }

    /// Trips the stations of all fingers by a fault that the board has found outside of a tick. A station
    /// that is tripped by another fault keeps it, and answers `clear` with this one.
    pub fn trip_all(&mut self, fault: Fault) {
        self.stations
            .iter_mut()
            .for_each(|station| station.raise_external_fault(fault));
    }

    /// Whether this finger's station is tripped, so that its bridge stays off until `clear`.
    #[must_use]
    pub const fn is_tripped(&self, finger: Finger<FINGERS>) -> bool {
        self.stations[finger.index()].is_tripped()
    }

    /// Cause of the trip that came first of those fingers that are still tripped, which the board stores
    /// through a reset; `None` if no finger is tripped.
    #[must_use]
    pub fn earliest_cause(&self) -> Option<&TripCause> {
        let tripped = self.stations.iter().filter(|station| station.is_tripped());
        tripped
            .min_by_key(|station| station.latch().tripped_at_tick())?
            .latch()
            .cause()
    }

    /// Restarts, for all fingers, the 2 s after which a silent host trips a finger whose telemetry
    /// streams. To be called for each line from the host.
    pub fn note_host_activity(&mut self) {
        self.stations
            .iter_mut()
            .for_each(Station::note_host_activity);
    }

    /// Telemetry of a finger's last tick; `None` unless the host has asked for telemetry and the interval
    /// has elapsed in this tick. To be called once after each tick.
    #[must_use]
    pub fn telemetry(&self, finger: Finger<FINGERS>) -> Option<Addressed<Telemetry>> {
        let content = self.stations[finger.index()].telemetry()?;
        Some(Addressed {
            finger: finger.reply_address(),
            content,
        })
    }

    /// Executes a command, in bounded and short time, on one finger, or on all if `finger` is
    /// `None`.
    ///
    /// A query to all is answered by the first finger that does not refuse it. `clear` to all succeeds
    /// if it has cleared one finger at least, and all others had nothing to clear.
    ///
    /// # Errors
    /// The first refusal, with its finger; those fingers whose state permits the command have executed it.
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
            let finger = finger.reply_address();
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
        refused.map_or(Ok(Addressed::from_whole_device(Reply::Done)), Err)
    }
}
