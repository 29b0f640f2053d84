//! What surrounds the device: the plant, what breaks in it, and who watches.

mod defects;

use thermal_plant::bridge::BridgeOutputs;
use thermal_plant::infrared::{Camera, ParameterError, Reading};
use thermal_plant::sensors::Channel;
use thermal_plant::{ConfigError, Plant, PlantConfig};

use crate::scene::{Broken, Infrared, Scene};
use defects::Damage;

/// The plant behind the device's pins.
#[derive(Clone, Debug)]
pub struct World {
    plant: Plant,
    damage: Damage,
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
            damage: Damage::default(),
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
            damage: Damage::default(),
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
    pub fn set(&mut self, force_n: f64, broken: impl Iterator<Item = Broken>) {
        self.plant.set_force(force_n);
        self.damage = Damage::default();
        for broken in broken {
            self.damage.add(&broken);
        }
        self.plant.set_defects(&self.damage.plant);
    }

    /// Sets the level of the line by which the device tests the comparator. Whoever runs the device says so after each
    /// of its ticks; a line that nobody drives is pulled low.
    pub fn comparator_test(&mut self, level: bool) {
        self.plant.comparator_test(level);
    }

    /// Advances the plant by one step under the bridge's legs.
    pub fn step(&mut self, legs: BridgeOutputs) {
        self.plant.step(&legs);
    }

    /// nFAULT is low: the bridge's driver or the comparator pulls it.
    #[must_use]
    pub fn bridge_fault(&self) -> bool {
        self.plant.bridge_fault()
    }

    /// Code of a channel now.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        let code = self.plant.convert(channel);
        let index = channel as usize;
        if !self.damage.frozen[index] {
            self.codes[index] = code;
        }
        self.codes[index]
    }
}
