//! What differs between fingers and between sensors, as a vector, and the contact that a vector describes.

use std::array;

use contact_model::material::{SKIN, Surface};
use contact_model::pressure::pressure_pa;
use contact_model::reference::contact_resistance;
use relaxation_fit::{Back, Layer, impedance};
use thermal_plant::STEP_S;
use thermal_plant::lone_finger::{ContactCourse, LoneFinger};
use thermal_plant::object::ObjectConfig;
use thermal_plant::sensors::FluxParams;
use thermal_sim::commissioning::display_surface;
use thermal_sim::scene::Scene;

use super::super::PopulationCase;

/// Number of parameters.
pub const PARAMETERS: usize = 20;
/// Layers of a finger, each with logarithms of thickness, conductivity and heat capacity. The blood of the last two follows: logarithms
/// of the perfusion, and the flow in contact as a fraction.
const LAYERS: usize = 3;
const PERFUSION: usize = 3 * LAYERS;
const FLOW: usize = PERFUSION + LAYERS - 1;
/// Logarithm of the film of air before contact.
const AIR: usize = FLOW + 1;
/// Logarithms of the contact resistance with the display over the one that the device assumes, and of the ratio of that with the object
/// to that with the display, likewise.
pub const CONTACT: usize = AIR + 1;
const RATIO: usize = CONTACT + 1;
/// Skin before contact less what the device takes it for, K.
const SKIN_K: usize = RATIO + 1;
/// Of the sensor: error of the gain, zero in W/m2, logarithms of lag and resistance.
const GAIN: usize = SKIN_K + 1;
const ZERO: usize = GAIN + 1;
const LAG: usize = ZERO + 1;
const LAYER: usize = LAG + 1;

/// Standard deviation of [`SKIN_K`]: what commissioning leaves of the skin thermistor's error.
const SKIN_DEVIATION_K: f64 = 0.02;

/// One value for each parameter.
pub type Vector = [f64; PARAMETERS];

/// The contact of a finger in front of a sensor, with a display and with the object.
#[derive(Clone, Debug)]
pub struct Touch {
    finger: LoneFinger,
    object: ObjectConfig,
    display_m2k_w: f64,
    object_m2k_w: f64,
    sensor: FluxParams,
}

/// Contact resistances with display and object that the device assumes for the mean finger, m2 K/W.
fn assumed_m2k_w(scene: &Scene) -> [f64; 2] {
    let display = display_surface(scene);
    let pressure_pa = pressure_pa(PopulationCase::FORCE_N);
    [display.surface(), &scene.object.material.surface]
        .map(|other| contact_resistance::<f64>(&SKIN.surface, other, pressure_pa))
}

impl Touch {
    /// The contact of a scene; `None` if it has no sensor, or no contact.
    pub fn of(scene: &Scene) -> Option<Self> {
        let params = &scene.params;
        let finger = &params.finger;
        let resistance = |other: &Surface| {
            let contact =
                (params.contact).at_force(PopulationCase::FORCE_N, &finger.surface, other);
            Some(finger.resistance_factor * contact?.resistance_m2k_w)
        };
        let object = scene.plant_config().object;
        Some(Self {
            finger: LoneFinger {
                params: finger.clone(),
                flow: finger.vessels.map_or(1.0, |vessels| vessels.flow(PopulationCase::FORCE_N)),
                skin_c: scene.skin_c,
                room_c: scene.room_c,
            },
            display_m2k_w: resistance(&params.display)?,
            object_m2k_w: resistance(&object.surface)?,
            object,
            sensor: params.flux?,
        })
    }

    /// Its parameters.
    pub fn parameters(&self, scene: &Scene) -> Vector {
        let [display_m2k_w, object_m2k_w] = assumed_m2k_w(scene);
        let contact = self.display_m2k_w / display_m2k_w;
        let mut vector = [0.0; PARAMETERS];
        for (i, layer) in self.finger.params.layers.iter().take(LAYERS).enumerate() {
            let medium = &layer.medium;
            let values = [layer.thickness_m, medium.conductivity_w_mk, medium.capacity_j_m3k];
            vector[3 * i..3 * i + 3].copy_from_slice(&values.map(f64::ln));
            if i > 0 {
                vector[PERFUSION + i - 1] = medium.perfusion_w_m3k.ln();
            }
        }
        vector[FLOW] = self.finger.flow;
        vector[AIR] = self.finger.params.air_w_m2k.ln();
        vector[CONTACT] = contact.ln();
        vector[RATIO] = (self.object_m2k_w / object_m2k_w / contact).ln();
        vector[GAIN] = self.sensor.gain_error;
        vector[ZERO] = self.sensor.zero_w_m2;
        vector[LAG] = self.sensor.lag_s.ln();
        vector[LAYER] = self.sensor.resistance_m2k_w.ln();
        vector
    }

    /// The same with a parameter changed.
    pub fn changed(&self, parameter: usize, by: f64) -> Self {
        let mut changed = self.clone();
        let Self { finger, display_m2k_w, object_m2k_w, sensor, .. } = &mut changed;
        match parameter {
            FLOW => finger.flow += by,
            AIR => finger.params.air_w_m2k *= by.exp(),
            CONTACT => {
                *display_m2k_w *= by.exp();
                *object_m2k_w *= by.exp();
            }
            RATIO => *object_m2k_w *= by.exp(),
            SKIN_K => finger.skin_c += by,
            GAIN => sensor.gain_error += by,
            ZERO => sensor.zero_w_m2 += by,
            LAG => sensor.lag_s *= by.exp(),
            LAYER => sensor.resistance_m2k_w *= by.exp(),
            tissue => {
                let layer = if tissue < PERFUSION { tissue / 3 } else { tissue - PERFUSION + 1 };
                if let Some(layer) = finger.params.layers.get_mut(layer) {
                    let medium = &mut layer.medium;
                    *match tissue {
                        PERFUSION.. => &mut medium.perfusion_w_m3k,
                        own if own % 3 == 0 => &mut layer.thickness_m,
                        own if own % 3 == 1 => &mut medium.conductivity_w_mk,
                        _ => &mut medium.capacity_j_m3k,
                    } *= by.exp();
                }
            }
        }
        changed
    }

    /// Readings of the sensor without noise, W/m2, on a display whose surface, deg C, has this course: one a step.
    pub fn readings_w_m2(&self, display_c: &[f64]) -> Vec<f64> {
        let FluxParams { gain_error, zero_w_m2, lag_s, .. } = self.sensor;
        let share = 1.0 - (-STEP_S / lag_s).exp();
        let mut lagged_w_m2 = 0.0;
        let flux_w_m2 = self.on_display(display_c).flux_w_m2;
        let steps = flux_w_m2.windows(2);
        let reading = steps.map(|ends| {
            lagged_w_m2 += share * (0.5 * (ends[0] + ends[1]) - lagged_w_m2);
            (1.0 + gain_error) * lagged_w_m2 + zero_w_m2
        });
        reading.collect()
    }

    /// The contact with a display whose surface, deg C, has this course.
    pub fn on_display(&self, display_c: &[f64]) -> ContactCourse {
        let last = display_c.len() - 1;
        let display_c = |t_s: f64| {
            let place = t_s / STEP_S;
            let before = (place as usize).min(last);
            let part = place - before as f64;
            display_c[before] + part * (display_c[(before + 1).min(last)] - display_c[before])
        };
        let resistance = self.display_m2k_w + self.sensor.resistance_m2k_w;
        (self.finger).on_surface(resistance, last as u32, &display_c)
    }

    /// Surface of a display, deg C, on which the skin does what it does on the object.
    pub fn exact_display_c(&self, steps: usize) -> Vec<f64> {
        let touched = (self.finger).on_object(self.object_m2k_w, steps as u32, &self.object);
        let resistance = self.display_m2k_w + self.sensor.resistance_m2k_w;
        let ends = touched.skin_c.iter().zip(&touched.flux_w_m2);
        ends.map(|(skin_c, flux_w_m2)| skin_c - resistance * flux_w_m2).collect()
    }

    /// Standard deviation of a reading, W/m2.
    pub const fn noise_w_m2(&self) -> f64 {
        self.sensor.noise_w_m2
    }

    /// Contact resistance with the display, m2 K/W.
    pub const fn display_m2k_w(&self) -> f64 {
        self.display_m2k_w
    }

    /// Impedance of the tissue in contact, m2 K/W, at a Laplace variable, 1/s.
    pub fn impedance_m2k_w(&self, s_1_s: f64) -> f64 {
        let layers = self.finger.params.layers.iter().map(|layer| Layer {
            thickness_m: layer.thickness_m,
            conductivity_w_mk: layer.medium.conductivity_w_mk,
            capacity_j_m3k: layer.medium.capacity_j_m3k,
            perfusion_w_m3k: self.finger.flow * layer.medium.perfusion_w_m3k,
        });
        impedance(&layers.collect::<Vec<_>>(), Back::Held, s_1_s)
    }
}

/// Contact resistance with the display, m2 K/W, that the device of a scene assumes for the mean finger.
pub fn assumed_display_m2k_w(scene: &Scene) -> f64 {
    let [display, _] = assumed_m2k_w(scene);
    display
}

/// Covariance of drawn parameters.
pub fn covariance(drawn: &[Vector]) -> [Vector; PARAMETERS] {
    let count = drawn.len() as f64;
    let mean: Vector = array::from_fn(|i| drawn.iter().map(|one| one[i]).sum::<f64>() / count);
    let element = |i: usize, j: usize| {
        let products = drawn.iter().map(|one| (one[i] - mean[i]) * (one[j] - mean[j]));
        products.sum::<f64>() / (count - 1.0)
    };
    let mut all: [Vector; PARAMETERS] = array::from_fn(|i| array::from_fn(|j| element(i, j)));
    all[SKIN_K][SKIN_K] = SKIN_DEVIATION_K * SKIN_DEVIATION_K;
    all
}
