//! Contacts of layered fingers with a display, simulated with finite volumes in `f64`, as the learner is to see them.
//!
//! The display shows an object as the device does that knows the mean finger only: it follows the set-point of the mean finger
//! on the object, after 6 ms of dead time and a lag of 6 ms.

use std::vec;
use std::vec::Vec;

use contact_model::fixed_point::Celsius;
use contact_model::material::{Material, REFERENCE_DISPLAY, SKIN, Surface, find};
use contact_model::pressure::pressure_pa;
use contact_model::reference::contact_resistance;
use relaxation_fit::Layer;
use relaxation_fit::fingers::MEAN_LAYERS;

use super::random::Random;
use crate::{ContactInput, Flux, LearnerInput, PlaceBeforeContact, Resistance};

pub const SKIN_C: f64 = 34.0;
pub const ROOM_C: f64 = 24.0;
const TICK_S: f64 = 1e-3;
/// Steps of the backward Euler method in each of the first two ticks; later ticks are one step of the second-order backward
/// differentiation formula.
const FIRST_STEPS: usize = 25;

/// A body in one dimension, from its surface down.
#[derive(Clone)]
struct Slab {
    capacity_j_m2k: Vec<f64>,
    /// To the next cell; of the last one, to the back.
    conductance_w_m2k: Vec<f64>,
    blood_w_m2k: Vec<f64>,
    /// From the surface to the first node, m² K/W.
    surface_m2k_w: f64,
    back_c: f64,
    now_c: Vec<f64>,
    before_c: Vec<f64>,
    /// Of the present step: factors of the elimination.
    upper: Vec<f64>,
    right: Vec<f64>,
}

impl Slab {
    /// Cells of layers, which grow from 5 µm; an infinite last layer ends where heat does not come in 20 s.
    fn new(layers: &[Layer], is_held: bool) -> Self {
        let (mut capacity, mut resistance, mut blood) = (vec![], vec![], vec![]);
        let (mut surface, mut from_node) = (0.0, 0.0);
        for layer in layers {
            let diffusivity = layer.conductivity_w_mk / layer.capacity_j_m3k;
            let thickness_m = layer.thickness_m.min(5.0 * (diffusivity * 20.0).sqrt());
            let growth: f64 = 1.18;
            let first_m = 0.01 * diffusivity.sqrt();
            let cells = ((thickness_m / first_m * (growth - 1.0)).ln_1p() / growth.ln()).ceil();
            let first_m = thickness_m * (growth - 1.0) / (growth.powf(cells) - 1.0);
            for cell in 0..cells as i32 {
                let width_m = first_m * growth.powi(cell);
                // Nodes and faces are two geometric series.
                let above_m = width_m / (1.0 + growth.sqrt());
                let to_node = above_m / layer.conductivity_w_mk;
                if capacity.is_empty() {
                    surface = to_node;
                } else {
                    resistance.push(from_node + to_node);
                }
                from_node = (width_m - above_m) / layer.conductivity_w_mk;
                capacity.push(width_m * layer.capacity_j_m3k);
                blood.push(width_m * layer.perfusion_w_m3k);
            }
        }
        let mut conductance: Vec<_> = resistance.iter().map(|r| 1.0 / r).collect();
        conductance.push(if is_held { 1.0 / from_node } else { 0.0 });
        let cells = capacity.len();
        Self {
            capacity_j_m2k: capacity,
            conductance_w_m2k: conductance,
            blood_w_m2k: blood,
            surface_m2k_w: surface,
            back_c: 0.0,
            now_c: vec![0.0; cells],
            before_c: vec![0.0; cells],
            upper: vec![0.0; cells],
            right: vec![0.0; cells],
        }
    }

    /// Eliminates all cells but the first. The first node then has the temperature `right[0] + upper[0] * flux in`.
    /// `storage` is the capacity over the step times that of the new temperature, of the present and of the one before.
    fn eliminate(&mut self, storage: [f64; 3]) {
        let cells = self.now_c.len();
        let (mut below_g, mut below_right) = (0.0, 0.0);
        for i in (0..cells).rev() {
            let c = self.capacity_j_m2k[i];
            let to_next = self.conductance_w_m2k[i];
            let mut pivot = c * storage[0] + self.blood_w_m2k[i] + below_g;
            let mut right = c * (storage[1] * self.now_c[i] + storage[2] * self.before_c[i])
                + self.blood_w_m2k[i] * self.back_c
                + below_right;
            if i + 1 == cells {
                pivot += to_next;
                right += to_next * self.back_c;
            }
            // What the cell above sees, if there is one.
            let above = if i > 0 { self.conductance_w_m2k[i - 1] } else { 0.0 };
            self.upper[i] = 1.0 / (pivot + above);
            self.right[i] = right / (pivot + above);
            below_g = above * pivot / (pivot + above);
            below_right = above * self.right[i];
        }
    }

    /// Ends a step with this flux into the surface.
    fn finish(&mut self, flux_in_w_m2: f64, is_tick: bool) {
        if is_tick {
            self.before_c.clone_from(&self.now_c);
        }
        self.now_c[0] = self.right[0] + self.upper[0] * flux_in_w_m2;
        for i in 1..self.now_c.len() {
            let above = self.conductance_w_m2k[i - 1];
            self.now_c[i] = self.right[i] + self.upper[i] * above * self.now_c[i - 1];
        }
    }

    /// Open surface temperature, and its fall per flux out of it, at the end of the step.
    fn surface(&self) -> (f64, f64) {
        (self.right[0], self.upper[0] + self.surface_m2k_w)
    }
}

/// The steps of a tick: number, and storage terms.
fn steps(tick: usize) -> (usize, [f64; 3]) {
    if tick < 2 {
        let rate = FIRST_STEPS as f64 / TICK_S;
        (FIRST_STEPS, [rate, rate, 0.0])
    } else {
        (1, [1.5 / TICK_S, 2.0 / TICK_S, -0.5 / TICK_S])
    }
}

/// Flux between two bodies for each tick, or into a display of given temperature.
enum Other<'a> {
    Object(&'a mut Slab),
    Display(f64),
}

/// Advances a finger by a tick; the flux out of it at its end, W/m², and its surface, °C.
fn tick(finger: &mut Slab, mut other: Other<'_>, resistance_m2k_w: f64, tick: usize) -> (f64, f64) {
    let (count, storage) = steps(tick);
    let mut result = (0.0, 0.0);
    for step in 0..count {
        finger.eliminate(storage);
        let (skin_c, fall) = finger.surface();
        let (other_c, rise) = match &mut other {
            Other::Object(object) => {
                object.eliminate(storage);
                object.surface()
            }
            Other::Display(temperature_c) => (*temperature_c, 0.0),
        };
        let flux = (skin_c - other_c) / (fall + rise + resistance_m2k_w);
        let is_first = step == 0;
        finger.finish(-flux, is_first);
        if let Other::Object(object) = &mut other {
            object.finish(flux, is_first);
        }
        result = (flux, skin_c - fall * flux);
    }
    result
}

/// A finger.
#[derive(Clone)]
pub struct Finger {
    pub layers: Vec<Layer>,
    /// Blood flow in contact, over that before.
    pub flow: f64,
    pub film_w_m2k: f64,
    pub place: PlaceBeforeContact,
    pub resistance_factor: f64,
    /// Skin less what its thermistor says, K.
    pub skin_offset_k: f64,
}

impl Finger {
    /// The mean finger, which the device assumes.
    pub fn mean(place: PlaceBeforeContact) -> Self {
        Self {
            layers: MEAN_LAYERS.into(),
            flow: 0.0,
            film_w_m2k: match place {
                PlaceBeforeContact::Air => 10.0,
                PlaceBeforeContact::Pad => 1.75,
            },
            place,
            resistance_factor: 1.0,
            skin_offset_k: 0.0,
        }
    }

    /// A finger by the ranges of the simulator's draw.
    pub fn drawn(random: &mut Random) -> Self {
        let perfusions = [0.0, 20_000.0, 4000.0];
        let mut layers: Vec<_> = MEAN_LAYERS
            .iter()
            .zip(perfusions)
            .map(|(layer, perfusion_w_m3k)| Layer {
                thickness_m: layer.thickness_m * random.between(0.77, 1.23),
                conductivity_w_mk: layer.conductivity_w_mk * random.between(0.9, 1.1),
                capacity_j_m3k: layer.capacity_j_m3k * random.between(0.9, 1.1),
                perfusion_w_m3k: perfusion_w_m3k * 4f64.powf(random.between(-1.0, 1.0)),
            })
            .collect();
        let shape = random.between(0.0, 1.0);
        if shape > 0.75 {
            layers[0].thickness_m = random.between(0.26e-3, 0.5e-3);
        } else if shape > 0.5 {
            layers[0].thickness_m = random.between(0.8e-3, 1.4e-3);
            layers[0].conductivity_w_mk = random.between(0.14, 0.19);
        }
        let effusivity_factor = random.between(0.8, 1.2);
        for layer in &mut layers {
            layer.conductivity_w_mk *= effusivity_factor;
            layer.capacity_j_m3k *= effusivity_factor;
        }
        let place = if random.between(0.0, 1.0) < 0.5 {
            PlaceBeforeContact::Air
        } else {
            PlaceBeforeContact::Pad
        };
        Self {
            layers,
            flow: if random.between(0.0, 1.0) < 0.5 { 0.0 } else { 1.0 },
            film_w_m2k: match place {
                PlaceBeforeContact::Air => random.between(5.0, 15.0),
                PlaceBeforeContact::Pad => random.between(0.5, 3.0),
            },
            place,
            resistance_factor: 2f64.powf(random.between(-1.0, 1.0)),
            skin_offset_k: 0.025 * random.normal(),
        }
    }

    /// The finger in equilibrium before contact, with its surface at its true temperature; then with the blood of a contact.
    fn slab(&self) -> Slab {
        let mut slab = Slab::new(&self.layers, true);
        slab.back_c = 1.0;
        slab.eliminate([0.0; 3]);
        let (open, fall) = slab.surface();
        let flux = open / (fall + 1.0 / self.film_w_m2k);
        slab.finish(-flux, true);
        let scale = (SKIN_C + self.skin_offset_k - ROOM_C) / (open - fall * flux);
        slab.back_c = ROOM_C + scale;
        for now_c in &mut slab.now_c {
            *now_c = ROOM_C + scale * *now_c;
        }
        for blood in &mut slab.blood_w_m2k {
            *blood *= self.flow;
        }
        slab
    }
}

/// An object that the display shows.
#[derive(Clone, Copy, Debug)]
pub struct Object {
    pub name: &'static str,
    thickness_m: f64,
}

pub const OBJECTS: [Object; 6] = [
    Object { name: "copper", thickness_m: f64::INFINITY },
    Object { name: "granite", thickness_m: f64::INFINITY },
    Object { name: "abs", thickness_m: f64::INFINITY },
    Object { name: "foam", thickness_m: f64::INFINITY },
    Object { name: "granite", thickness_m: 3e-3 },
    Object { name: "copper", thickness_m: 3e-3 },
];

fn resistance_m2k_w(other: &Surface, force_n: f64) -> f64 {
    contact_resistance::<f64>(&SKIN.surface, other, pressure_pa(force_n))
}

/// Nominal resistance of skin and display, m² K/W.
pub fn display_resistance_m2k_w(force_n: f64) -> f64 {
    resistance_m2k_w(&REFERENCE_DISPLAY, force_n)
}

/// Errors of the flux sensor and of the surface's estimate.
#[derive(Clone, Copy)]
pub struct Errors {
    pub gain: f64,
    pub zero_w_m2: f64,
    pub noise_w_m2: f64,
    pub lag_s: f64,
    pub resistance_m2k_w: f64,
    pub surface_k: f64,
    pub surface_noise_k: f64,
}

/// Nominal lag, s, and resistance, m² K/W, of the sensor.
pub const LAG_S: f64 = 5e-3;
pub const SENSOR_M2K_W: f64 = 3e-5;

impl Errors {
    pub const NONE: Self = Self {
        gain: 0.0,
        zero_w_m2: 0.0,
        noise_w_m2: 0.0,
        lag_s: LAG_S,
        resistance_m2k_w: SENSOR_M2K_W,
        surface_k: 0.0,
        surface_noise_k: 0.0,
    };

    /// Of the sensor that is designed: gain 1.5 %, zero 3.5 W/m², noise 7 W/m² a tick, lag and resistance 5 %; and a surface
    /// that is known to 20 mK.
    pub fn drawn(random: &mut Random) -> Self {
        Self {
            gain: 0.015 * random.normal(),
            zero_w_m2: 3.5 * random.normal(),
            noise_w_m2: 7.0,
            lag_s: LAG_S * (1.0 + 0.05 * random.normal()),
            resistance_m2k_w: SENSOR_M2K_W * (1.0 + 0.05 * random.normal()),
            surface_k: 0.02 * random.normal(),
            surface_noise_k: 0.8e-3,
        }
    }
}

/// A contact to simulate.
pub struct Scene<'a> {
    pub finger: &'a Finger,
    pub object: Object,
    pub force_n: f64,
    pub ticks: usize,
    pub errors: Errors,
    /// What the sensor reports for the true flux, W/m², in a tick.
    pub reported: &'a dyn Fn(f64, usize) -> f64,
}

/// The contact of a sound sensor.
pub fn sound(flux_w_m2: f64, _: usize) -> f64 {
    flux_w_m2
}

impl Scene<'_> {
    /// Flux out of the skin, W/m², and temperature of the display, °C, in each tick.
    pub fn simulate(&self) -> Vec<(f64, f64)> {
        let material: &Material = find(self.object.name).expect("a material");
        let layer = Layer {
            thickness_m: self.object.thickness_m,
            conductivity_w_mk: material.surface.conductivity_w_mk,
            capacity_j_m3k: material.volumetric_heat_j_m3k(),
            perfusion_w_m3k: 0.0,
        };
        let mut object = Slab::new(&[layer], false);
        object.now_c.fill(ROOM_C);
        let mut assumed = Finger::mean(self.finger.place).slab();
        let mut finger = self.finger.slab();
        let on_object = resistance_m2k_w(&material.surface, self.force_n);
        let on_display = display_resistance_m2k_w(self.force_n);
        let on_sensor = on_display * self.finger.resistance_factor + self.errors.resistance_m2k_w;
        let waiting_c = SKIN_C - on_display / on_object * (SKIN_C - ROOM_C);
        let mut setpoints = vec![waiting_c; 6];
        let mut display_c = waiting_c;
        (0..self.ticks)
            .map(|now| {
                let (flux, skin_c) = tick(&mut assumed, Other::Object(&mut object), on_object, now);
                setpoints.push(skin_c - (on_display + SENSOR_M2K_W) * flux);
                display_c += (setpoints[now] - display_c) * (1.0 - (-1.0f64 / 6.0).exp());
                let display = Other::Display(display_c);
                (tick(&mut finger, display, on_sensor, now).0, display_c)
            })
            .collect()
    }

    /// The learner's inputs: three windows without contact, a landing in the last one's `phase`, then the contact.
    pub fn inputs(&self, random: &mut Random, phase: usize) -> Vec<LearnerInput> {
        let Errors { gain, zero_w_m2, noise_w_m2, lag_s, surface_k, surface_noise_k, .. } =
            self.errors;
        let mut reported = 0.0;
        let air_w_m2 = Finger::mean(self.finger.place).film_w_m2k * (SKIN_C - ROOM_C);
        let lifted = 20 + phase;
        let ticks: Vec<_> = (self.simulate().iter().enumerate())
            .map(|(now, &(flux, display_c))| {
                reported +=
                    ((self.reported)(flux, now) - reported) * (1.0 - (-TICK_S / lag_s).exp());
                let noise = zero_w_m2 + noise_w_m2 * random.normal();
                let surface_c = display_c + surface_k + surface_noise_k * random.normal();
                (reported * (1.0 + gain) + noise, SKIN_C - surface_c)
            })
            .collect();
        let all: Vec<_> =
            (vec![None; lifted].into_iter()).chain(ticks.into_iter().map(Some)).collect();
        (all.chunks_exact(10).enumerate())
            .map(|(window, ticks)| {
                let touching: Vec<_> = ticks.iter().flatten().collect();
                let mean = |of: fn(&(f64, f64)) -> f64| {
                    touching.iter().map(|one| of(one)).sum::<f64>() / 10.0
                };
                let contact = (!touching.is_empty()).then(|| ContactInput {
                    touching_ticks: touching.len() as u8,
                    skin_above_display_k: Celsius::from_num(mean(|one| one.1)),
                    air_flux_w_m2: Flux::from_num(air_w_m2),
                    resistance_mm2k_w: Resistance::from_num(
                        1e6 * display_resistance_m2k_w(self.force_n),
                    ),
                    ticks_since_landing: (10 * (window + 1) - lifted) as u32,
                    is_steady: true,
                });
                LearnerInput {
                    sequence: window as u16,
                    restart: None,
                    flux_w_m2: Some(Flux::from_num(mean(|one| one.0))),
                    contact,
                }
            })
            .collect()
    }
}
