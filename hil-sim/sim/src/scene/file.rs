//! The keys of a scene file.

use serde::{Deserialize, Deserializer};
use toml::Spanned;

use super::Sensor;
pub(super) use super::parameter_node::{NodeNumber, ParameterNode};
use super::word::{OneOf, words};
use crate::processor::FlashTiming;

/// A number with its position in the file; whole numbers are accepted.
pub(super) type Number = Spanned<f64>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    pub duration_s: Number,
    pub settle_s: Option<Number>,
    pub skin_c: Number,
    pub room_c: Number,
    #[serde(default)]
    pub seed: u64,
    #[serde(default)]
    pub mode: Mode,
    pub law: Option<Spanned<String>>,
    #[serde(default)]
    pub device: Device,
    pub object: Spanned<Object>,
    pub finger: Option<Spanned<Finger>>,
    pub plant: Option<Spanned<ParameterNode>>,
    pub infrared: Option<Spanned<Infrared>>,
    #[serde(default)]
    pub force: Vec<Force>,
    #[serde(default)]
    pub fault: Vec<Spanned<Fault>>,
    #[serde(default)]
    pub trigger: Vec<Trigger>,
    #[serde(default)]
    pub host: Vec<Host>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Trigger {
    pub t_s: Number,
}

#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Device {
    pub commissioned: bool,
    pub finger: Option<AssumedFinger>,
    pub flux_sensor: bool,
    pub measured_surface: bool,
    pub enrolled: Spanned<bool>,
    pub brown_out_level: Option<Spanned<u32>>,
    pub lsi_hz: Option<Spanned<u32>>,
    pub external_clock: bool,
    pub external_clock_start_us: Option<Spanned<u32>>,
    pub slow_flash: bool,
    #[serde(deserialize_with = "flash_timing")]
    pub flash: FlashTiming,
    pub strict: bool,
}

words! {
    /// The finger that the simulated operator lets the device assume.
    pub(super) enum AssumedFinger {
        Thesis = "thesis",
        Mean = "mean",
        MeanOnPad = "mean-on-pad",
    }
}

impl Default for Device {
    fn default() -> Self {
        Self {
            commissioned: true,
            finger: None,
            flux_sensor: false,
            measured_surface: false,
            enrolled: Spanned::new(0..0, false),
            brown_out_level: None,
            lsi_hz: None,
            external_clock: true,
            external_clock_start_us: None,
            slow_flash: false,
            flash: FlashTiming::default(),
            strict: false,
        }
    }
}

fn flash_timing<'de, D: Deserializer<'de>>(deserializer: D) -> Result<FlashTiming, D::Error> {
    const NAMES: [&str; FlashTiming::ALL.len()] =
        [FlashTiming::ALL[0].name(), FlashTiming::ALL[1].name(), FlashTiming::ALL[2].name()];
    let index = deserializer.deserialize_str(OneOf(&NAMES))?;
    Ok(FlashTiming::ALL[index])
}

words! {
    #[derive(Default)]
    pub(super) enum Mode {
        #[default]
        Contact = "contact",
        SemiInfinite = "semi-infinite",
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Object {
    pub material: Option<Spanned<String>>,
    pub k_w_mk: Option<Number>,
    pub rho_kg_m3: Option<Number>,
    pub c_j_kgk: Option<Number>,
    pub rq_um: Option<Number>,
    pub slope_rad: Option<Number>,
    pub start_c: Option<Number>,
    pub appears_t_s: Option<Number>,
    pub thickness_m: Option<Number>,
    pub back: Option<Spanned<Back>>,
    pub back_c: Option<Number>,
    pub back_film_w_m2k: Option<Number>,
    pub told: Option<Told>,
    #[serde(default)]
    pub layer: Vec<Spanned<ObjectLayer>>,
}

words! {
    /// What the device is told of an object that is no half-space.
    pub(super) enum Told {
        HalfSpace = "half-space",
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectLayer {
    pub thickness_m: Option<Number>,
    pub k_w_mk: Number,
    pub rho_kg_m3: Number,
    pub c_j_kgk: Number,
}

words! {
    pub(super) enum Back {
        Insulated = "insulated",
        Held = "held",
        Film = "film",
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Finger {
    pub draw: Option<Spanned<NodeNumber>>,
    pub tissue: Option<Spanned<Tissue>>,
    pub core_w_m2k: Option<Number>,
    pub air_w_m2k: Option<Number>,
    pub vessels: Option<bool>,
    #[serde(default)]
    pub layer: Vec<Spanned<Layer>>,
}

words! {
    pub(super) enum Tissue {
        Homogeneous = "homogeneous",
        Layered = "layered",
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Layer {
    pub thickness_m: Option<Number>,
    pub k_w_mk: Number,
    pub rho_kg_m3: Number,
    pub c_j_kgk: Number,
    pub perfusion_1_s: Option<Number>,
    pub metabolism_w_m3: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Infrared {
    pub optic: Spanned<Glass>,
    pub emissivity: Option<Number>,
    pub netd_k: Option<Number>,
    pub pixels: Option<Spanned<u32>>,
    pub rate_hz: Option<Number>,
    pub window_c: Option<Number>,
    pub splitter_c: Option<Number>,
    pub camera_c: Option<Number>,
    pub camera_share: Option<Number>,
}

words! {
    pub(super) enum Glass {
        None = "none",
        Baf2 = "baf2",
        Zns = "zns",
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Force {
    pub t_s: Number,
    pub force_n: Number,
    pub ramp_s: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Fault {
    pub kind: Spanned<String>,
    pub t_s: Number,
    pub until_s: Option<Number>,
    pub value: Option<Number>,
    pub sensor: Option<Spanned<Sensor>>,
    pub with: Option<Spanned<Sensor>>,
    pub address: Option<Spanned<i64>>,
    pub register: Option<Spanned<String>>,
    pub bit: Option<Spanned<i64>>,
    pub controller: Option<Spanned<i64>>,
    pub stream: Option<Spanned<i64>>,
    pub line: Option<Spanned<i64>>,
    pub level: Option<Spanned<i64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Host {
    pub t_s: Number,
    pub line: Spanned<String>,
}
