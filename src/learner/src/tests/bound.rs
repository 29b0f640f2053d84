//! Deviations that the learner states, against the bound of Cramer and Rao, which no estimator can be below.

use std::println;
use std::vec::Vec;

use super::contacts::{first_component, learnt};
use super::random::Random;
use super::simulation::*;
use crate::PlaceBeforeContact;

const FORCE_N: f64 = 2.0;
/// Noise of the sensor, W/m² a tick.
const NOISE_W_M2: f64 = 7.0;
/// Relative change of the impedance per unit of the first component, at the times of the contact.
const COMPONENT: f64 = 0.145;
/// Prior deviations of contact resistance and impedance, relative, of the skin, K, and of the air, relative.
const PRIOR: [f64; 4] = [0.45, COMPONENT, 0.05, 0.33];

fn change(finger: &mut Finger, parameter: usize, by: f64) {
    match parameter {
        0 => finger.resistance_factor += by,
        1 => {
            for layer in &mut finger.layers {
                layer.conductivity_w_mk /= 1.0 + by;
                layer.capacity_j_m3k /= 1.0 + by;
            }
        }
        2 => finger.skin_offset_k += by,
        _ => finger.film_w_m2k *= 1.0 + by,
    }
}

fn scene(finger: &Finger, object: Object, ticks: usize, errors: Errors) -> Scene<'_> {
    Scene { finger, object, force_n: FORCE_N, ticks, errors, reported: &sound }
}

/// Least deviations of resistance and impedance, relative, by the sensor's noise alone.
fn bound(object: Object, ticks: usize) -> [f64; 2] {
    let flux = |parameter, by| -> Vec<f64> {
        let mut finger = Finger::mean(PlaceBeforeContact::Air);
        change(&mut finger, parameter, by);
        let simulated = scene(&finger, object, ticks, Errors::NONE).simulate();
        simulated[20..].iter().map(|(flux, _)| *flux).collect()
    };
    let slopes: Vec<Vec<f64>> = (PRIOR.iter().enumerate())
        .map(|(parameter, deviation)| {
            let step = 0.02 * deviation;
            let [up, down] = [step, -step].map(|by| flux(parameter, by));
            up.iter().zip(down).map(|(up, down)| (up - down) / (2.0 * step)).collect()
        })
        .collect();
    let mut information = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..4 {
            let sum: f64 = slopes[i].iter().zip(&slopes[j]).map(|(a, b)| a * b).sum();
            information[i][j] = sum / (NOISE_W_M2 * NOISE_W_M2);
        }
        information[i][i] += 1.0 / (PRIOR[i] * PRIOR[i]);
    }
    [0, 1].map(|parameter| inverse_diagonal(information, parameter).sqrt())
}

/// An element of the diagonal of the inverse: what remains of it after the other rows have been eliminated.
fn inverse_diagonal(mut matrix: [[f64; 4]; 4], index: usize) -> f64 {
    for k in (0..4).filter(|k| *k != index) {
        let pivot = matrix[k];
        for (_, row) in matrix.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k] / pivot[k];
            for (element, pivot) in row.iter_mut().zip(pivot) {
                *element -= factor * pivot;
            }
        }
    }
    1.0 / matrix[index][index]
}

const DRAWS: u64 = 20;

/// A finger drawn from the prior, within 1.5 deviations.
fn drawn(random: &mut Random) -> Finger {
    let mut finger = Finger::mean(PlaceBeforeContact::Air);
    for (parameter, deviation) in PRIOR.iter().enumerate() {
        change(&mut finger, parameter, deviation * random.normal().clamp(-1.5, 1.5));
    }
    finger.resistance_factor = finger.resistance_factor.max(0.5);
    finger
}

#[test]
fn stated_deviations_are_above_the_cramer_rao_bound_and_cover_the_errors() {
    let errors = Errors { noise_w_m2: NOISE_W_M2, surface_noise_k: 0.8e-3, ..Errors::NONE };
    for object in &OBJECTS[..3] {
        for ticks in [100, 500, 1500] {
            let [resistance, impedance] = bound(*object, ticks);
            let bounds = [resistance, impedance / COMPONENT];
            let (mut variances, mut squares) = ([0.0; 2], [0.0; 2]);
            for seed in 0..DRAWS {
                let mut random = Random(seed);
                let finger = drawn(&mut random);
                let outputs = learnt(&scene(&finger, *object, ticks, errors), &mut random, 0);
                let last = outputs.last().expect("an output");
                let off = [
                    last.resistance_factor.to_num::<f64>() - finger.resistance_factor,
                    last.parameters[0].to_num::<f64>() - first_component(&finger),
                ];
                let own = [4, 0].map(|index| last.variances[index].to_num::<f64>());
                for (variance, own) in variances.iter_mut().zip(own) {
                    *variance += own / DRAWS as f64;
                }
                for (square, off) in squares.iter_mut().zip(off) {
                    *square += off * off / DRAWS as f64;
                }
            }
            let found = squares.map(f64::sqrt);
            let [resistance, component] = variances.map(f64::sqrt);
            let stated = [resistance * PRIOR[0], component];
            println!(
                "{} {ticks} ms, resistance and component: bound {bounds:.4?}, stated {stated:.4?}, rms error {found:.4?}",
                object.name
            );
            for ((bound, stated), found) in bounds.into_iter().zip(stated).zip(found) {
                assert!(bound <= stated, "{bound} {stated}");
                assert!(found <= 1.1 * stated, "{found} {stated}");
            }
        }
    }
}
