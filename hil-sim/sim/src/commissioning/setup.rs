//! The environments in which a device is commissioned.

use contact_model::material::MATERIALS;
use thermal_plant::contact::ContactLaw;
use thermal_plant::finger::FingerParams;
use thermal_plant::object::ObjectConfig;
use thermal_plant::parameters::{Tolerance, absolute, relative, stream_seed};
use thermal_plant::slab::{Layer, Medium};
use thermal_plant::{ConfigError, Params, PlantConfig};

use crate::World;

/// Temperature of the skin thermistor while the display is calibrated, deg C.
const SKIN_C: f64 = 33.0;
/// Longest time in one environment, s.
const STAY_MAX_S: f64 = 3600.0;

/// Errors of the phantom, one standard deviation: 0.5 % of its effusivity; 0.1 K of its temperature, which is the room's.
const EFFUSIVITY: Tolerance = relative(0.01).normal();
const FROM_ROOM: Tolerance = absolute(0.2).normal();
/// Contact resistance of a gel over that of skin: it wets the display.
const GEL_RESISTANCE: Tolerance = relative(0.5);
const GEL_RESISTANCE_FACTOR: f64 = 0.2;

/// The phantom with which the heat-flux sensor is calibrated: a half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulatedPhantom {
    /// Effusivity, W s½/(m² K).
    pub effusivity: f64,
    /// Contact resistance over that of skin.
    pub resistance_factor: f64,
    /// Temperature above the room's, K.
    pub above_room_k: f64,
}

impl SimulatedPhantom {
    /// Water with 1 % of agar at 25 °C: conductivity, W/(m K), and effusivity, W s½/(m² K).
    const GEL_W_MK: f64 = 0.604;
    const GEL_EFFUSIVITY: f64 = 1585.0;

    /// A gel with its errors, by a seed.
    pub fn gel(seed: u64, room_c: f64) -> Self {
        let effusivity = Self::GEL_EFFUSIVITY + 1.95 * (room_c - 25.0);
        Self {
            effusivity: EFFUSIVITY.draw(effusivity, seed, "phantom.effusivity"),
            resistance_factor: GEL_RESISTANCE.draw(GEL_RESISTANCE_FACTOR, seed, "phantom.contact"),
            above_room_k: FROM_ROOM.draw(0.0, seed, "phantom.temperature"),
        }
    }
}

/// A device and the environments in which it is commissioned.
#[derive(Clone, Debug)]
pub struct CommissioningSetup {
    params: Params,
    room_c: f64,
    seed: u64,
}

impl CommissioningSetup {
    /// A device with these parameters and this seed of its converter, used in a room, deg C, without a finger.
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

    /// The place of use with a phantom in place of the finger, beside the display.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn with_phantom(&self, phantom: &SimulatedPhantom) -> Result<World, ConfigError> {
        let conductivity_w_mk = SimulatedPhantom::GEL_W_MK;
        let medium = Medium {
            conductivity_w_mk,
            capacity_j_m3k: phantom.effusivity * phantom.effusivity / conductivity_w_mk,
            perfusion_w_m3k: 0.0,
            metabolism_w_m3: 0.0,
        };
        let mut params = self.params.clone();
        params.finger.layers = vec![Layer { thickness_m: f64::INFINITY, medium }];
        params.finger.resistance_factor = phantom.resistance_factor;
        self.world(params, self.room_c + phantom.above_room_k, self.room_c, "with a phantom")
    }

    /// The place of use with the skin thermistor in the air.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn on_the_bench(&self) -> Result<World, ConfigError> {
        self.world(self.params.clone(), self.room_c, self.room_c, "on the bench")
    }

    /// The skin thermistor in a bath, deg C.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn skin_in_bath(&self, bath_c: f64) -> Result<World, ConfigError> {
        self.world(self.params.clone(), bath_c, self.room_c, &format!("skin {bath_c}"))
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
        let [(_, any), ..] = MATERIALS;
        let config = PlantConfig {
            skin_c,
            room_c,
            object: ObjectConfig::half_space(any, room_c),
            start_s: 0.0,
            appears_s: STAY_MAX_S,
            duration_s: STAY_MAX_S,
            seed: self.seed,
            params,
        };
        World::from_plant(&config, stream_seed(self.seed, place))
    }
}
