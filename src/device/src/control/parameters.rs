//! What the control laws know of a tile, in fixed point.

use contact_model::fixed_point::Celsius;
use thermal_settings::{Settings, Tile};

use crate::estimate::{ObserverParameters, PlateModel};
use crate::low_pass::Coefficient;
use crate::pi::{PiCoefficients, UpdatePeriod};

/// Largest residual of the plate's observer, K, that a sound tile shows after its identification. A larger one that
/// lasts trips the station.
const IDENTIFIED_TILE_RESIDUAL_MAX: Celsius = Celsius::lit("3.75");
/// Largest residual of the plate's observer, K, before the tile has been identified. Larger than afterwards, because
/// slews of modules at the ends of their tolerances, on thermistors of 0.5 s lag, reach 7.3 K.
const CLASS_TILE_RESIDUAL_MAX: Celsius = Celsius::lit("8");

/// Gains and models of all control laws for one tile, converted from settings so that the tick needs no floating point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlParameters {
    /// Gains of the law `pi`; the observer's correction has the same.
    pub pi: PiCoefficients,
    /// Gains of the law `pi-10hz`, which takes the error ten times a second.
    pub pi_10hz: PiCoefficients,
    /// Constants of the plate's observer, which serves the law `model`, the bridge voltage, and the fault
    /// `unlike-model`.
    pub observer: ObserverParameters,
}

impl ControlParameters {
    /// Converts the settings of one finger. Takes about a millisecond of `f64` in software, so it is for start-up and
    /// the task that serves the host, not for the tick.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let pi = PiCoefficients::new(&settings.gains, UpdatePeriod::EveryTick);
        Self {
            pi,
            pi_10hz: PiCoefficients::new(&settings.gains_10hz, UpdatePeriod::TenthOfASecond),
            observer: ObserverParameters {
                plate: PlateModel::new(&settings.module, &settings.tile),
                sensor: Coefficient::from_time_constant_s(settings.tile.sensor_lag_s),
                correction: pi,
                largest_residual: if settings.tile == Tile::CLASS {
                    CLASS_TILE_RESIDUAL_MAX
                } else {
                    IDENTIFIED_TILE_RESIDUAL_MAX
                },
            },
        }
    }
}
