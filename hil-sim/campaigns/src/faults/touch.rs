//! The finger that touches, the object that is presented, and what the device is told of both, drawn by seed.

use contact_model::material::THESIS_MATERIALS;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_device::command::AssumedFinger;
use thermal_plant::Params;
use thermal_plant::parameters::{self, Parameter, all};
use thermal_plant::sensors::FluxParams;

use super::scene_text;
use crate::fidelity::layer_keys;
use thermal_device::Vocabulary as _;

/// Time at which a line about a slab is sent, s: before any fault.
const SLAB_LINE_S: f64 = 0.01;
/// Range of the thickness of slabs and layers, mm, drawn with a uniform logarithm.
const THICKNESS_MM: (f64, f64) = (0.1, 30.0);
/// Range of the film behind them, W/(m² K), drawn with a uniform logarithm.
const FILM_W_M2K: (f64, f64) = (1.0, 1e4);
/// Most layers below the touched one.
const LAYERS_BELOW_MAX: usize = 3;

/// The key of `[device]` by which a heat-flux sensor is fitted.
const FLUX_SENSOR: &str = "flux_sensor = true\n";

/// Skins at rest, °C, drawn uniformly.
pub(super) const SKINS_C: std::ops::RangeInclusive<f64> = 28.0..=40.0;
/// Warmest skin of a layered finger, °C: in a cold room a warmer one needs a core beyond 45 °C, which the plant refuses.
pub(super) const LAYERED_SKIN_MAX_C: f64 = 36.0;
/// Forces, N, drawn with a uniform logarithm.
pub(super) const FORCE_N: (f64, f64) = (0.1, 10.0);

/// Parts of a scene's text about finger and object. The default is the thesis's finger at 34 °C, pressed with 2 N, and an endless
/// object.
#[derive(Clone, Debug, PartialEq)]
pub struct Touch {
    /// Skin at rest, °C.
    pub(super) skin_c: f64,
    /// Force with which it presses, N.
    pub(super) force_n: f64,
    /// Keys of `[object]`.
    pub(super) object: String,
    /// Keys of `[device]`.
    pub(super) device: String,
    /// Whole tables: layers of the object, the finger, a line of the host.
    pub(super) tables: String,
    /// Keys of `[plant]`.
    pub(super) plant: String,
}

impl Default for Touch {
    fn default() -> Self {
        Self {
            skin_c: 34.0,
            force_n: 2.0,
            object: String::new(),
            device: String::new(),
            tables: String::new(),
            plant: String::new(),
        }
    }
}

impl Touch {
    /// Draws finger and object. Half of the draws leave tissue, contact and object as they are. The touched material is that of the
    /// scene.
    pub fn new(seed: u64, material: &str) -> Self {
        let mut draw = Xoshiro256PlusPlus::seed_from_u64(seed);
        let skin_c = draw.random_range(SKINS_C);
        let pressed = Self { skin_c, force_n: log_uniform(&mut draw, FORCE_N), ..Self::default() };
        if draw.random_bool(0.5) {
            return pressed;
        }
        // A scene file holds 63 bits.
        let seed = seed >> 1;
        let tissue = ["layered", "layered", "homogeneous"][draw.random_range(0..3)];
        let words = AssumedFinger::WORDS.words;
        let assumed = words[draw.random_range(0..words.len())];
        let skin_c = if tissue == "layered" { skin_c.min(LAYERED_SKIN_MAX_C) } else { skin_c };
        let mut touch = Self {
            skin_c,
            device: format!("finger = \"{assumed}\"\n"),
            tables: format!("[finger]\ntissue = \"{tissue}\"\ndraw = {seed}\n"),
            ..pressed
        };
        if draw.random_bool(0.5) {
            touch.plant = format!("contact.draw = {seed}\n");
        }
        match draw.random_range(0..4) {
            0 => {}
            1 => touch.slab(&mut draw, false),
            2 => touch.slab(&mut draw, true),
            _ => touch.layers(&mut draw, material),
        }
        touch
    }

    /// A drawn layered finger on a display with a heat-flux sensor that is nominal.
    pub fn learnt(seed: u64) -> Self {
        Self {
            device: FLUX_SENSOR.into(),
            tables: format!("[finger]\ntissue = \"layered\"\ndraw = {}\n", seed >> 1),
            ..Self::default()
        }
    }

    /// Whether the display has a heat-flux sensor.
    pub(super) fn has_flux_sensor(&self) -> bool {
        self.device.contains(FLUX_SENSOR)
    }

    /// Has a heat-flux sensor on the display, whose errors this seed draws.
    pub(super) fn fit_flux_sensor(&mut self, seed: u64) {
        self.device += FLUX_SENSOR;
        self.draw_flux_errors(seed);
    }

    /// Draws the errors of the heat-flux sensor.
    pub(super) fn draw_flux_errors(&mut self, seed: u64) {
        let mut params = Params { flux: Some(FluxParams::NOMINAL), ..Params::nominal() };
        parameters::draw(&mut params, seed);
        for Parameter { key, value, .. } in all(&params) {
            if key.starts_with("flux.") {
                self.plant += &format!("{key} = {value:?}\n");
            }
        }
    }

    /// A slab, of which the device is told by its relaxations or by a line.
    fn slab(&mut self, draw: &mut Xoshiro256PlusPlus, by_line: bool) {
        let thickness_mm = log_uniform(draw, THICKNESS_MM);
        let (keys, back) = back(draw);
        self.object = format!("thickness_m = {:?}\n{keys}", thickness_mm * 1e-3);
        if by_line {
            self.object += "told = \"half-space\"\n";
            let line = format!("object slab {thickness_mm:.6}mm {back}");
            self.tables += &scene_text::host_line(&line, SLAB_LINE_S);
        }
    }

    /// Layers below the touched material, the last one endless or with a back.
    fn layers(&mut self, draw: &mut Xoshiro256PlusPlus, material: &str) {
        let mut layers = vec![(material, log_uniform(draw, THICKNESS_MM))];
        for _ in 0..draw.random_range(1..=LAYERS_BELOW_MAX) {
            let below = THESIS_MATERIALS[draw.random_range(0..THESIS_MATERIALS.len())];
            layers.push((below, log_uniform(draw, THICKNESS_MM)));
        }
        if draw.random_bool(0.5) {
            self.object = back(draw).0;
        } else if let Some((_, thickness_mm)) = layers.last_mut() {
            *thickness_mm = f64::INFINITY;
        }
        self.tables.insert_str(0, &layer_keys(&layers));
    }
}

/// What is behind a slab: keys of the scene, and words of the protocol.
fn back(draw: &mut Xoshiro256PlusPlus) -> (String, String) {
    match draw.random_range(0..3) {
        0 => ("back = \"insulated\"\n".into(), "insulated".into()),
        1 => ("back = \"held\"\n".into(), "held".into()),
        _ => {
            let film_w_m2k = log_uniform(draw, FILM_W_M2K);
            (
                format!("back = \"film\"\nback_film_w_m2k = {film_w_m2k:?}\n"),
                format!("film {film_w_m2k:.3}"),
            )
        }
    }
}

pub(super) fn log_uniform(draw: &mut Xoshiro256PlusPlus, (low, high): (f64, f64)) -> f64 {
    let part: f64 = draw.random();
    low * (high / low).powf(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 400 draws miss one of eight shares of a sixteenth or more with a probability below 1e-10.
    #[test]
    fn half_of_the_draws_have_another_finger_and_most_of_these_another_object() {
        let draws: Vec<_> = (0..400).map(|seed| Touch::new(seed, "copper")).collect();
        let share = |part: fn(&Touch) -> bool| draws.iter().filter(|one| part(one)).count();
        assert!((150..250).contains(&share(|one| one.tables.is_empty())));
        let parts: [fn(&Touch) -> bool; 8] = [
            |one| one.tables.contains("object slab"),
            |one| one.object.contains("thickness_m") && !one.object.contains("told"),
            |one| one.tables.contains("[[object.layer]]"),
            |one| one.object.contains("film"),
            |one| one.object.contains("held"),
            |one| one.device.contains("mean"),
            |one| one.device.contains("thesis"),
            |one| one.plant.contains("contact.draw"),
        ];
        for part in parts {
            assert!(share(part) > 10, "{draws:?}");
        }
    }
}
