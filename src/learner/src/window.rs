//! What was measured in a window.

use contact_model::fixed_point::Celsius;
use fixed::types::{I20F12, U16F16};

use crate::parameters::PlaceBeforeContact;
use crate::person::PersonPrior;
use crate::sensor::FluxSensor;

/// Ticks of 1 ms in a window.
pub const WINDOW_TICKS: u32 = 10;
pub(crate) const WINDOW_S: f64 = WINDOW_TICKS as f64 * 1e-3;

/// Heat flux, W/m²: ±524 kW/m², resolution 2.4e-4 W/m².
pub type Flux = I20F12;
/// Thermal resistance, mm² K/W (1e-6 m² K/W): 0 to 65 536, resolution 1.5e-5.
pub type Resistance = U16F16;

/// Begins to learn another finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Restart {
    /// Where the finger is before each contact.
    pub place: PlaceBeforeContact,
    /// The sensor that measures its flux.
    pub sensor: FluxSensor,
    /// What is known of the finger; `None` for nothing.
    pub person: Option<PersonPrior>,
}

/// Measurements of one window of ten ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LearnerInput {
    /// Number of the window, which the output repeats.
    pub sequence: u16,
    /// Begins anew before this window.
    pub restart: Option<Restart>,
    /// Measured flux out of the skin, mean of the ten ticks; those without contact count as 0, except in the first five lags of
    /// the sensor after lifting. `None` if the sensor was beyond its range or faulty in a tick.
    pub flux_w_m2: Option<Flux>,
    /// The contact; `None` if no tick of the window had one.
    pub contact: Option<ContactInput>,
}

/// Measurements of a window with contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactInput {
    /// Ticks with contact, 1 to 10.
    pub touching_ticks: u8,
    /// Skin temperature before contact less that of the display's surface, below the flux sensor, K; mean of the ten ticks,
    /// those without contact counted as 0.
    pub skin_above_display_k: Celsius,
    /// Flux that the film of air has taken from the assumed finger's skin before contact.
    pub air_flux_w_m2: Flux,
    /// Thermal resistance between skin and display at the window's mean force by the finger's contact law, without the factor that is
    /// learnt and without the layer of the flux sensor.
    pub resistance_mm2k_w: Resistance,
    /// Ticks since landing, at the window's end; 0 if the finger has lifted by then.
    pub ticks_since_landing: u32,
    /// Whether the finger may be learnt from this window: force steady or slowly changing, temperatures valid, the display not
    /// at a limit.
    pub is_steady: bool,
}
