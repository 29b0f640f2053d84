//! The covariance after many updates, and arithmetic that fails.

use std::println;
use std::vec::Vec;

use super::*;
use crate::parameters::{PlaceBeforeContact, relative_weights};
use crate::regressors::Signals;
use crate::tests::contacts::sensor;
use crate::tests::matrix::least_pivot;
use crate::tests::random::Random;
use crate::tests::simulation::{Errors, Finger, OBJECTS, Scene, display_resistance_m2k_w, sound};

const UPDATES: usize = 1_000_000;

#[test]
fn covariance_stays_positive_over_a_million_updates() {
    let mut random = Random(1);
    let finger = Finger::drawn(&mut random);
    let (sensor, force_n) = (sensor(), 2.0);
    let scale = Scale::new(finger.place, sensor.lag_deviation());
    let mut measurements = Vec::new();
    for object in OBJECTS {
        let errors = Errors::drawn(&mut random);
        let scene =
            Scene { finger: &finger, object, force_n, ticks: 1000, errors, reported: &sound };
        let mut signals = Signals::NEW;
        for input in scene.inputs(&mut random, 0) {
            let drive = signals.drive(&input, &sensor);
            let lagged = signals.lagged(&drive, &sensor);
            signals.advance(&drive, &sensor);
            let resistance = display_resistance_m2k_w(force_n) as f32;
            measurements.push(lagged.measurement(
                resistance,
                &sensor,
                &scale,
                &relative_weights(&PRIOR),
            ));
        }
    }
    let mut estimate = Estimate::PRIOR;
    let mut least = f64::INFINITY;
    for (update, measurement) in measurements.iter().cycle().take(UPDATES).enumerate() {
        estimate.update(measurement, 4e-4, &scale).expect("sound arithmetic");
        if update % 97 == 0 {
            least = least.min(least_pivot(&estimate.covariance));
            assert!(least > 0.0, "{update}: {estimate:?}");
        }
    }
    println!("least pivot {least:.1e}");
    for (i, row) in estimate.covariance.iter().enumerate() {
        for (j, element) in row.iter().enumerate() {
            assert_eq!(element.to_bits(), estimate.covariance[j][i].to_bits());
        }
    }
}

#[test]
fn measurements_that_are_no_numbers_are_refused() {
    let scale = Scale::new(PlaceBeforeContact::Air, 0.3);
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        for in_regressor in [false, true] {
            let mut measurement = Measurement {
                residual_k: 0.1,
                regressors: [0.1; PARAMETERS],
                open_circuit_difference_k: 1.0,
            };
            if in_regressor {
                measurement.regressors[2] = value;
            } else {
                measurement.residual_k = value;
            }
            let mut estimate = Estimate::PRIOR;
            assert_eq!(estimate.update(&measurement, 1e-4, &scale), None, "{value}");
            for (parameter, limits) in
                (estimate.parameters.iter()).zip(scale.low.iter().zip(&scale.high))
            {
                assert!(limits.0 <= parameter && parameter <= limits.1);
            }
        }
    }
}
