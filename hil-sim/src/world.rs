//! What surrounds the device: the plant, what breaks in it, and who watches.

use crate::infrared::{Camera, ParameterError, Reading};
use crate::plant::bridge::{Leg, Legs};
use crate::plant::sensors::Channel;
use crate::plant::{ConfigError, Plant, PlantConfig};
use crate::scene::{FaultKind, Infrared, Scene};

/// Highest code of the converter.
const FULL_SCALE: u16 = 4095;

/// The plant behind the device's pins.
#[derive(Clone, Debug)]
pub struct World {
    plant: Plant,
    broken: Vec<FaultKind>,
    camera: Option<(Infrared, Camera)>,
    /// Last code of every channel.
    codes: [u16; Channel::ALL.len()],
}

/// What no world can be built from.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// The plant's.
    #[error(transparent)]
    Plant(#[from] ConfigError),
    /// The camera's.
    #[error("infrared camera: {0}")]
    Camera(#[from] ParameterError),
}

impl World {
    /// The world of a scene, [`Scene::settle_s`] before its time zero.
    ///
    /// # Errors
    /// A value that the plant or the camera cannot take.
    pub fn new(scene: &Scene) -> Result<Self, WorldError> {
        let camera = match scene.infrared {
            Some(infrared) => Some((infrared, infrared.camera(scene.seed)?)),
            None => None,
        };
        Ok(Self {
            plant: Plant::new(&scene.plant_config())?,
            broken: Vec::new(),
            camera,
            codes: [0; Channel::ALL.len()],
        })
    }

    /// The world of a plant that nobody watches, with the converter's noise of its own seed.
    ///
    /// # Errors
    /// A value that the plant cannot take.
    pub fn of_plant(config: &PlantConfig, noise_seed: u64) -> Result<Self, ConfigError> {
        let mut plant = Plant::new(config)?;
        plant.reseed_noise(noise_seed);
        Ok(Self {
            plant,
            broken: Vec::new(),
            camera: None,
            codes: [0; Channel::ALL.len()],
        })
    }

    /// What the camera says of the skin on the real object, a number of milliseconds after time zero; none between its
    /// frames.
    pub fn look(&mut self, ms: u64) -> Option<Reading> {
        let (infrared, camera) = self.camera.as_mut()?;
        let skin_c = self.plant.skin_real_c();
        infrared.has_frame(ms).then(|| camera.read(skin_c))
    }

    /// The plant, to read.
    #[must_use]
    pub const fn plant(&self) -> &Plant {
        &self.plant
    }

    /// What the finger does, and what is broken, from now on.
    pub fn set(&mut self, force_n: f64, broken: impl Iterator<Item = FaultKind>) {
        self.plant.set_force(force_n);
        self.broken.clear();
        self.broken.extend(broken);
    }

    /// Advances the plant by one step under the bridge's legs.
    pub fn step(&mut self, mut legs: Legs) {
        if self.broken.contains(&FaultKind::BridgeStuckHigh) {
            legs.a = Leg::Duty(1.0);
        }
        if self.broken.contains(&FaultKind::BridgeShorted) && matches!(legs.a, Leg::Duty(duty) if duty > 0.0)
        {
            legs.a = Leg::Shorted;
        }
        if self.broken.contains(&FaultKind::PolaritySwapped) {
            (legs.a, legs.b) = (legs.b, legs.a);
        }
        self.plant.step(&legs);
    }

    /// The bridge's driver pulls its fault pin.
    #[must_use]
    pub fn bridge_fault(&self) -> bool {
        self.plant.bridge_fault()
    }

    /// Code of a channel now.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        let code = self.plant.convert(channel);
        let last = &mut self.codes[channel as usize];
        if self.broken.contains(&FaultKind::AdcStuck) {
            return *last;
        }
        *last = match channel {
            Channel::Display if self.broken.contains(&FaultKind::ThermistorOpen) => FULL_SCALE,
            Channel::Display if self.broken.contains(&FaultKind::ThermistorShort) => 0,
            _ => code,
        };
        *last
    }
}
