//! Contacts simulated by a plant.

use std::collections::BTreeMap;
use std::rc::Rc;

use contact_model::material::{Material, REFERENCE_DISPLAY, SKIN, Surface};
use contact_model::reference::interface_temperature;
use thermal_plant::bridge::BridgeOutputs;
use thermal_plant::object::ObjectConfig;
use thermal_plant::slab::BackBoundary;
use thermal_plant::{Params, Plant, PlantConfig, STEP_S};

use super::Variant;
use crate::contact_case::material;
use crate::experiments::WINDOW_M;

/// Duration of every contact, s.
const END_S: f64 = 10.0;
/// Steps of the plant from one sample of a course to the next: 20 Hz, as in section 4.4.1.
const STEPS: usize = 50;
/// Samples in a second.
const SAMPLES_HZ: f64 = 1.0 / (STEPS as f64 * STEP_S);

/// What the finger touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Touched {
    /// A material as deep as heat flows.
    Real,
    /// A surface like the display's, held at the interface temperature of the material by Eq. 3-1.
    Simulated,
    /// A window of section 5.2.1, insulated behind.
    Window,
}

/// Temperatures before a contact, °C.
#[derive(Clone, Copy, Debug)]
pub(super) struct Before {
    pub skin_c: f64,
    pub room_c: f64,
    pub object_c: f64,
}

impl Before {
    /// Section 3.2.
    pub const DISCRIMINATION: Self = Self { skin_c: 33.0, room_c: 24.0, object_c: 24.0 };
    /// Section 4.4.
    pub const DISPLAY: Self = Self { skin_c: 34.96, room_c: 23.0, object_c: 23.0 };
    /// Section 6.4.
    pub const VALIDATION: Self = Self { skin_c: 34.6, room_c: 23.7, object_c: 25.9 };
}

/// Fall of the skin's temperature over the time of a contact, K.
#[derive(Clone, Debug)]
pub(super) struct Course(Vec<f64>);

impl Course {
    /// Fall at a time, s.
    pub fn fall_k(&self, t_s: f64) -> f64 {
        self.0[(t_s * SAMPLES_HZ).round() as usize]
    }

    /// Fall within the whole contact, K.
    pub fn end_k(&self) -> f64 {
        self.fall_k(END_S)
    }

    /// Time constant, s, of the exponential function with the least squares of differences.
    pub fn time_constant_s(&self) -> f64 {
        let squares = |tau_s: f64| {
            let shape = |i: usize| -(-(i as f64) / SAMPLES_HZ / tau_s).exp_m1();
            let (mut product, mut square, mut own) = (0.0, 0.0, 0.0);
            for (i, fall_k) in self.0.iter().enumerate() {
                product += shape(i) * fall_k;
                square += shape(i) * shape(i);
                own += fall_k * fall_k;
            }
            // What the best amplitude leaves.
            own - product * product / square
        };
        let candidates = (1..=1000).map(|i| 0.01 * f64::from(i));
        candidates
            .map(|tau_s| (squares(tau_s), tau_s))
            .fold((f64::MAX, 0.0), |best, next| if next.0 < best.0 { next } else { best })
            .1
    }
}

/// Contacts with one variant of the plant, each simulated once.
pub(super) struct Courses {
    variant: Variant,
    known: BTreeMap<(Touched, String, u64, u64, bool), Rc<Course>>,
}

impl Courses {
    pub fn new(variant: Variant) -> Self {
        Self { variant, known: BTreeMap::new() }
    }

    /// The course of a contact with a material at a force, N.
    pub fn contact(
        &mut self,
        touched: Touched,
        of: &str,
        before: Before,
        force_n: f64,
    ) -> anyhow::Result<Rc<Course>> {
        self.with_blood(touched, of, before, force_n, true)
    }

    /// The same, if force stops the blood or not.
    pub fn with_blood(
        &mut self,
        touched: Touched,
        of: &str,
        before: Before,
        force_n: f64,
        force_stops_blood: bool,
    ) -> anyhow::Result<Rc<Course>> {
        let (skin, force) = (before.skin_c.to_bits(), force_n.to_bits());
        let key = (touched, of.to_owned(), skin, force, force_stops_blood);
        if let Some(course) = self.known.get(&key) {
            return Ok(course.clone());
        }
        let mut params = Params::nominal();
        params.finger = self.variant.finger_params();
        params.contact = self.variant.law();
        if !force_stops_blood {
            params.finger.vessels = None;
        }
        let config = PlantConfig {
            skin_c: before.skin_c,
            room_c: before.room_c,
            object: object(touched, of, before),
            start_s: 0.0,
            appears_s: 0.0,
            duration_s: END_S,
            seed: 1,
            params,
        };
        let course = Rc::new(simulate(&config, force_n)?);
        self.known.insert(key, course.clone());
        Ok(course)
    }
}

fn simulate(config: &PlantConfig, force_n: f64) -> anyhow::Result<Course> {
    let mut plant = Plant::new(config)?;
    plant.set_force(force_n);
    let mut falls_k = vec![0.0];
    for _ in 0..(END_S * SAMPLES_HZ).round() as usize {
        for _ in 0..STEPS {
            plant.step(&BridgeOutputs::default());
        }
        falls_k.push(config.skin_c - plant.skin_real_c());
    }
    Ok(Course(falls_k))
}

fn object(touched: Touched, of: &str, before: Before) -> ObjectConfig {
    let material = touched_material(of);
    let whole = ObjectConfig::half_space(material, before.object_c);
    match touched {
        Touched::Real => whole,
        Touched::Window => {
            ObjectConfig { layers: vec![ObjectConfig::layer(&material, WINDOW_M)], ..whole }
        }
        Touched::Simulated => {
            let held_c = interface_temperature(&SKIN, before.skin_c, &material, before.object_c);
            let thin = ObjectConfig::layer(&touched_material("copper"), ObjectConfig::THINNEST_M);
            ObjectConfig {
                surface: REFERENCE_DISPLAY,
                layers: vec![thin],
                start_c: held_c,
                back: BackBoundary::Film { film_w_m2k: f64::INFINITY, temperature_c: held_c },
            }
        }
    }
}

/// A material of the thesis, or one of its literature with handbook properties and a finish that is assumed.
fn touched_material(name: &str) -> Material {
    let other =
        |[k, density_kg_m3, specific_heat_j_kgk, roughness_um, slope_rad]: [f64; 5]| Material {
            surface: Surface { conductivity_w_mk: k, roughness_um, slope_rad },
            density_kg_m3,
            specific_heat_j_kgk,
        };
    match name {
        "glass" => other([1.0, 2500.0, 840.0, 0.05, 0.01]),
        "aluminium" => other([237.0, 2700.0, 897.0, 0.4, 0.05]),
        "wood" => other([0.17, 700.0, 2000.0, 5.0, 0.12]),
        name => material(name),
    }
}
