//! Detectors of faults that show only over several ticks.

use contact_model::fixed_point::Celsius;

use super::UpDownDebounceCounter;
use super::current_mismatch::CurrentMismatchDetector;
use super::frozen_sample_detector::FrozenSampleDetector;
use super::jump_detector::JumpDetector;
use super::limits::{SUPPLY_MAX, SUPPLY_MIN};
use super::thermal_dose::ThermalDose;
use super::validate_readings::ValidReadings;
use super::wrong_way_detector::WrongWayDetector;
use super::{Fault, Setpoint};
use crate::drive::Current;
use crate::sense::{Readings, Samples};

/// Difference between the readings of the display's two thermistors, K, above which one of them counts as wrong. A
/// correct pair whose thermal lags differ by 0.1 s differs by 1.6 K while the bridge at its current limit moves a
/// display without a finger.
const DISPLAY_THERMISTOR_DIFFERENCE_MAX: Celsius = Celsius::lit("3");
/// Net ticks of 1 ms at which [`Fault::DisplaysApart`] trips the station: each tick in which the display's two
/// thermistors differ by more than [`DISPLAY_THERMISTOR_DIFFERENCE_MAX`] counts up, each other tick counts down, so
/// that noise does not trip the station.
const DISPLAY_DIFFERENCE_TRIP_NET_TICKS: u8 = 40;
/// Excess of the room's reading over the skin's, K, above which the two thermistors count as swapped or misplaced. A
/// finger's skin is warmer than the room, except for cold hands of 17 °C in a warm room; if the skin's thermistor is on
/// no finger, it reads the room's air.
const ROOM_ABOVE_SKIN_MAX: Celsius = Celsius::lit("8");
/// Net ticks of 1 ms at which [`Fault::RoomAboveSkin`] trips the station: each tick in which the room reads more than
/// [`ROOM_ABOVE_SKIN_MAX`] above the skin counts up, each other tick counts down.
const ROOM_ABOVE_SKIN_TRIP_NET_TICKS: u8 = 40;
/// Net ticks of 1 ms at which [`Fault::UnlikeModel`] trips the station: each tick in which the display follows a
/// set-point and the plate observer's residual is larger than a sound tile can cause counts up, each other tick counts
/// down.
const UNLIKE_MODEL_TRIP_NET_TICKS: u8 = 30;
/// Net ticks of 1 ms at which [`Fault::Supply`] trips the station: each tick in which the bridge's supply is outside of
/// its limits although it should be on counts up, each other tick counts down. Long enough for the emergency stop's
/// second contact to close after the one in the supply.
const SUPPLY_TRIP_NET_TICKS: u8 = 10;
/// Ticks of 1 ms without a line from the host, while telemetry streams and a set-point is followed, that trip the
/// station by [`Fault::HostSilent`].
const HOST_SILENT_TICKS: u16 = 2000;

/// Ticks of 1 ms between two evaluations of the same group of detectors: `check_display_pair_and_current` and
/// `check_direction_model_room_and_host` run in alternate ticks, which halves their cost; each evaluation counts for two
/// ticks. A disturbance that is locked to every second tick is thus seen always or never.
pub(super) const EVALUATION_INTERVAL_TICKS: u8 = 2;

/// What one tick demanded of the bridge, and whether the residual of the display's model was too large in that tick.
/// The fault detectors compare the next tick's readings with these values, because those readings are the first that
/// respond to that current.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PreviousDemandAndResidual {
    /// Current that the previous tick demanded of the bridge, A; positive cools the display; zero if the bridge was
    /// off.
    pub demanded: Current,
    /// Set-point that the display followed in the previous tick. `None` if the bridge was off or the self-test ran;
    /// then neither [`Fault::UnlikeModel`] nor [`Fault::HostSilent`] can trip the station.
    pub setpoint: Option<Setpoint>,
    /// Whether the plate observer's residual exceeded 3.75 K (8 K on a tile that was never identified) in the previous
    /// tick; the residual is the prediction error of the display's model, K, plus 0.5 K for each ampere of the
    /// observer's correction. The detectors use it one tick late, because the residual of the present tick is computed
    /// after them.
    pub residual_is_large: bool,
    /// Whether the bridge's supply should be on: the comparator's tests of the self-test have passed since the last
    /// trip. Else [`Fault::Supply`] cannot trip the station.
    pub supply_should_be_on: bool,
}

/// The fault detectors of one station that need the readings of several ticks, and the thermal dose of the station's
/// display. Faults that a single tick shows are found by [`validate_readings`](super::validate_readings()) instead.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultDetectors {
    frozen: FrozenSampleDetector,
    jump: JumpDetector,
    display_difference: UpDownDebounceCounter,
    room_above_skin: UpDownDebounceCounter,
    current_mismatch: CurrentMismatchDetector,
    wrong_way: WrongWayDetector,
    residual: UpDownDebounceCounter,
    supply: UpDownDebounceCounter,
    dose: ThermalDose,
    host_silent_ticks: u16,
    second_group_is_due: bool,
    /// Fault that either group of detectors found when it was last evaluated.
    fault_of_group: [Option<Fault>; EVALUATION_INTERVAL_TICKS as usize],
}

impl FaultDetectors {
    /// Restarts the 2 s after which a silent host trips the station by [`Fault::HostSilent`]. To be called for each
    /// line from the host, even a blank one.
    pub const fn note_host_activity(&mut self) {
        self.host_silent_ticks = 0;
    }

    /// Thermal dose (CEM43) that skin would have received so far if it had always touched this station's display. The
    /// board saves it after every tick, so that a reset does not erase it.
    pub const fn dose(&self) -> &ThermalDose {
        &self.dose
    }

    /// Continues from `dose`, the thermal dose that was stored before a reset. To be called once, at the start.
    pub const fn restore_dose(&mut self, dose: ThermalDose) {
        self.dose = dose;
    }

    /// Whether the next tick's [`Samples::scattering_thermistors`] is needed.
    pub const fn needs_scatter(&self) -> bool {
        self.frozen.needs_scatter()
    }

    /// Compares the samples of this tick with those of the tick before, even if their readings are invalid. To be
    /// called in every tick.
    ///
    /// # Errors
    /// As `FrozenSampleDetector::check_samples`.
    pub fn check_frozen_samples(
        &mut self,
        samples: &Samples,
        bridge_is_driven: bool,
    ) -> Result<(), Fault> {
        self.frozen.check_samples(samples, bridge_is_driven)
    }

    /// Counts this tick in the thermal dose; every 256th tick adds the interval's dose at the higher valid reading of
    /// the two display thermistors. If both readings are invalid, the dose stays. To be called in every tick, even if
    /// other readings are invalid.
    ///
    /// # Errors
    /// [`Fault::Dose`]: the dose has reached 30 s at 43 °C.
    pub fn update_and_check_dose(&mut self, readings: &Readings) -> Result<(), Fault> {
        let display = [readings.display, readings.display_check];
        self.dose.count_tick_and_evaluate_if_due(|| display.into_iter().flatten().max())
    }

    /// Runs the detectors that compare several ticks and need valid readings, once per tick: those of jumps and of the
    /// supply, and one of two groups of others in turn. `readings` are those of this tick, `previous` is what the tick
    /// before demanded of the bridge; `streams` is true while telemetry is sent to the host.
    ///
    /// # Errors
    /// The first fault in this order: a jump of the first or second display reading or of the sink's (0.5 K in 4 ms),
    /// [`Fault::DisplaysApart`] (3 K for 40 ms), [`Fault::CurrentHigh`] or [`Fault::CurrentLow`] (1 A plus a quarter of
    /// the demanded current for 30 ms), [`Fault::Polarity`] or [`Fault::Runaway`] (2.5 K against the current),
    /// [`Fault::UnlikeModel`] (large residual for 30 ms), [`Fault::RoomAboveSkin`] (8 K for 40 ms), [`Fault::HostSilent`]
    /// (2 s), [`Fault::Supply`] (outside of 10.8 to 13.2 V for 10 ms). The group that is not evaluated in this tick
    /// contributes the fault of its last evaluation. A group counts even when another detector has a fault.
    pub fn run_detectors_of_valid_readings(
        &mut self,
        readings: &ValidReadings,
        previous: &PreviousDemandAndResidual,
        streams: bool,
    ) -> Result<(), Fault> {
        let [mut first, mut second] = self.fault_of_group;
        if self.second_group_is_due {
            second = (self.check_direction_model_room_and_host(readings, previous, streams)).err();
        } else {
            first = (self.check_display_pair_and_current(readings, previous)).err();
        }
        self.fault_of_group = [first, second];
        self.second_group_is_due = !self.second_group_is_due;
        let supply_is_wrong = self.supply.count(
            previous.supply_should_be_on && !(SUPPLY_MIN..=SUPPLY_MAX).contains(&readings.supply),
            SUPPLY_TRIP_NET_TICKS,
        );
        self.jump.check_jumps(readings)?;
        first.or(second).map_or(Ok(()), Err)?;
        err_if(supply_is_wrong, Fault::Supply)
    }

    /// The first group: the second display thermistor against the first one, the measured current against the demand.
    fn check_display_pair_and_current(
        &mut self,
        readings: &ValidReadings,
        previous: &PreviousDemandAndResidual,
    ) -> Result<(), Fault> {
        let difference = readings.display.saturating_sub(readings.check);
        let displays_differ = self.display_difference.count(
            !(-DISPLAY_THERMISTOR_DIFFERENCE_MAX..=DISPLAY_THERMISTOR_DIFFERENCE_MAX)
                .contains(&difference),
            DISPLAY_DIFFERENCE_TRIP_NET_TICKS / EVALUATION_INTERVAL_TICKS,
        );
        let current = (self.current_mismatch).check_current(previous.demanded, readings.current);
        err_if(displays_differ, Fault::DisplaysApart)?;
        current
    }

    /// The second group: direction of the display, residual of its model, room and host.
    fn check_direction_model_room_and_host(
        &mut self,
        readings: &ValidReadings,
        previous: &PreviousDemandAndResidual,
        streams: bool,
    ) -> Result<(), Fault> {
        let above_setpoint = previous
            .setpoint
            .map_or(Celsius::ZERO, |setpoint| readings.display.saturating_sub(setpoint.celsius()));
        let room_above_skin = self.room_above_skin.count(
            readings.room.saturating_sub(readings.skin) > ROOM_ABOVE_SKIN_MAX,
            ROOM_ABOVE_SKIN_TRIP_NET_TICKS / EVALUATION_INTERVAL_TICKS,
        );
        let follows_setpoint = previous.setpoint.is_some();
        let unlike_model = self.residual.count(
            follows_setpoint && previous.residual_is_large,
            UNLIKE_MODEL_TRIP_NET_TICKS / EVALUATION_INTERVAL_TICKS,
        );
        self.host_silent_ticks = if streams && follows_setpoint {
            (self.host_silent_ticks).saturating_add(EVALUATION_INTERVAL_TICKS.into())
        } else {
            0
        };
        let host_silent = self.host_silent_ticks >= HOST_SILENT_TICKS;
        let wrong_way =
            (self.wrong_way).check_direction(previous.demanded, readings.display, above_setpoint);
        wrong_way?;
        err_if(unlike_model, Fault::UnlikeModel)?;
        err_if(room_above_skin, Fault::RoomAboveSkin)?;
        err_if(host_silent, Fault::HostSilent)
    }

    /// Takes note of a tick with invalid readings: restarts the jump and wrong-direction detectors with the next valid ones, and
    /// forgets the faults of the last evaluations, which may be old by then.
    pub fn note_invalid_readings(&mut self) {
        self.restart_motion_detectors();
        self.fault_of_group = [None; EVALUATION_INTERVAL_TICKS as usize];
    }

    /// Restarts the jump and wrong-direction detectors with the next readings. To be called
    /// after a new calibration, which shifts the readings without any movement of the display.
    pub fn restart_motion_detectors(&mut self) {
        self.jump = JumpDetector::default();
        self.wrong_way = WrongWayDetector::default();
    }
}

const fn err_if(condition: bool, fault: Fault) -> Result<(), Fault> {
    if condition { Err(fault) } else { Ok(()) }
}
