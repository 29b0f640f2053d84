//! Estimates of what no thermistor measures: temperatures of the display's surface and of the module's legs, the skin's
//! temperature under the finger, and the contact.

mod assumed_skin;
mod finger;
mod force_means;
mod plate_model;
mod plate_observer;
mod skin_state;

pub use finger::{FingerContact, FingerEstimator, FluxPerMm2, PreContactTemperatures};
pub use force_means::{ForceChange, ForceMeans};
pub use plate_model::{LegTemperatures, PlateModel, Watt};
pub use plate_observer::{ObserverParameters, PlateObserver};
pub use skin_state::{Bodies, SkinState, flux_beyond_air};

use contact_model::fixed_point::{Celsius, ContactPair, Force};

use crate::safety::ValidReadings;

/// Plate temperatures as estimated before this tick's reading corrects the observer. The finger's heat flow, the check
/// of the display's temperature at landing, and the bridge voltage are computed from them, because the correction
/// itself needs the finger's heat flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlateEstimateBeforeReading {
    /// Temperature of the display's surface under the finger, °C, at the end of the previous tick. The finger's heat
    /// flow is computed from this temperature, and in the first tick of a contact the reference generator checks
    /// whether the display was near its preset. It is the reading of the display's thermistor if the observer has no
    /// valid model: before its first reading, and after `invalidate`.
    pub previous_surface: Celsius,
    /// Temperatures of the module's legs, °C, at the end of the previous tick; the voltage of the bridge is computed
    /// from them. They are derived from the readings of display and sink if the observer has no valid model: before its
    /// first reading, and after `invalidate`.
    pub previous_legs: LegTemperatures,
}

/// The two estimators of one finger's station: one for the display plate with its Peltier module, one for the finger on
/// the plate.
#[derive(Clone, Debug)]
pub struct Estimator {
    /// Observer of the display plate: estimates the temperatures of the display's surface and of the module's legs.
    pub plate: PlateObserver,
    /// Estimator of the finger: the skin's temperature before contact, the force, and the skin's cooling by the
    /// display.
    pub finger: FingerEstimator,
}

impl Estimator {
    /// Updates the estimates of finger and plate by the valid readings of one tick, and returns the plate's
    /// temperatures as estimated before this update. `touch` is the force, N, of a finger that touches, or `None`.
    /// `landed_ticks` is the number of ticks of 1 ms since the force rose from zero, at most 32; it is used only in the
    /// first tick of a contact. `pair` holds the thermal properties of finger, object and display; without `pair` the
    /// finger's heat is taken as zero.
    #[inline(always)]
    pub fn update_estimates(
        &mut self,
        readings: &ValidReadings,
        touch: Option<Force>,
        landed_ticks: u32,
        pair: Option<&ContactPair>,
        bodies: &Bodies,
    ) -> PlateEstimateBeforeReading {
        let ValidReadings { display, sink, skin, room, .. } = *readings;
        let estimate = PlateEstimateBeforeReading {
            previous_surface: self.plate.surface().unwrap_or(display),
            previous_legs: (self.plate.leg_end_and_mean_temperatures())
                .unwrap_or_else(|| LegTemperatures::between_display_and_sink(display, sink)),
        };
        self.finger.update_by_readings(skin, room, touch, landed_ticks);
        let heat = pair.map_or(Watt::ZERO, |pair| {
            (self.finger).step_skin_heat_flow(pair, bodies, estimate.previous_surface)
        });
        self.plate.update_disturbance_and_correction(display, sink, heat);
        estimate
    }

    /// Discards all estimates of plate and finger; they start again from the next valid readings. Called in each tick
    /// whose readings are invalid or in which a fault detector finds a fault, because such a tick does not update the
    /// estimates.
    pub fn invalidate(&mut self) {
        self.plate.invalidate();
        self.finger.invalidate();
    }
}
