//! Configuration of a plant.

use contact_model::material::{REFERENCE_DISPLAY, Surface};

use super::bridge::BridgeParams;
use super::comparator::ComparatorParams;
use super::contact::ContactLaw;
use super::finger::{FingerParams, Vessels};
use super::object::ObjectConfig;
use super::parameters::{self, ParameterError};
use super::sensors::{FluxParams, SensorParams};
use super::slab::{BackBoundary, Layer};
use super::supply::SupplyParams;
use super::tile::TileParams;

/// One finger, its display and the real object that the display stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantConfig {
    /// Skin before contact, deg C.
    pub skin_c: f64,
    /// Room temperature, deg C; also that of tile and sink at the start, if the coolant has it.
    pub room_c: f64,
    /// The real object.
    pub object: ObjectConfig,
    /// Time of the first step, s; negative to let the device settle before zero.
    pub start_s: f64,
    /// Time from which the real object is present, s.
    pub appears_s: f64,
    /// Simulated time, s: it sets the depth to which half-spaces are meshed.
    pub duration_s: f64,
    /// Seed of all random draws.
    pub seed: u64,
    /// Parameters of the parts.
    pub params: Params,
}

/// Parameters of one finger with its display, electronics and host.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// The finger.
    pub finger: FingerParams,
    /// The display's surface.
    pub display: Surface,
    /// The contact of skin and surfaces.
    pub contact: ContactLaw,
    /// Tile and sink.
    pub tile: TileParams,
    /// Sensors and converter.
    pub sensors: SensorParams,
    /// Heat-flux sensor on the display; none if it is not fitted.
    pub flux: Option<FluxParams>,
    /// Power stage.
    pub bridge: BridgeParams,
    /// Comparator that cuts the supply of the power stage.
    pub comparator: ComparatorParams,
    /// Supply of the power stage behind the switch.
    pub supply: SupplyParams,
    /// Reference thermometer with which the host commissions the device.
    pub host: HostParams,
}

/// Reference thermometer at the host, with a resolution of 1 mK.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostParams {
    /// Offset of its readings, K.
    pub reference_offset_k: f64,
    /// Standard deviation of one reading, K.
    pub reference_noise_k: f64,
}

impl HostParams {
    /// A calibrated resistance thermometer.
    pub const NOMINAL: Self = Self { reference_offset_k: 0.0, reference_noise_k: 0.3e-3 };
}

impl Params {
    /// The reference design with the thesis's finger.
    pub fn nominal() -> Self {
        Self {
            finger: FingerParams::homogeneous(),
            display: REFERENCE_DISPLAY,
            contact: ContactLaw::NOMINAL,
            tile: TileParams::NOMINAL,
            sensors: SensorParams::NOMINAL,
            flux: None,
            bridge: BridgeParams::NOMINAL,
            comparator: ComparatorParams::NOMINAL,
            supply: SupplyParams::NOMINAL,
            host: HostParams::NOMINAL,
        }
    }
}

/// Coldest and warmest start temperature, deg C.
const TEMPERATURE_C: (f64, f64) = (-40.0, 100.0);
/// Coldest and warmest core of a finger, deg C.
const CORE_C: (f64, f64) = (0.0, 45.0);
/// Longest duration, s.
const LONGEST_S: f64 = 86_400.0;

/// Error of a configuration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// A value out of its range.
    #[error("{what} is {value}; allowed is {allowed}")]
    Value {
        /// Name and unit of the value.
        what: &'static str,
        /// The value.
        value: f64,
        /// Allowed range, in words.
        allowed: String,
    },
    /// A parameter out of its range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A finger without a heat source that loses heat to the air, and so has no steady state.
    #[error(
        "a finger without blood or core has air_w_m2k {air_w_m2k} or heat of metabolism; allowed is 0 of both, or \
         a core, or perfusion"
    )]
    ColdFinger {
        /// Film coefficient of the air on its surface, W/(m2 K).
        air_w_m2k: f64,
    },
}

impl ConfigError {
    pub(super) fn cold_finger(air_w_m2k: f64) -> Self {
        Self::ColdFinger { air_w_m2k }
    }

    fn value(what: &'static str, value: f64, allowed: impl Into<String>) -> Self {
        Self::Value { what, value, allowed: allowed.into() }
    }
}

impl PlantConfig {
    /// Checks each value, and the consistency of values that depend on each other.
    ///
    /// # Errors
    /// The first value that is not finite or outside of its range.
    pub fn check(&self) -> Result<(), ConfigError> {
        let (coldest, warmest) = TEMPERATURE_C;
        for (what, value) in
            [("skin temperature in deg C", self.skin_c), ("room temperature in deg C", self.room_c)]
        {
            within(what, value, coldest, warmest)?;
        }
        within("start time in s", self.start_s, -LONGEST_S, 0.0)?;
        within("time at which the object appears in s", self.appears_s, -LONGEST_S, LONGEST_S)?;
        positive("duration in s", self.duration_s)?;
        within("duration in s", self.duration_s, 0.0, LONGEST_S)?;
        check_object(&self.object)?;
        parameters::check(&self.params)?;
        check_consistency(&self.params)
    }
}

fn check_object(object: &ObjectConfig) -> Result<(), ConfigError> {
    let (coldest, warmest) = TEMPERATURE_C;
    let surface = &object.surface;
    for (what, value) in [
        ("object conductivity in W/(m K)", surface.conductivity_w_mk),
        ("object roughness in um", surface.roughness_um),
        ("object asperity slope in rad", surface.slope_rad),
    ] {
        positive(what, value)?;
    }
    for layer in &object.layers {
        positive("conductivity of an object's layer in W/(m K)", layer.medium.conductivity_w_mk)?;
        positive("heat capacity of an object's layer in J/(m3 K)", layer.medium.capacity_j_m3k)?;
        within(
            "thickness of an object's layer in m",
            layer.thickness_m,
            ObjectConfig::THINNEST_M,
            f64::INFINITY,
        )?;
    }
    check_order(
        &object.layers,
        "number of the object's layers",
        "thickness of an object's layer above another in m",
    )?;
    within("object temperature in deg C", object.start_c, coldest, warmest)?;
    if let BackBoundary::Film { film_w_m2k, temperature_c } = object.back {
        within("film behind the object in W/(m2 K)", film_w_m2k, 0.0, f64::INFINITY)?;
        within("temperature behind the object in deg C", temperature_c, coldest, warmest)?;
    }
    Ok(())
}

/// Checks parameters that depend on each other.
fn check_consistency(params: &Params) -> Result<(), ConfigError> {
    let Params { finger, tile, bridge, .. } = params;
    if tile.patch_m2 >= tile.plate_m2() {
        let allowed = format!("below the plate's area, {}", tile.plate_m2());
        return Err(ConfigError::value("tile.patch_m2", tile.patch_m2, allowed));
    }
    if let Some(Vessels { open_n, shut_n }) = finger.vessels
        && open_n >= shut_n
    {
        let allowed = format!("below finger.vessels.shut_n, {shut_n}");
        return Err(ConfigError::value("finger.vessels.open_n", open_n, allowed));
    }
    let half_period_s = 0.5 / bridge.pwm_hz;
    if bridge.dead_time_s > half_period_s {
        let allowed = format!("up to half a period, {half_period_s:e}");
        return Err(ConfigError::value("bridge.dead_time_s", bridge.dead_time_s, allowed));
    }
    let last = check_order(
        &finger.layers,
        "number of the finger's layers",
        "thickness of a finger's layer above another in m",
    )?;
    if let Some(core_w_m2k) = finger.core_w_m2k
        && last.thickness_m.is_infinite()
    {
        let what = "finger.core_w_m2k behind an endless layer";
        return Err(ConfigError::value(
            what,
            core_w_m2k,
            "none, or a last layer of finite thickness",
        ));
    }
    if !has_steady_state(finger) {
        return Err(ConfigError::cold_finger(finger.air_w_m2k));
    }
    Ok(())
}

/// The last of one or more layers, of which no other is endless.
fn check_order<'a>(
    layers: &'a [Layer],
    number: &'static str,
    above_another: &'static str,
) -> Result<&'a Layer, ConfigError> {
    let Some((last, above)) = layers.split_last() else {
        return Err(ConfigError::value(number, 0.0, "1 or more"));
    };
    if above.iter().any(|layer| layer.thickness_m.is_infinite()) {
        return Err(ConfigError::value(above_another, f64::INFINITY, "a finite number"));
    }
    Ok(last)
}

/// Whether the finger has a steady state: core or blood hold its temperature, or it exchanges and produces no heat.
fn has_steady_state(finger: &FingerParams) -> bool {
    let mut media = finger.layers.iter().map(|layer| layer.medium);
    finger.core_w_m2k.is_some_and(|core_w_m2k| core_w_m2k > 0.0)
        || media.clone().any(|medium| medium.perfusion_w_m3k > 0.0)
        || (finger.air_w_m2k == 0.0 && media.all(|medium| medium.metabolism_w_m3 == 0.0))
}

/// Checks the core temperature, deg C, that the initial state of the finger implies.
pub(super) fn check_core(core_c: f64) -> Result<(), ConfigError> {
    within(
        "temperature in deg C that the finger's core must have for its skin and the room",
        core_c,
        CORE_C.0,
        CORE_C.1,
    )
}

fn within(what: &'static str, value: f64, least: f64, most: f64) -> Result<(), ConfigError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(ConfigError::value(what, value, format!("{least} to {most}")))
}

fn positive(what: &'static str, value: f64) -> Result<(), ConfigError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(ConfigError::value(what, value, "a finite number above 0"))
}
