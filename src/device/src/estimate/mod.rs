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

/// What the estimator knows of a tick before its current is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UncorrectedEstimate {
    /// Surface of the display before this tick's reading corrects the observer: the finger's heat, the contact's start and
    /// the voltage are computed from it, because the correction itself needs the finger's heat.
    pub previous_surface: Celsius,
    /// Temperatures of the legs at the same time.
    pub previous_legs: LegTemperatures,
}

/// One estimator of plate and finger.
#[derive(Clone, Debug)]
pub struct Estimator {
    /// Observer of the display plate and the legs.
    pub plate: PlateObserver,
    /// Estimator of the skin and the contact.
    pub finger: FingerEstimator,
}

impl Estimator {
    /// Takes the readings of one tick. `touch` is the force of a finger that touches, `landed_ticks` how long ago a contact
    /// that begins has begun, `pair` the pair by which skin and display touch.
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

    /// Starts again from the next readings, because this tick has none that are valid.
    pub fn invalidate(&mut self) {
        self.plate.invalidate();
        self.finger.invalidate();
    }
}
