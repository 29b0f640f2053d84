//! What surrounds the device: the plant, and what breaks in it.

use crate::plant::bridge::{Leg, Legs};
use crate::plant::object::ObjectConfig;
use crate::plant::sensors::Channel;
use crate::plant::{ConfigError, Params, Plant, PlantConfig};
use crate::scene::{FaultKind, Scene};

/// Highest code of the converter.
const FULL_SCALE: u16 = 4095;

/// The plant behind the device's pins.
#[derive(Clone, Debug)]
pub struct World {
    plant: Plant,
    broken: Vec<FaultKind>,
    /// Last code of every channel.
    codes: [u16; Channel::ALL.len()],
}

impl World {
    /// The world of a scene, [`Scene::settle_s`] before its time zero.
    ///
    /// # Errors
    /// A value that the plant cannot take.
    pub fn new(scene: &Scene) -> Result<Self, ConfigError> {
        let config = PlantConfig {
            skin_c: scene.skin_c,
            room_c: scene.room_c,
            object: ObjectConfig::half_space(scene.object.material, scene.object_c()),
            start_s: -scene.settle_s,
            appears_s: scene.object.appears_t_s,
            duration_s: scene.duration_s,
            seed: scene.seed,
            params: Params::nominal(),
        };
        Ok(Self {
            plant: Plant::new(&config)?,
            broken: Vec::new(),
            codes: [0; Channel::ALL.len()],
        })
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
