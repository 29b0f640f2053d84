//! Expected falls: what the observer feels at a real sample, without noise.

use contact_model::material::Material;
use serde::Serialize;
use thermal_plant::object::ObjectConfig;
use thermal_plant::{Params, PlantConfig, SampleTouch};
use thermal_session::ContactRule;

use crate::device::MESHED_S;
use crate::hand::{ForceCourse, Touches};
use crate::observer::FallMeter;
use crate::random::Stream;
use crate::{BenchError, HandParams};

/// Touches over which a fall is averaged.
const TOUCHES: u32 = 24;
/// Seed of these touches.
const SEED: u64 = 1;
/// Longest contact, s.
const CONTACT_MAX_S: f64 = 10.0;

/// Finger, room and hand.
#[derive(Clone, Debug)]
pub struct TouchSetup {
    /// Parameters of the finger and its contact.
    pub params: Params,
    /// Skin before contact, °C.
    pub skin_c: f64,
    /// Room and sample, °C.
    pub room_c: f64,
    /// The hand.
    pub hand: HandParams,
    /// Median of the time to the decision, s.
    pub decision_median_s: f64,
    /// Standard deviation of its logarithm.
    pub decision_sigma_ln: f64,
}

/// Mean and standard deviation of a fall over touches that differ in force and duration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ExpectedFall {
    /// Mean, K.
    pub mean_k: f64,
    /// Standard deviation, K.
    pub sd_k: f64,
}

/// The finger and a sample of a material.
///
/// # Errors
/// The plant does not accept a value.
pub fn sample_touch(
    params: &Params,
    (skin_c, room_c): (f64, f64),
    material: &Material,
) -> Result<SampleTouch, BenchError> {
    Ok(SampleTouch::new(&PlantConfig {
        skin_c,
        room_c,
        object: ObjectConfig::half_space(*material, room_c),
        start_s: 0.0,
        appears_s: 0.0,
        duration_s: MESHED_S,
        seed: SEED,
        params: params.clone(),
    })?)
}

/// Temperatures at the depths of the cold and warm receptors, °C.
pub fn both(receptors_c: [Option<f64>; 2]) -> Result<[f64; 2], BenchError> {
    match receptors_c {
        [Some(cold_c), Some(warm_c)] => Ok([cold_c, warm_c]),
        _ => Err(BenchError::NoReceptors),
    }
}

/// Fall of the skin on a sample in free exploration until the decision.
///
/// # Errors
/// The plant does not accept a value.
pub fn mean_fall(setup: &TouchSetup, material: &Material) -> Result<ExpectedFall, BenchError> {
    let mut falls_k = Vec::new();
    for touch in 0..TOUCHES {
        let mut random = Stream::new(SEED, &format!("familiarisation {touch}"));
        let decision_s = random
            .log_normal(setup.decision_median_s, setup.decision_sigma_ln)
            .min(CONTACT_MAX_S);
        let touches = Touches::new(&setup.hand, ContactRule::Free, CONTACT_MAX_S, &mut random);
        let course = ForceCourse::new(&setup.hand, &touches, None, &mut random);
        let mut finger = sample_touch(&setup.params, (setup.skin_c, setup.room_c), material)?;
        let mut meter = FallMeter::default();
        meter.push(both(finger.receptors_c())?);
        meter.begin();
        let steps = (decision_s * 1e3).round() as u32;
        for ms in 0..steps {
            finger.set_force(course.force_n(f64::from(ms) * 1e-3, f64::INFINITY));
            finger.step();
            meter.push(both(finger.receptors_c())?);
        }
        falls_k.extend(meter.fall_k());
    }
    let count = falls_k.len() as f64;
    let mean_k = falls_k.iter().sum::<f64>() / count;
    let variance = falls_k.iter().map(|k| (k - mean_k).powi(2)).sum::<f64>() / (count - 1.0);
    Ok(ExpectedFall {
        mean_k,
        sd_k: variance.sqrt(),
    })
}
