//! Parameters of the control laws for one tile, in fixed point.

use contact_model::fixed_point::Celsius;
use thermal_settings::Settings;

use crate::estimate::{ObserverParameters, PlateModel};
use crate::low_pass::Coefficient;
use crate::pi::{PiCoefficients, UpdatePeriod};
use crate::reference::ReferenceLimits;

/// Largest residual of the plate's observer, K, that is permitted on a tile that has been identified. The residual is
/// the difference between the display's reading and the modelled reading, filtered, plus 0.5 K per ampere of the
/// observer's correcting current. If a larger residual lasts for 30 ms while the display follows a set-point, the
/// station trips with the fault `unlike-model`.
const OBSERVER_RESIDUAL_MAX_IDENTIFIED_TILE: Celsius = Celsius::lit("3.75");
/// Largest residual of the plate's observer, K, that is permitted before the tile has been identified; a larger one
/// that lasts for 30 ms while the display follows a set-point trips the station with the fault `unlike-model`. It is
/// larger than the limit for an identified tile, because fast temperature changes of sound modules at the ends of their
/// tolerances, with thermistors of 0.5 s lag, cause residuals of up to 7.3 K.
const OBSERVER_RESIDUAL_MAX_NOMINAL_TILE: Celsius = Celsius::lit("8");

/// Gains and models of all control laws for one tile. They are converted from the settings in advance, so that the
/// control tick needs no floating point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlParameters {
    /// Gains of the law `pi`, which updates its current at every tick; the observer's loop for the correcting current
    /// uses the same gains.
    pub pi: PiCoefficients,
    /// Gains of the law `pi-10hz`, which reads the error and changes its current ten times a second.
    pub pi_10hz: PiCoefficients,
    /// Constants of the plate's observer, on which the law `model`, the bridge voltage, and the fault `unlike-model`
    /// depend.
    pub observer: ObserverParameters,
    /// How the reference is limited.
    pub reference_limits: ReferenceLimits,
}

impl ControlParameters {
    /// Converts the settings of one finger to fixed point. Takes about a millisecond of floating-point computation, so
    /// it is too slow for the control tick: for start-up and the task that serves the host.
    pub fn new(settings: &Settings) -> Self {
        let pi = PiCoefficients::new(&settings.gains, UpdatePeriod::EveryTick);
        Self {
            pi,
            pi_10hz: PiCoefficients::new(&settings.gains_10hz, UpdatePeriod::TenthOfASecond),
            observer: ObserverParameters {
                plate: PlateModel::new(&settings.module, &settings.tile),
                sensor: Coefficient::from_time_constant_s(settings.tile.sensor_lag_s),
                correction: pi,
                largest_residual: if settings.tile.is_identified() {
                    OBSERVER_RESIDUAL_MAX_IDENTIFIED_TILE
                } else {
                    OBSERVER_RESIDUAL_MAX_NOMINAL_TILE
                },
            },
            reference_limits: ReferenceLimits::new(&settings.tile),
        }
    }
}
