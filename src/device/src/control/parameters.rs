//! What the control laws know of a tile, in fixed point.

use contact_model::fixed_point::Celsius;
use thermal_settings::{Settings, Tile};

use crate::estimate::{ObserverParameters, PlateModel};
use crate::low_pass::Coefficient;
use crate::pi::{PiCoefficients, UpdatePeriod};

/// Largest residual of a sound tile that was identified, K.
const IDENTIFIED_TILE_RESIDUAL_MAX: Celsius = Celsius::lit("3.75");
/// The same of a tile of which only the class is known: slews of modules at the ends of their tolerances, on thermistors of
/// 0.5 s lag, reach 7.3 K.
const CLASS_TILE_RESIDUAL_MAX: Celsius = Celsius::lit("8");

/// Gains and models of all laws, converted from settings so that the tick needs no floating point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlParameters {
    /// Gains of the law `pi`.
    pub pi: PiCoefficients,
    /// Gains of the law `pi-10hz`.
    pub pi_10hz: PiCoefficients,
    /// Constants of the plate's observer.
    pub observer: ObserverParameters,
}

impl ControlParameters {
    /// Converts settings. `f64` in software, about a millisecond: for start-up and the host's task, not for the tick.
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
