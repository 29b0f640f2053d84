//! A device with several fingers: one station for each, and commands to one of them or to all.

use core::array;
use core::borrow::BorrowMut;

use crate::command::{Command, Refused, Reply, WithSourceFinger};
use crate::drive::BoardOutputs;
use crate::events::UnsolicitedReport;
use crate::safety::{Fault, ThermalDose, TripCause};
use crate::sense::Samples;
use crate::telemetry::Telemetry;
use crate::{FingerIndex, Station, TriggerEdge};
use thermal_learner::{LearnerInput, LearnerOutput};
use thermal_settings::{Settings, StoredSettings};

/// The whole device without its hardware: one [`Station`] for each of its `FINGERS` fingers. The stations share no
/// state, so a fault that one station detects leaves the other fingers running.
///
/// `S` is the stations themselves, or a reference to stations that are stored elsewhere ([`DeviceInPlace`]).
#[derive(Clone, Debug)]
pub struct Device<const FINGERS: usize, S = [Station; FINGERS]> {
    stations: S,
}

/// A device whose stations are stored in static memory, as on the board. A station has 5 KB, so five of them together
/// would need more stack, for the time in which they are created, than everything that runs later.
pub type DeviceInPlace<const FINGERS: usize> = Device<FINGERS, &'static mut [Station; FINGERS]>;

impl<const FINGERS: usize> Device<FINGERS> {
    /// A device whose stations are all off and not tripped, with the same settings for every finger.
    /// Converts the settings from `f64`, about a millisecond, so it is for the start only.
    pub fn new(settings: &Settings) -> Self {
        Self::new_optionally_tripped(None, settings)
    }

    /// A device with the same settings for every finger. With a `cause` all stations start tripped by it: a trip that
    /// the board stored before the last reset, or a fault that the reset itself shows. With `None` they start in off.
    /// Converts the settings from `f64`, so it is for the start only.
    pub fn new_optionally_tripped(cause: Option<TripCause>, settings: &Settings) -> Self {
        let station = Station::new_optionally_tripped(cause, settings);
        Self { stations: array::from_fn(|_| station.clone()) }
    }
}

impl<const FINGERS: usize, S: BorrowMut<[Station; FINGERS]>> Device<FINGERS, S> {
    /// A device of stations that exist.
    pub const fn from_stations(stations: S) -> Self {
        Self { stations }
    }

    fn station(&self, finger: FingerIndex<FINGERS>) -> &Station {
        &self.stations.borrow()[finger.index()]
    }

    fn station_mut(&mut self, finger: FingerIndex<FINGERS>) -> &mut Station {
        &mut self.stations.borrow_mut()[finger.index()]
    }

    /// Applies to each finger's station its own thermistor calibration and tile parameters from flash. Converts them
    /// from `f64`, so it is called at the start only, before the first tick.
    #[inline(never)]
    pub fn restore_settings(&mut self, stored: &[StoredSettings; FINGERS]) {
        for (station, stored) in self.stations.borrow_mut().iter_mut().zip(stored) {
            station.apply_settings(&stored.to_settings_with_factory_defaults());
        }
    }

    /// Thermal dose (CEM43, equivalent time at 43 °C) that skin would have received if it had always touched this
    /// finger's display. The board stores the dose after every tick, so that a reset does not erase it.
    pub fn finger_thermal_dose(&self, finger: FingerIndex<FINGERS>) -> &ThermalDose {
        self.station(finger).thermal_dose()
    }

    /// Sets a finger's thermal dose to `dose`, which the board stored before the last reset. To be called once, at the
    /// start.
    pub fn restore_finger_thermal_dose(&mut self, finger: FingerIndex<FINGERS>, dose: ThermalDose) {
        self.station_mut(finger).restore_thermal_dose(dose);
    }

    /// Whether a finger's next samples must say [how many thermistors scatter](Samples::scattering_thermistors).
    pub fn finger_needs_scatter(&self, finger: FingerIndex<FINGERS>) -> bool {
        self.station(finger).needs_scatter()
    }

    /// Runs one control tick of a finger's station with the samples of the last millisecond. Returns what the board
    /// must set at the finger's bridge and comparator until the next tick.
    pub fn step_finger(&mut self, finger: FingerIndex<FINGERS>, samples: &Samples) -> BoardOutputs {
        self.station_mut(finger).step(samples)
    }

    /// Whether a finger's station has a heat-flux sensor, by the settings.
    pub fn finger_has_flux_sensor(&self, finger: FingerIndex<FINGERS>) -> bool {
        self.station(finger).has_flux_sensor()
    }

    /// Notes the code of a finger's heat-flux sensor, 0 to 4095; `None` if its conversion has not ended, as in the first tick. To be
    /// called before each tick of a finger that [has such a sensor](Self::finger_has_flux_sensor), and for no other.
    /// Returns whether the finger's learner has something to work on.
    #[inline]
    pub fn note_flux_code(&mut self, finger: FingerIndex<FINGERS>, code: Option<u16>) -> bool {
        self.station_mut(finger).note_flux_code(code)
    }

    /// What the learner of a finger must work on, once after every tenth tick with a flux code.
    pub fn take_learner_input(&mut self, finger: FingerIndex<FINGERS>) -> Option<LearnerInput> {
        self.station_mut(finger).take_learner_input()
    }

    /// Takes the learner's answer, to be given before the tenth tick after its input was taken. It is applied in that tick.
    pub fn put_learner_output(&mut self, finger: FingerIndex<FINGERS>, output: &LearnerOutput) {
        self.station_mut(finger).put_learner_output(output);
    }

    /// Trips the stations of all fingers by a fault that the board has found outside of a control tick, such as an
    /// overrun stack. On a station that a different fault has already tripped, that fault stays latched; this one is
    /// stored, unless one is stored already, and trips the station when `clear` has cleared the latched one.
    pub fn trip_all(&mut self, fault: Fault) {
        for station in self.stations.borrow_mut() {
            station.trip_or_store_external_fault(fault);
        }
    }

    /// Whether this finger's station is tripped, so that its bridge stays off until the host sends `clear`.
    pub fn is_finger_tripped(&self, finger: FingerIndex<FINGERS>) -> bool {
        self.station(finger).is_tripped()
    }

    /// Cause of the earliest trip among the fingers that are tripped now; `None` if no finger is tripped. The board
    /// stores this cause through a reset.
    pub fn earliest_trip_cause(&self) -> Option<&TripCause> {
        let stations = self.stations.borrow().iter();
        let tripped = stations.filter(|station| station.is_tripped());
        tripped
            .min_by_key(|station| station.fault_latch().last_trip_tick_or_zero())?
            .fault_latch()
            .last_trip_cause()
    }

    /// Restarts, for all fingers, the 2 s of silence of the host after which a station trips if its telemetry is on and
    /// its display follows a set-point. To be called for each line from the host.
    pub fn note_host_activity(&mut self) {
        for station in self.stations.borrow_mut() {
            station.note_host_activity();
        }
    }

    /// Telemetry of a finger's last tick, with the index of the finger (none on a device with one finger). `None` if
    /// the host has not switched telemetry on, or if the number of that tick is not a multiple of the interval that the
    /// host has chosen. To be called once after each tick.
    pub fn finger_telemetry_if_due(
        &self,
        finger: FingerIndex<FINGERS>,
    ) -> Option<WithSourceFinger<Telemetry>> {
        let content = self.station(finger).telemetry_if_due()?;
        Some(WithSourceFinger { finger: finger.index_unless_single_finger(), content })
    }

    /// Whether there is an event of a finger that was not fetched yet.
    pub fn finger_has_event(&self, finger: FingerIndex<FINGERS>) -> bool {
        self.station(finger).has_event()
    }

    /// The oldest event of a finger that was not fetched yet, with the index of the finger (none on a device with one
    /// finger). To be called after each tick until there is none, or until there is no room for another one.
    pub fn take_finger_event(
        &mut self,
        finger: FingerIndex<FINGERS>,
    ) -> Option<WithSourceFinger<UnsolicitedReport>> {
        let event = self.station_mut(finger).take_event()?;
        Some(WithSourceFinger {
            finger: finger.index_unless_single_finger(),
            content: UnsolicitedReport::Event(event),
        })
    }

    /// Takes note of an edge at the trigger input, for all fingers: a course that waits for it begins in the next tick. To
    /// be called before the tick that [reports](TriggerEdge::ticks_ago) the edge.
    pub fn note_trigger_edge(&mut self, edge: TriggerEdge) {
        for station in self.stations.borrow_mut() {
            station.note_trigger_edge(edge);
        }
    }

    /// Executes a command in the station of one finger, in bounded and short time. Meanwhile no tick
    /// begins: a tick switches the multiplexers of five fingers, at most 11 us after its finger's last scan.
    ///
    /// # Errors
    /// The station's refusal.
    pub fn execute_on_finger(
        &mut self,
        finger: FingerIndex<FINGERS>,
        command: &Command<'_>,
    ) -> Result<Reply, Refused> {
        self.station_mut(finger).execute(command)
    }

    /// [`execute_in_turn`] for a caller that need not give way to a tick between two fingers.
    ///
    /// # Errors
    /// As [`execute_in_turn`].
    pub fn execute(
        &mut self,
        finger: Option<FingerIndex<FINGERS>>,
        command: Command<'_>,
    ) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Refused>> {
        execute_in_turn(finger, |one| self.execute_on_finger(one, &command))
    }
}

/// Executes a command by `execute` on `finger`, or on one finger after the other if `finger` is `None`.
///
/// A query to all fingers is answered by the one with the lowest index that does not refuse the query. `clear` to all
/// fingers succeeds if at least one was tripped, and every tripped one could be cleared.
///
/// # Errors
/// The refusal of `finger`. For all fingers: the refusal of the finger with the lowest index among those that refuse, with
/// that index (none on a device with one finger); [`Refused::NothingToClear`] only if no finger was tripped. The other
/// fingers, which do not refuse the command, have executed it.
pub fn execute_in_turn<const FINGERS: usize>(
    finger: Option<FingerIndex<FINGERS>>,
    mut execute: impl FnMut(FingerIndex<FINGERS>) -> Result<Reply, Refused>,
) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Refused>> {
    if let Some(one) = finger {
        let finger = Some(one.index_u8());
        return match execute(one) {
            Ok(content) => Ok(WithSourceFinger { finger, content }),
            Err(content) => Err(WithSourceFinger { finger, content }),
        };
    }
    let (mut refused, mut nothing_to_clear, mut executed) = (None, None, false);
    for one in FingerIndex::<FINGERS>::all() {
        let finger = one.index_unless_single_finger();
        match execute(one) {
            Ok(Reply::Done) => executed = true,
            Ok(content) => return Ok(WithSourceFinger { finger, content }),
            Err(content @ Refused::NothingToClear) => {
                nothing_to_clear = nothing_to_clear.or(Some(WithSourceFinger { finger, content }));
            }
            Err(content) => refused = refused.or(Some(WithSourceFinger { finger, content })),
        }
    }
    let refused = refused.or(nothing_to_clear.filter(|_| !executed));
    refused.map_or(Ok(WithSourceFinger::from_whole_device(Reply::Done)), Err)
}
