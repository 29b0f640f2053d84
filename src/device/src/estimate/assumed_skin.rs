//! A skin that the host assumes for set-points, beside the one that touches the display.
//!
//! The reference needs the skin as it would be if it had had the assumed temperature. The heat into the display comes
//! from the finger that is there, so while a skin is assumed, the sensed one has a temperature and a thermal state of
//! its own.

use contact_model::fixed_point::{Celsius, ContactConductance};

use super::finger::{PreContactTemperatures, filter_skin_or_room};
use super::skin_state::{Bodies, SkinState};

/// Temperature that is assumed for the skin before contact, and the sensed skin, whose estimates go on as if no skin
/// were assumed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssumedSkin {
    /// Assumed temperature of the skin before contact, °C.
    pub temperature: Celsius,
    /// Filtered temperature before contact of the sensed skin, °C; `None` until a first reading.
    pub sensed: Option<Celsius>,
    /// Thermal state of the sensed skin.
    pub sensed_state: SkinState,
}

impl AssumedSkin {
    /// Updates the temperature of the sensed skin by a reading of the sensor, °C; `is_undisturbed` means that the sensor
    /// shows no contact, present or past. Returns the assumed temperature, °C.
    #[cold]
    #[inline(never)]
    pub fn update_by_reading(&mut self, reading: Celsius, is_undisturbed: bool) -> Celsius {
        self.sensed = Some(match self.sensed {
            None => reading,
            Some(sensed) if is_undisturbed => filter_skin_or_room(sensed, reading),
            Some(sensed) => sensed,
        });
        self.temperature
    }

    /// [`SkinState::step_on_display`] of the sensed skin.
    #[cold]
    #[inline(never)]
    pub fn step_sensed_skin(
        &mut self,
        display: Option<&ContactConductance>,
        bodies: &Bodies,
        room: Celsius,
        surface: Celsius,
    ) -> Celsius {
        let Some(skin) = self.sensed else {
            return Celsius::ZERO;
        };
        let before = PreContactTemperatures { skin, room };
        (self.sensed_state).step_on_display(display, bodies, &before, surface)
    }
}
