//! Expected falls: what the observer feels at a real sample or at the display, without noise.

use std::time::Duration;

use contact_model::material::Material;
use thermal_client::client::{Client, ClientError, QueryState, StationRequest};
use thermal_client::link::LinkError;
use thermal_device::StateName;
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_plant::object::ObjectConfig;
use thermal_plant::{Finger, Params, PlantConfig, SampleTouch};
use thermal_session::ContactRule;

use crate::device::{DeviceLink, MESHED_S, PreparedDevice};
use crate::hand::{ForceCourse, Touches};
use crate::observer::FallMeter;
use crate::random::Stream;
use crate::{BenchError, HandParams};

/// Touches over which the falls of a familiarisation are averaged.
const FAMILIAR_AFTER: u32 = 24;
/// Seed of these touches.
const SEED: u64 = 1;
/// Longest contact, s.
const CONTACT_MAX_S: f64 = 10.0;
/// Time in which a device that was switched on is ready to be armed, and in which one that was armed or started comes to rest.
const SETTLES: Duration = Duration::from_secs(5);
const MS: Duration = Duration::from_millis(1);

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
    /// How it touches.
    pub contact: ContactRule,
    /// The finger that a display is to assume.
    pub assumed_finger: AssumedFinger,
    /// Median of the time to the decision, s.
    pub decision_median_s: f64,
    /// Standard deviation of its logarithm.
    pub decision_sigma_ln: f64,
}

/// What one finger does until the decision.
#[derive(Clone, Debug)]
pub struct Exploration {
    course: ForceCourse,
    steps: u32,
}

impl Exploration {
    /// The exploration with a number: its random draws depend on nothing else.
    pub fn new(setup: &TouchSetup, number: u32) -> Self {
        let mut random = Stream::new(SEED, &format!("exploration {number}"));
        let decision_s =
            random.log_normal(setup.decision_median_s, setup.decision_sigma_ln).min(CONTACT_MAX_S);
        let touches = Touches::new(&setup.hand, setup.contact, CONTACT_MAX_S, &mut random);
        Self {
            course: ForceCourse::new(&setup.hand, &touches, None, &mut random),
            steps: (decision_s * 1e3).round() as u32,
        }
    }

    /// Force in each millisecond, N.
    fn forces_n(&self) -> impl Iterator<Item = f64> {
        (0..self.steps).map(|ms| self.course.force_n(f64::from(ms) * 1e-3, f64::INFINITY))
    }

    /// Fall on a sample of a material, K.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn on_sample(&self, setup: &TouchSetup, material: &Material) -> Result<f64, BenchError> {
        let mut finger = sample_touch(&setup.params, (setup.skin_c, setup.room_c), material)?;
        let mut meter = FallMeter::default();
        meter.push(both(finger.receptors_c())?);
        meter.begin();
        for force_n in self.forces_n() {
            finger.set_force(force_n);
            finger.step();
            meter.push(both(finger.receptors_c())?);
        }
        Ok(meter.fall_k().unwrap_or(0.0))
    }

    /// Fall on the display that presents a material of the device's table, K.
    ///
    /// # Errors
    /// The plant does not accept a value, or the device refuses a command or trips.
    pub fn on_display(
        &self,
        setup: &TouchSetup,
        device: &PreparedDevice,
        (mode, law): (ContactModel, Law),
        material: &str,
    ) -> Result<f64, BenchError> {
        let mut client = Client::new(DeviceLink::new(device.power_up(setup.skin_c, SEED)?));
        let refused = |error: ClientError| BenchError::Device(error.to_string());
        let gone = |error: LinkError| BenchError::Device(error.to_string());
        client.wait(SETTLES).map_err(gone)?;
        for command in [
            StationRequest::Law { law },
            StationRequest::Mode { model: mode },
            StationRequest::Finger { finger: setup.assumed_finger },
            StationRequest::material(material),
            StationRequest::object_temperature(None),
        ] {
            client.ask(&command).map_err(refused)?;
        }
        for command in [StationRequest::Arm, StationRequest::Start] {
            client.ask(&command).map_err(refused)?;
            client.wait(SETTLES).map_err(gone)?;
        }
        let mut meter = FallMeter::default();
        meter.push(both(client.link().plant().receptors_c(Finger::OnDisplay))?);
        meter.begin();
        for force_n in self.forces_n() {
            client.link().press(force_n);
            client.wait(MS).map_err(gone)?;
            meter.push(both(client.link().plant().receptors_c(Finger::OnDisplay))?);
        }
        // A device that has tripped no longer presents anything, which the falls alone would not show.
        match client.ask(&QueryState).map_err(refused)?.state {
            StateName::Tripped(fault) => Err(BenchError::Device(format!("tripped: {fault:?}"))),
            _ => Ok(meter.fall_k().unwrap_or(0.0)),
        }
    }
}

/// The finger and a sample of a material.
///
/// # Errors
/// The plant does not accept a value.
pub(crate) fn sample_touch(
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
pub(crate) fn both(receptors_c: [Option<f64>; 2]) -> Result<[f64; 2], BenchError> {
    match receptors_c {
        [Some(cold_c), Some(warm_c)] => Ok([cold_c, warm_c]),
        _ => Err(BenchError::NoReceptors),
    }
}

/// Mean fall on a sample of a material over many explorations, K.
///
/// # Errors
/// The plant does not accept a value.
pub fn mean_fall_k(setup: &TouchSetup, material: &Material) -> Result<f64, BenchError> {
    let mut sum_k = 0.0;
    for number in 0..FAMILIAR_AFTER {
        sum_k += Exploration::new(setup, number).on_sample(setup, material)?;
    }
    Ok(sum_k / f64::from(FAMILIAR_AFTER))
}
