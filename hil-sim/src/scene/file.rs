//! The keys of a scene file.

use serde::Deserialize;
use toml::Spanned;

use super::FaultKind;

/// A number with its place in the file; whole numbers are accepted.
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
    pub object: Spanned<Object>,
    #[serde(default)]
    pub force: Vec<Force>,
    #[serde(default)]
    pub fault: Vec<Fault>,
    #[serde(default)]
    pub host: Vec<Host>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Mode {
    #[default]
    Contact,
    SemiInfinite,
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
    pub kind: FaultKind,
    pub t_s: Number,
    /// Of kinds that take one; none of the present kinds does.
    #[serde(default, rename = "value")]
    pub _value: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Host {
    pub t_s: Number,
    pub line: Spanned<String>,
}
