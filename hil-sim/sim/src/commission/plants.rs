//! The places that a device is put in to be commissioned.

use contact_model::material::MATERIALS;
use thermal_plant::finger::FingerParams;
use thermal_plant::object::ObjectConfig;
use thermal_plant::parameters::stream_seed;
use thermal_plant::slab::BackBoundary;
use thermal_plant::{ConfigError, Params, PlantConfig};

use crate::World;

/// Skin thermistor on a hand, deg C, while the display is calibrated.
const SKIN_C: f64 = 33.0;
/// Longest time in one place, s.
const LONGEST_S: f64 = 3600.0;

/// One device, and the places it can be in.
#[derive(Clone, Debug)]
pub struct Plants {
    params: Params,
    room_c: f64,
    seed: u64,
}

impl Plants {
    /// A device of these parts, the seed of its converter, and the room, deg C, it is used in. No finger is near.
    #[must_use]
    pub fn new(params: &Params, room_c: f64, seed: u64) -> Self {
        Self {
            params: Params {
                finger: FingerParams::homogeneous(),
                ..params.clone()
            },
            room_c,
            seed,
        }
    }

    /// Tells devices apart.
    pub(super) fn key(&self) -> String {
        format!("{self:?}")
    }

    /// The host's reference thermometer's.
    #[must_use]
    pub const fn params(&self) -> &Params {
        &self.params
    }

    /// The seed of the operator's own draws.
    pub(super) fn operator_seed(&self) -> u64 {
        stream_seed(self.seed, "reference thermometer")
    }

    /// Where it is used.
    ///
    /// # Errors
    /// A value that the plant cannot take.
    pub fn at_work(&self) -> Result<World, ConfigError> {
        self.world(self.params.clone(), SKIN_C, self.room_c, "at work")
    }

    /// The skin's thermistor in a bath, deg C.
    ///
    /// # Errors
    /// A value that the plant cannot take.
    pub fn skin_in_bath(&self, bath_c: f64) -> Result<World, ConfigError> {
        self.world(
            self.params.clone(),
            bath_c,
            self.room_c,
            &format!("skin {bath_c}"),
        )
    }

    /// The room's thermistor in a bath, deg C.
    ///
    /// # Errors
    /// A value that the plant cannot take.
    pub fn room_in_bath(&self, bath_c: f64) -> Result<World, ConfigError> {
        let mut params = self.params.clone();
        params.tile.coolant_k = 0.0;
        self.world(params, SKIN_C, bath_c, &format!("room {bath_c}"))
    }

    /// The sink, and with it the display, on a coolant of a temperature, deg C.
    ///
    /// # Errors
    /// A value that the plant cannot take.
    pub fn sink_on_coolant(&self, coolant_c: f64) -> Result<World, ConfigError> {
        let mut params = self.params.clone();
        params.tile.coolant_k = coolant_c - self.room_c;
        self.world(params, SKIN_C, self.room_c, &format!("sink {coolant_c}"))
    }

    fn world(
        &self,
        params: Params,
        skin_c: f64,
        room_c: f64,
        place: &str,
    ) -> Result<World, ConfigError> {
        let (_, material) = MATERIALS[0];
        let config = PlantConfig {
            skin_c,
            room_c,
            object: ObjectConfig {
                material,
                start_c: room_c,
                thickness_m: f64::INFINITY,
                back: BackBoundary::Insulated,
            },
            start_s: 0.0,
            appears_s: LONGEST_S,
            duration_s: LONGEST_S,
            seed: self.seed,
            params,
        };
        World::of_plant(&config, stream_seed(self.seed, place))
    }
}
