//! What a plant is built from.

use contact_model::material::{Material, REFERENCE_DISPLAY, Surface};

use super::bridge::BridgeParams;
use super::comparator::ComparatorParams;
use super::finger::{FingerParams, Vessels};
use super::object::ObjectConfig;
use super::parameters::{self, ParameterError};
use super::sensors::SensorParams;
use super::slab::Back;
use super::tile::TileParams;

/// One finger, its display and the real object that the display stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantConfig {
    /// Skin before contact, deg C.
    pub skin_c: f64,
    /// Room, and tile and sink at the start, deg C.
    pub room_c: f64,
    /// The real object.
    pub object: ObjectConfig,
    /// Time of the first step, s; negative to let the device settle before zero.
    pub start_s: f64,
    /// From this time on the real object is there to be touched, s.
    pub appears_s: f64,
    /// How long temperatures must stay right, s: fixes how deep half-spaces are cut.
    pub duration_s: f64,
    /// Of every random draw.
    pub seed: u64,
    /// What the parts are like.
    pub params: Params,
}

/// Parameters of all parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// The finger.
    pub finger: FingerParams,
    /// The display's surface.
    pub display: Surface,
    /// Tile and sink.
    pub tile: TileParams,
    /// Sensors and converter.
    pub sensors: SensorParams,
    /// Power stage.
    pub bridge: BridgeParams,
    /// Comparator that cuts its supply.
    pub comparator: ComparatorParams,
    /// What the host commissions the device with.
    pub host: HostParams,
}

/// The reference thermometer at the host, with a resolution of 1 mK.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostParams {
    /// What it shows too much, K.
    pub reference_offset_k: f64,
    /// Standard deviation of one reading, K.
    pub reference_noise_k: f64,
}

impl HostParams {
    /// A calibrated resistance thermometer's.
    pub const NOMINAL: Self = Self {
        reference_offset_k: 0.0,
        reference_noise_k: 0.3e-3,
    };
}

impl Params {
    /// The reference design under the thesis's finger.
    #[must_use]
    pub fn nominal() -> Self {
        Self {
            finger: FingerParams::homogeneous(),
            display: REFERENCE_DISPLAY,
            tile: TileParams::CLASS,
            sensors: SensorParams::NOMINAL,
            bridge: BridgeParams::NOMINAL,
            comparator: ComparatorParams::NOMINAL,
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

/// What no plant can be built from.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// A value out of its range.
    #[error("{what} is {value}; allowed is {allowed}")]
    Value {
        /// The value's name and unit.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        allowed: String,
    },
    /// A parameter of the box out of its range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A finger that would have to be kept warm, and has nothing that does.
    #[error(
        "a finger without blood or core has air_w_m2k {air_w_m2k} or heat of metabolism; allowed is 0 of both, or \
         a core, or perfusion"
    )]
    ColdFinger {
        /// Film of air on its surface, W/(m2 K).
        air_w_m2k: f64,
    },
}

impl ConfigError {
    pub(super) fn cold_finger(air_w_m2k: f64) -> Self {
        Self::ColdFinger { air_w_m2k }
    }

    fn value(what: &'static str, value: f64, allowed: impl Into<String>) -> Self {
        Self::Value {
            what,
            value,
            allowed: allowed.into(),
        }
    }
}

impl PlantConfig {
    /// Checks everything: each parameter by itself, and what must suit each other.
    ///
    /// # Errors
    /// The first value that is not finite or outside of its range.
    pub fn check(&self) -> Result<(), ConfigError> {
        let (coldest, warmest) = TEMPERATURE_C;
        for (what, value) in [
            ("skin temperature in deg C", self.skin_c),
            ("room temperature in deg C", self.room_c),
        ] {
            within(what, value, coldest, warmest)?;
        }
        within("start time in s", self.start_s, -LONGEST_S, 0.0)?;
        within(
            "time at which the object appears in s",
            self.appears_s,
            -LONGEST_S,
            LONGEST_S,
        )?;
        positive("duration in s", self.duration_s)?;
        within("duration in s", self.duration_s, 0.0, LONGEST_S)?;
        object(&self.object)?;
        parameters::check(&self.params)?;
        together(&self.params)
    }
}

fn object(object: &ObjectConfig) -> Result<(), ConfigError> {
    let (coldest, warmest) = TEMPERATURE_C;
    let Material {
        surface,
        density_kg_m3,
        specific_heat_j_kgk,
    } = object.material;
    for (what, value) in [
        ("object conductivity in W/(m K)", surface.conductivity_w_mk),
        ("object roughness in um", surface.roughness_um),
        ("object asperity slope in rad", surface.slope_rad),
        ("object density in kg/m3", density_kg_m3),
        ("object specific heat in J/(kg K)", specific_heat_j_kgk),
    ] {
        positive(what, value)?;
    }
    within(
        "object temperature in deg C",
        object.start_c,
        coldest,
        warmest,
    )?;
    within(
        "object thickness in m",
        object.thickness_m,
        ObjectConfig::THINNEST_M,
        f64::INFINITY,
    )?;
    if let Back::Film {
        film_w_m2k,
        temperature_c,
    } = object.back
    {
        within(
            "film behind the object in W/(m2 K)",
            film_w_m2k,
            0.0,
            f64::INFINITY,
        )?;
        within(
            "temperature behind the object in deg C",
            temperature_c,
            coldest,
            warmest,
        )?;
    }
    Ok(())
}

/// Parameters that are possible by themselves must suit each other.
fn together(params: &Params) -> Result<(), ConfigError> {
    let Params {
        finger,
        tile,
        bridge,
        ..
    } = params;
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
        return Err(ConfigError::value(
            "bridge.dead_time_s",
            bridge.dead_time_s,
            allowed,
        ));
    }
    let Some((last, above)) = finger.layers.split_last() else {
        return Err(ConfigError::value(
            "number of the finger's layers",
            0.0,
            "1 or more",
        ));
    };
    if above.iter().any(|layer| layer.thickness_m.is_infinite()) {
        let what = "thickness of a finger's layer above another in m";
        return Err(ConfigError::value(what, f64::INFINITY, "a finite number"));
    }
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
    if !rests(finger) {
        return Err(ConfigError::cold_finger(finger.air_w_m2k));
    }
    Ok(())
}

/// Whether the finger can be in equilibrium with the room: something keeps its temperature, or nothing changes it.
fn rests(finger: &FingerParams) -> bool {
    let mut media = finger.layers.iter().map(|layer| layer.medium);
    finger.core_w_m2k.is_some_and(|core_w_m2k| core_w_m2k > 0.0)
        || media.clone().any(|medium| medium.perfusion_w_m3k > 0.0)
        || (finger.air_w_m2k == 0.0 && media.all(|medium| medium.metabolism_w_m3 == 0.0))
}

/// A finger can be kept warm by a core of this temperature, deg C.
pub(super) fn core(core_c: f64) -> Result<(), ConfigError> {
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
    Err(ConfigError::value(
        what,
        value,
        format!("{least} to {most}"),
    ))
}

fn positive(what: &'static str, value: f64) -> Result<(), ConfigError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(ConfigError::value(what, value, "a finite number above 0"))
}
