//! Detectors of faults that show only over several ticks.

use contact_model::fixed_point::Celsius;

use super::current_mismatch::CurrentMismatchDetector;
use super::debounce::DebounceCounter;
use super::frozen::FrozenDetector;
use super::jump::JumpDetector;
use super::thermal_dose::ThermalDose;
use super::validity::ValidReadings;
use super::wrong_way::WrongWayDetector;
use super::{Fault, Setpoint};
use crate::drive::Current;
use crate::sense::{Readings, Samples};

/// Difference between the readings of the display's two thermistors, K, above which one of them counts as wrong.
/// Thermistors whose lags differ by 0.1 s differ by 1.6 K while the bridge at its current limit moves a display without
/// a finger.
const DISPLAY_DIFFERENCE_MAX: Celsius = Celsius::lit("3");
/// Net ticks of 1 ms at which [`Fault::DisplaysApart`] trips the station: counted up in each tick in which the display's
/// thermistors differ by more than [`DISPLAY_DIFFERENCE_MAX`], and down in each other one, so that noise does not trip.
const DISPLAY_DIFFERENCE_TICKS: u8 = 40;
/// Excess of the room's reading over the skin's, K, above which their thermistors count as swapped or misplaced. The
/// skin of a finger is warmer than the room, except for cold hands of 17 °C in a warm room; without a finger its
/// thermistor reads the room.
const ROOM_ABOVE_SKIN_MAX: Celsius = Celsius::lit("8");
/// Net ticks of 1 ms at which [`Fault::RoomAboveSkin`] trips the station: counted up in each tick in which the room reads
/// more than [`ROOM_ABOVE_SKIN_MAX`] above the skin, and down in each other one.
const ROOM_ABOVE_SKIN_TICKS: u8 = 40;
/// Net ticks of 1 ms at which [`Fault::UnlikeModel`] trips the station: counted up in each tick in which the plate
/// observer's residual exceeds that of a sound tile, and down in each other one.
const RESIDUAL_TICKS: u8 = 30;
/// Ticks of 1 ms without a line from the host, while telemetry streams and a set-point is followed, that trip the
/// station by [`Fault::HostSilent`].
const HOST_SILENT_TICKS: u16 = 2000;

/// What the tick before demanded of the bridge, and found: the detectors compare this tick's readings with it, because
/// they are the first that respond to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PreviousActuation {
    /// Current that the tick before demanded of the bridge, A; positive cools the display; zero if the bridge was off.
    pub demanded: Current,
    /// Set-point that the display followed in the tick before; `None` if the bridge was off or the self-test ran, when
    /// neither the residual nor a silent host trips the station.
    pub setpoint: Option<Setpoint>,
    /// The plate observer's residual exceeded 3.75 K (8 K on a tile that was never identified) in the tick before. The
    /// residual of the present tick is computed only after the detectors have seen its readings.
    pub residual_is_large: bool,
}

/// The detectors of one station that remember earlier ticks, and the thermal dose of its display. What a single tick
/// shows is checked by [`validate_readings`](super::validate_readings) instead.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultDetectors {
    frozen: FrozenDetector,
    jump: JumpDetector,
    display_difference: DebounceCounter,
    room_above_skin: DebounceCounter,
    current_mismatch: CurrentMismatchDetector,
    wrong_way: WrongWayDetector,
    residual: DebounceCounter,
    dose: ThermalDose,
    host_silent_ticks: u16,
}

impl FaultDetectors {
    /// Restarts the 2 s after which a host that has asked for telemetry counts as silent. To be called for each line
    /// from the host.
    pub const fn note_host_activity(&mut self) {
        self.host_silent_ticks = 0;
    }

    /// Thermal dose that the display would have given to skin that always touched it. The board stores it after every
    /// tick, so that a reset does not erase it.
    #[must_use]
    pub const fn dose(&self) -> &ThermalDose {
        &self.dose
    }

    /// Continues from the thermal dose that was stored before a reset. To be called once, at the start.
    pub const fn restore_dose(&mut self, dose: ThermalDose) {
        self.dose = dose;
    }

    /// Compares the samples of this tick with those before, even if they are no valid readings.
    ///
    /// # Errors
    /// The samples of one thermistor, of the force sensor or of all channels have repeated unchanged for 46 ticks.
    pub fn check_samples(&mut self, samples: &Samples) -> Result<(), Fault> {
        self.frozen.check_samples(samples)
    }

    /// Counts the tick in the thermal dose, at the temperature that the warmer of the display's two thermistors reads;
    /// if both are invalid, the dose stays. To be called in every tick, even if other readings are invalid.
    ///
    /// # Errors
    /// [`Fault::Dose`]: the dose is half a minute at 43 °C or more.
    pub fn add_to_dose(&mut self, readings: &Readings) -> Result<(), Fault> {
        let display = [readings.display, readings.display_check];
        self.dose.add_tick(|| display.into_iter().flatten().max())
    }

    /// Shows the valid readings of this tick, and what the tick before demanded, to every detector that needs valid
    /// readings. `streams` tells whether the host has asked for telemetry.
    ///
    /// # Errors
    /// The first detected fault in this order: jump, display thermistors apart, current, wrong direction, residual,
    /// room above skin, silent host. The detectors after it have counted the tick, too.
    pub fn check_readings(
        &mut self,
        readings: &ValidReadings,
        previous: &PreviousActuation,
        streams: bool,
    ) -> Result<(), Fault> {
        let above_setpoint = previous.setpoint.map_or(Celsius::ZERO, |setpoint| {
            readings.display.saturating_sub(setpoint.celsius())
        });
        let difference = readings.display.saturating_sub(readings.check);
        let displays_differ = self.display_difference.count_tick(
            difference.saturating_abs() > DISPLAY_DIFFERENCE_MAX,
            DISPLAY_DIFFERENCE_TICKS,
        );
        let room_above_skin = self.room_above_skin.count_tick(
            readings.room.saturating_sub(readings.skin) > ROOM_ABOVE_SKIN_MAX,
            ROOM_ABOVE_SKIN_TICKS,
        );
        let follows_setpoint = previous.setpoint.is_some();
        let unlike_model = self.residual.count_tick(
            follows_setpoint && previous.residual_is_large,
            RESIDUAL_TICKS,
        );
        self.host_silent_ticks = if streams && follows_setpoint {
            self.host_silent_ticks.saturating_add(1)
        } else {
            0
        };
        let host_silent = self.host_silent_ticks >= HOST_SILENT_TICKS;
        let current = (self.current_mismatch).check_current(previous.demanded, readings.current);
        let wrong_way =
            (self.wrong_way).check_direction(previous.demanded, readings.display, above_setpoint);
        (self.jump.check_movement(readings))
            .and(fault_if(displays_differ, Fault::DisplaysApart))
            .and(current)
            .and(wrong_way)
            .and(fault_if(unlike_model, Fault::UnlikeModel))
            .and(fault_if(room_above_skin, Fault::RoomAboveSkin))
            .and(fault_if(host_silent, Fault::HostSilent))
    }

    /// Lets the detectors of jumps and of movement against the current start again with the next readings. To be called
    /// when readings were invalid, or when a new calibration changes them, because neither change is a movement of the
    /// display.
    pub fn forget_motion(&mut self) {
        self.jump = JumpDetector::default();
        self.wrong_way = WrongWayDetector::default();
    }
}

const fn fault_if(condition: bool, fault: Fault) -> Result<(), Fault> {
    if condition { Err(fault) } else { Ok(()) }
}
