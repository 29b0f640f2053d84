//! What a plant is built from.

use contact_model::material::{Material, REFERENCE_DISPLAY, Surface};

use super::bridge::BridgeParams;
use super::finger::FingerParams;
use super::object::ObjectConfig;
use super::sensors::SensorParams;
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
        }
    }
}

/// Coldest and warmest start temperature, deg C.
const TEMPERATURE_C: (f64, f64) = (-40.0, 100.0);
/// Longest duration, s.
const LONGEST_S: f64 = 86_400.0;

/// A value that no plant can be built from.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} is {value}; allowed is {allowed}")]
pub struct ConfigError {
    /// The value's name and unit.
    pub what: &'static str,
    /// What it is.
    pub value: f64,
    /// What it may be.
    pub allowed: String,
}

impl ConfigError {
    pub(super) fn cold_finger(air_w_m2k: f64) -> Self {
        Self {
            what: "film of air in W/(m2 K) of a finger without blood or core",
            value: air_w_m2k,
            allowed: "0".into(),
        }
    }
}

impl PlantConfig {
    /// Checks what a scene can set.
    ///
    /// # Errors
    /// The first value that is not finite or outside of its range.
    pub fn check(&self) -> Result<(), ConfigError> {
        let (coldest, warmest) = TEMPERATURE_C;
        for (what, value) in [
            ("skin temperature in deg C", self.skin_c),
            ("room temperature in deg C", self.room_c),
            ("object temperature in deg C", self.object.start_c),
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
        let Material {
            surface,
            density_kg_m3,
            specific_heat_j_kgk,
        } = self.object.material;
        for (what, value) in [
            ("duration in s", self.duration_s),
            ("object conductivity in W/(m K)", surface.conductivity_w_mk),
            ("object roughness in um", surface.roughness_um),
            ("object asperity slope in rad", surface.slope_rad),
            ("object density in kg/m3", density_kg_m3),
            ("object specific heat in J/(kg K)", specific_heat_j_kgk),
        ] {
            positive(what, value)?;
        }
        within("duration in s", self.duration_s, 0.0, LONGEST_S)
    }
}

fn within(what: &'static str, value: f64, least: f64, most: f64) -> Result<(), ConfigError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(ConfigError {
        what,
        value,
        allowed: format!("{least} to {most}"),
    })
}

fn positive(what: &'static str, value: f64) -> Result<(), ConfigError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(ConfigError {
        what,
        value,
        allowed: "a finite number above 0".into(),
    })
}
