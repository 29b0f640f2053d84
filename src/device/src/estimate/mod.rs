//! What readings alone do not show: the display's surface behind its thermistor, the module's legs, and the finger.

mod finger;
mod force_mean;
mod plate_model;
mod plate_observer;

pub use finger::{FingerContact, FingerEstimator, PreContactTemperatures};
pub use force_mean::{ForceChange, ForceMean};
pub use plate_model::{LegTemperatures, PlateModel, Watt};
pub use plate_observer::{ObserverParameters, PlateObserver};

use contact_model::fixed_point::{Celsius, ContactPair, Force};

use crate::safety::ValidReadings;

/// Estimated temperatures before this tick's reading corrects the observer. The finger's heat, the start of a contact
/// and the bridge voltage are computed from them, because the correction itself needs the finger's heat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UncorrectedEstimate {
    /// Temperature of the display's surface under the finger, °C; the reading of the display's thermistor if the
    /// observer has not started yet.
    pub previous_surface: Celsius,
    /// Temperatures of the module's legs, °C, at the end of the tick before; from the readings of display and sink if
    /// the observer has not started yet.
    pub previous_legs: LegTemperatures,
}

/// The two estimators of one finger's station: of the display plate with the Peltier module, and of the finger on it.
#[derive(Clone, Debug)]
pub struct Estimator {
    /// Observer of the temperatures of the display's surface and the module's legs.
    pub plate: PlateObserver,
    /// Estimator of the skin's temperature, the force, and the contact.
    pub finger: FingerEstimator,
}

impl Estimator {
    /// Takes the valid readings of one tick; corrects the estimates of finger and plate, and returns those from before
    /// the correction. `touch` is the force, N, of a finger that touches; `landed_ticks` the ticks since the force left
    /// its zero, in the first tick of a contact; `pair` describes finger, object and display, and without it the finger
    /// gives no heat.
    #[inline(always)]
    pub fn update_estimates(
        &mut self,
        readings: &ValidReadings,
        touch: Option<Force>,
        landed_ticks: u32,
        pair: Option<&ContactPair>,
    ) -> UncorrectedEstimate {
        let ValidReadings {
            display,
            sink,
            skin,
            room,
            ..
        } = *readings;
        let estimate = UncorrectedEstimate {
            previous_surface: self.plate.surface().unwrap_or(display),
            previous_legs: (self.plate.leg_temperatures())
                .unwrap_or_else(|| LegTemperatures::between_display_and_sink(display, sink)),
        };
        self.finger.observe(skin, room, touch, landed_ticks);
        let heat = pair.map_or(Watt::ZERO, |pair| {
            (self.finger).heat_into_display(pair, estimate.previous_surface)
        });
        self.plate.correct_by_reading(display, sink, heat);
        estimate
    }

    /// Discards all estimates, which start again from the next valid readings. Called in a tick whose readings are
    /// invalid, because then temperatures and finger may change unseen.
    pub fn invalidate(&mut self) {
        self.plate.invalidate();
        self.finger.invalidate();
    }
}
