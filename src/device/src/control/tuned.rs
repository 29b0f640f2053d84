//! What the laws know of a tile, ready for the tick.

use contact_model::fixed_point::Celsius;

use super::lag::Share;
use super::pi::{Period, Response};
use super::plate::Plate;
use thermal_settings::{Settings, Tile};

/// Residual that a sound tile never has: one that was tuned, and one of which only the class is known, which comes to 7.3 K in
/// slews of modules at the ends of their tolerances on sensors of 0.5 s.
const RESIDUAL: Celsius = Celsius::lit("3.75");
const CLASS_RESIDUAL: Celsius = Celsius::lit("8");

/// The laws' constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    pub(super) pi: Response,
    pub(super) pi_10hz: Response,
    pub(super) plate: Plate,
    /// Of the display's thermistor.
    pub(super) sensor: Share,
    /// The most of a sound tile.
    pub(super) residual: Celsius,
}

impl Tuned {
    /// `f64`, about a millisecond's worth of it in software: not for the tick.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        Self {
            pi: Response::new(&settings.gains, Period::EveryTick),
            pi_10hz: Response::new(&settings.gains_10hz, Period::TenthOfASecond),
            plate: Plate::new(&settings.module, &settings.tile),
            sensor: Share::of(settings.tile.sensor_lag_s),
            residual: if settings.tile == Tile::CLASS {
                CLASS_RESIDUAL
            } else {
                RESIDUAL
            },
        }
    }
}
