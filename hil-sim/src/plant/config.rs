//! What a plant is built from.

use contact_model::material::Material;

use super::bridge::BridgeParams;
use super::sensors::SensorParams;
use super::tile::TileParams;

/// One finger, its display and the real object that the display stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantConfig {
    /// Skin before contact, deg C.
    pub skin_c: f64,
    /// Room, and tile and sink at the start, deg C.
    pub room_c: f64,
    /// The real object.
    pub object: Material,
    /// The real object at the start, deg C.
    pub object_start_c: f64,
    /// Time of the first step, s; negative to let the device settle before zero.
    pub start_s: f64,
    /// From this time on the real object is there to be touched, s.
    pub appears_s: f64,
    /// How long temperatures must stay right, s: fixes how deep finger and object are meshed.
    pub duration_s: f64,
    /// Of every random draw.
    pub seed: u64,
    /// Tile and sink.
    pub tile: TileParams,
    /// Sensors and converter.
    pub sensors: SensorParams,
    /// Power stage.
    pub bridge: BridgeParams,
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
            ("object temperature in deg C", self.object_start_c),
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
        } = self.object;
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
