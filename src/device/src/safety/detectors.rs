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

/// Largest difference of the display's thermistors, and the ticks for which it must last. Thermistors whose lags differ by
/// 0.1 s differ by 1.6 K while the bridge at its limit moves a bare display.
const DISPLAY_DIFFERENCE_MAX: Celsius = Celsius::lit("3");
const DISPLAY_DIFFERENCE_TICKS: u8 = 40;
/// Largest difference of the room above the skin, and the ticks for which it must last. The skin of a finger is warmer than
/// the room, except for cold hands of 17 °C in a warm room; without a finger both are equal.
const ROOM_ABOVE_SKIN_MAX: Celsius = Celsius::lit("8");
const ROOM_ABOVE_SKIN_TICKS: u8 = 40;
/// Ticks for which the plate's residual must be large.
const RESIDUAL_TICKS: u8 = 30;
/// Ticks without a line after which a host that has asked for telemetry is silent.
const HOST_SILENT_TICKS: u16 = 2000;

/// What the bridge did in the tick before: the readings of this tick respond to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PreviousActuation {
    /// Current that was demanded of the bridge, A; zero while it was off.
    pub demanded: Current,
    /// Set-point; `None` while the bridge was off or the self-test ran.
    pub setpoint: Option<Setpoint>,
    /// The plate's residual exceeded that of a sound tile. It is known only after the current of a tick has been chosen.
    pub residual_is_large: bool,
}

/// All detectors, and the thermal dose.
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
    /// Notes that the host has sent something.
    pub const fn note_host_activity(&mut self) {
        self.host_silent_ticks = 0;
    }

    /// Thermal dose that the display may have given to the skin so far.
    #[must_use]
    pub const fn dose(&self) -> &ThermalDose {
        &self.dose
    }

    /// Continues from the thermal dose before a reset.
    pub const fn restore_dose(&mut self, dose: ThermalDose) {
        self.dose = dose;
    }

    /// Checks samples that may be invalid as readings.
    ///
    /// # Errors
    /// A channel is frozen.
    pub fn check_samples(&mut self, samples: &Samples) -> Result<(), Fault> {
        self.frozen.check(samples)
    }

    /// Adds to the thermal dose what the warmer of the display's thermistors reads, even if other readings are invalid.
    ///
    /// # Errors
    /// The dose has reached its limit.
    pub fn check_dose(&mut self, readings: &Readings) -> Result<(), Fault> {
        let display = [readings.display, readings.display_check];
        self.dose.check(|| display.into_iter().flatten().max())
    }

    /// Checks valid readings; `streams` tells whether the host has asked for telemetry.
    ///
    /// # Errors
    /// The first fault in a fixed order. Every detector sees every tick, whatever the others find.
    pub fn check(
        &mut self,
        readings: &ValidReadings,
        previous: &PreviousActuation,
        streams: bool,
    ) -> Result<(), Fault> {
        let above_setpoint = previous.setpoint.map_or(Celsius::ZERO, |setpoint| {
            readings.display.saturating_sub(setpoint.celsius())
        });
        let difference = readings.display.saturating_sub(readings.check);
        let displays_differ = self.display_difference.update(
            difference.saturating_abs() > DISPLAY_DIFFERENCE_MAX,
            DISPLAY_DIFFERENCE_TICKS,
        );
        let room_above_skin = self.room_above_skin.update(
            readings.room.saturating_sub(readings.skin) > ROOM_ABOVE_SKIN_MAX,
            ROOM_ABOVE_SKIN_TICKS,
        );
        let follows_setpoint = previous.setpoint.is_some();
        let unlike_model = self.residual.update(
            follows_setpoint && previous.residual_is_large,
            RESIDUAL_TICKS,
        );
        self.host_silent_ticks = if streams && follows_setpoint {
            self.host_silent_ticks.saturating_add(1)
        } else {
            0
        };
        let host_silent = self.host_silent_ticks >= HOST_SILENT_TICKS;
        let current = (self.current_mismatch).check(previous.demanded, readings.current);
        let wrong_way = (self.wrong_way).check(previous.demanded, readings.display, above_setpoint);
        (self.jump.check(readings))
            .and(fault_if(displays_differ, Fault::DisplaysApart))
            .and(current)
            .and(wrong_way)
            .and(fault_if(unlike_model, Fault::UnlikeModel))
            .and(fault_if(room_above_skin, Fault::RoomAboveSkin))
            .and(fault_if(host_silent, Fault::HostSilent))
    }

    /// Forgets what the display has done so far, because readings were invalid or are by another calibration now: the next
    /// ones are no movement.
    pub fn forget_motion(&mut self) {
        self.jump = JumpDetector::default();
        self.wrong_way = WrongWayDetector::default();
    }
}

const fn fault_if(condition: bool, fault: Fault) -> Result<(), Fault> {
    if condition { Err(fault) } else { Ok(()) }
}
