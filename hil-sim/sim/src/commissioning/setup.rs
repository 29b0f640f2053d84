//! The environments in which a device is commissioned.

use contact_model::material::MATERIALS;
use thermal_plant::contact::ContactLaw;
use thermal_plant::finger::FingerParams;
use thermal_plant::object::ObjectConfig;
use thermal_plant::parameters::stream_seed;
use thermal_plant::{ConfigError, Params, PlantConfig};

use crate::World;

/// Temperature of the skin thermistor while the display is calibrated, deg C.
const SKIN_C: f64 = 33.0;
/// Longest time in one environment, s.
const STAY_MAX_S: f64 = 3600.0;

/// A device and the environments in which it is commissioned.
#[derive(Clone, Debug)]
pub struct CommissioningSetup {
    params: Params,
    room_c: f64,
    seed: u64,
}

impl CommissioningSetup {
    /// A device with these parameters and this seed of its converter, used in a room, deg C, without a finger.
    #[must_use]
    pub fn new(params: &Params, room_c: f64, seed: u64) -> Self {
        Self {
            params: Params {
                finger: FingerParams::homogeneous(),
                contact: ContactLaw::NOMINAL,
                ..params.clone()
            },
            room_c,
            seed,
        }
    }

    /// A key that is unique to the device.
    pub(super) fn key(&self) -> String {
        format!("{self:?}")
    }

    /// Parameters of the device and of the reference thermometer.
    #[must_use]
    pub const fn params(&self) -> &Params {
        &self.params
    }

    /// Room of the place of use, deg C.
    pub(super) const fn room_c(&self) -> f64 {
        self.room_c
    }

    /// Seed of the reference thermometer's noise.
    pub(super) fn operator_seed(&self) -> u64 {
        stream_seed(self.seed, "reference thermometer")
    }

    /// The place of use.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn in_use(&self) -> Result<World, ConfigError> {
        self.world(self.params.clone(), SKIN_C, self.room_c, "at work")
    }

    /// The place of use with the skin thermistor in the air.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn on_the_bench(&self) -> Result<World, ConfigError> {
        self.world(
            self.params.clone(),
            self.room_c,
            self.room_c,
            "on the bench",
        )
    }

    /// The skin thermistor in a bath, deg C.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn skin_in_bath(&self, bath_c: f64) -> Result<World, ConfigError> {
        self.world(
            self.params.clone(),
            bath_c,
            self.room_c,
            &format!("skin {bath_c}"),
        )
    }

    /// The room thermistor in a bath, deg C.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn room_in_bath(&self, bath_c: f64) -> Result<World, ConfigError> {
        let mut params = self.params.clone();
        params.tile.coolant_k = 0.0;
        self.world(params, SKIN_C, bath_c, &format!("room {bath_c}"))
    }

    /// The sink, and with it the display, at the temperature of a coolant, deg C.
    ///
    /// # Errors
    /// The plant does not accept a value.
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
            object: ObjectConfig::half_space(material, room_c),
            start_s: 0.0,
            appears_s: STAY_MAX_S,
            duration_s: STAY_MAX_S,
            seed: self.seed,
            params,
        };
        World::from_plant(&config, stream_seed(self.seed, place))
    }
}
