//! Layered objects and fingers against a numerical inversion of their Laplace transforms.

use contact_model::material::{SKIN, find};
use documented_figures::assert_figure;

use super::{config, run};
use crate::bridge::BridgeOutputs;
use crate::contact::ContactLaw;
use crate::finger::FingerParams;
use crate::object::ObjectConfig;
use crate::reference::ReferenceSolution;
use crate::slab::{BackBoundary, Grading};
use crate::{Finger, Plant, STEP_S};

/// A contact of `tests/data/layered.csv`.
struct Golden {
    finger: &'static str,
    layers: &'static str,
    object: ObjectConfig,
    force_n: f64,
    /// Time since landing, s, skin and surface of the object, deg C, and flux, W/m2.
    rows: Vec<[f64; 4]>,
}

fn golden() -> Vec<Golden> {
    let mut all: Vec<Golden> = Vec::new();
    let lines = include_str!("../../tests/data/layered.csv").lines();
    for line in lines.filter(|line| !line.starts_with('#')).skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields[i].parse().expect("a number");
        let same = |golden: &Golden| (golden.finger, golden.layers) == (fields[0], fields[1]);
        if !all.last().is_some_and(same) {
            all.push(Golden {
                finger: fields[0],
                layers: fields[1],
                object: object(fields[1], fields[2]),
                force_n: number(3),
                rows: Vec::new(),
            });
        }
        let row = [4, 5, 6, 7].map(number);
        all.last_mut().expect("just begun").rows.push(row);
    }
    all
}

/// Layers of materials and thicknesses, m, such as `copper 1e-3/foam inf`.
fn object(layers: &str, back: &str) -> ObjectConfig {
    let layers: Vec<_> = layers
        .split('/')
        .map(|layer| {
            let (name, thickness_m) = layer.split_once(' ').expect("name and thickness");
            let thickness_m = thickness_m.parse().expect("a thickness");
            (find(name).expect("a material"), thickness_m)
        })
        .collect();
    let (touched, _) = layers[0];
    ObjectConfig {
        layers: layers.iter().map(|(material, m)| ObjectConfig::layer(material, *m)).collect(),
        back: match back {
            "held" => BackBoundary::Film { film_w_m2k: f64::INFINITY, temperature_c: 24.0 },
            _ => BackBoundary::Insulated,
        },
        ..ObjectConfig::half_space(*touched, 24.0)
    }
}

#[test]
fn layered_objects_and_fingers_follow_their_transmission_lines() {
    let (mut worst, mut seen) = ([0.0f64; 3], 0);
    for golden in golden() {
        let mut config = config("copper");
        config.object = golden.object;
        if golden.finger == "layered" {
            config.params.finger = FingerParams::layered();
        }
        let mut plant = Plant::new(&config).expect("a good configuration");
        plant.set_force(golden.force_n);
        let mut own = [0.0f64; 3];
        let first_w_m2 = golden.rows[0][3];
        for [t_s, skin_c, object_c, flux_w_m2] in golden.rows {
            let left_s = t_s - plant.time_s();
            run(&mut plant, left_s, &BridgeOutputs::default());
            let off = [
                1e3 * (plant.skin_real_c() - skin_c),
                1e3 * (plant.object_c() - object_c),
                (plant.heat.flux_w_m2(Finger::OnObject) - flux_w_m2) / first_w_m2,
            ];
            for (worst, off) in own.iter_mut().zip(off) {
                *worst = worst.max(off.abs());
            }
            seen += 1;
        }
        println!("{} on {}: {own:?}", golden.finger, golden.layers);
        for (worst, own) in worst.iter_mut().zip(own) {
            *worst = worst.max(own);
        }
    }
    assert_eq!(seen, 70);
    let keys = ["layers.skin", "layers.object", "layers.flux"];
    for (key, worst) in keys.into_iter().zip(worst) {
        assert_figure(key, worst);
    }
}

/// Skin, deg C, at the times of a contact from 0.2 to 10 s, with a mesh and a step, s.
fn skin_c(golden: &Golden, grading: &Grading, step_s: f64) -> Vec<f64> {
    let surface = &golden.object.surface;
    let touch =
        ContactLaw::NOMINAL.at_force(golden.force_n, &SKIN.surface, surface).expect("pressed");
    let mut reference =
        ReferenceSolution::on_mesh(34.0, &golden.object, touch, 10.0, (grading, step_s));
    let at = |t_s: f64| {
        while reference.time_s() < t_s - 1e-9 {
            reference.sub_step();
        }
        assert!((reference.time_s() - t_s).abs() < 1e-9);
        reference.skin_c()
    };
    counted(golden).map(|row| row[0]).map(at).collect()
}

fn counted(golden: &Golden) -> impl Iterator<Item = &[f64; 4]> {
    let rows = golden.rows.iter();
    rows.filter(|row| (0.2..=10.0).contains(&row[0]))
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn layered_objects_converge_with_mesh_and_step() {
    let (mut mesh_order, mut step_order) = (f64::INFINITY, f64::INFINITY);
    for golden in golden().iter().filter(|one| one.finger == "skin") {
        let exact_c: Vec<f64> = counted(golden).map(|row| row[1]).collect();
        let [coarse, fine] = [2.0f64, 0.5].map(|factor| {
            let grading = Grading {
                first: Grading::STANDARD.first * factor,
                growth: Grading::STANDARD.growth.powf(factor),
                ..Grading::STANDARD
            };
            largest_difference(&skin_c(golden, &grading, 0.5 * STEP_S), &exact_c)
        });
        let mesh = 0.5 * (coarse / fine).log2();
        let courses = [5e-3, 2.5e-3, 1.25e-3].map(|s| skin_c(golden, &Grading::STANDARD, s));
        let halved = |k: usize| largest_difference(&courses[k], &courses[k + 1]);
        let step = (halved(0) / halved(1)).log2();
        println!("{}: orders {mesh:.3} of the mesh, {step:.3} of the steps", golden.layers);
        (mesh_order, step_order) = (mesh_order.min(mesh), step_order.min(step));
    }
    assert_figure("layers.mesh_order", mesh_order);
    assert_figure("layers.step_order", step_order);
}
