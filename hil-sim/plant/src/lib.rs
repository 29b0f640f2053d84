#![doc = include_str!("../README.md")]

pub mod bridge;
pub mod comparator;
mod config;
mod defects;
pub mod finger;
pub mod heat;
pub mod infrared;
pub mod ledger;
pub mod object;
pub mod parameters;
mod schedule;
mod scheme;
pub mod sensors;
pub mod slab;
pub mod tile;
pub mod touch;
pub mod truth;

use bridge::{Bridge, Legs};
use comparator::Comparator;
pub use config::{ConfigError, HostParams, Params, PlantConfig};
use contact_model::material::Surface;
pub use defects::Defects;
use finger::Vessels;
pub use heat::Finger;
use heat::Heat;
use ledger::Energy;
use sensors::{BONDED, Channel, Sensed, Sensors, Taken};
use slab::{Grading, Probe, Slab, equilibrium};
use tile::Tile;
use touch::Touch;

/// One step of the plant, s; legs and force are held over it.
pub const STEP_S: f64 = 1e-3;

/// Depths of the receptors of cold and of warmth, m (thesis, section 2.2: 0.15 to 0.17 mm, 0.3 to 0.6 mm).
pub const RECEPTORS_M: [f64; 2] = [0.16e-3, 0.45e-3];

/// The plant of one finger.
#[derive(Clone, Debug)]
pub struct Plant {
    start_s: f64,
    appears_s: f64,
    object_start_c: f64,
    skin_before_c: f64,
    room_c: f64,
    surfaces: Surfaces,
    vessels: Option<Vessels>,
    bridge: Bridge,
    /// Supply that the bridge should have, V.
    supply_v: f64,
    comparator: Comparator,
    defects: Defects,
    heat: Heat,
    receptors: [Option<Probe>; RECEPTORS_M.len()],
    sensors: Sensors,
    /// Steps made.
    steps: u64,
    force_n: f64,
    /// Force, and whether the object is there, for which the contacts stand.
    settled: Option<(f64, bool)>,
    on_display: Option<Touch>,
    on_object: Option<Touch>,
    /// Steps made since temperatures last changed abruptly.
    age: u32,
}

/// What meets in the contacts.
#[derive(Clone, Copy, Debug)]
struct Surfaces {
    skin: Surface,
    display: Surface,
    object: Surface,
}

impl Plant {
    /// A plant at rest: finger lifted, tile and sink at the temperature of the sink's coolant, no current.
    ///
    /// # Errors
    /// If the configuration does not pass its [check](PlantConfig::check).
    pub fn new(config: &PlantConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let params = &config.params;
        let watched_s = config.duration_s - config.start_s;
        let cut = |layers: &[slab::Layer], back| Slab::new(layers, back, watched_s, &Grading::RUN);
        let finger = cut(&params.finger.layers, params.finger.back());
        let object = cut(&[config.object.layer()], config.object.back);
        let air_w_m2k = params.finger.air_w_m2k;
        let rest = equilibrium(
            &finger,
            config.skin_c,
            air_w_m2k * (config.skin_c - config.room_c),
        )
        .ok_or_else(|| ConfigError::cold_finger(air_w_m2k))?;
        config::core(rest.core_c)?;
        let mut heat = Heat::new(
            (&finger, config.skin_c),
            (&object, config.object.start_c),
            Tile::new(params.tile, config.room_c),
            (air_w_m2k, config.room_c),
            STEP_S,
        );
        heat.rest_finger(&rest.node_c, rest.core_c);
        let at_rest = Sensed {
            display_c: heat.display_c(),
            sink_c: heat.tile().sink_c(),
            skin_before_c: config.skin_c,
            skin_c: config.skin_c,
            room_c: config.room_c,
            force_n: 0.0,
            mirror_a: 0.0,
        };
        let sensors = Sensors::new(params.sensors, &at_rest, config.seed);
        Ok(Self {
            start_s: config.start_s,
            appears_s: config.appears_s,
            object_start_c: config.object.start_c,
            skin_before_c: config.skin_c,
            room_c: config.room_c,
            surfaces: Surfaces {
                skin: params.finger.surface,
                display: params.display,
                object: config.object.material.surface,
            },
            vessels: params.finger.vessels,
            bridge: Bridge::new(params.bridge, params.tile.resistance_ohm()),
            supply_v: params.bridge.supply_v,
            comparator: Comparator::new(
                &params.comparator,
                &BONDED,
                sensors.pin_ratio(Channel::DisplayCheck as usize),
            ),
            defects: Defects::default(),
            heat,
            receptors: RECEPTORS_M.map(|depth_m| Probe::at(&finger, depth_m)),
            sensors,
            steps: 0,
            force_n: 0.0,
            settled: None,
            on_display: None,
            on_object: None,
            age: u32::MAX,
        })
    }

    /// Presses the finger with a force, N, from the next step on; none or less lifts it.
    pub fn set_force(&mut self, force_n: f64) {
        self.force_n = force_n.max(0.0);
    }

    /// Breaks and mends parts, from the next step on.
    pub fn set_defects(&mut self, defects: &Defects) {
        if self.defects == *defects {
            return;
        }
        self.defects = *defects;
        self.sensors.set_defects(&defects.sensors);
        self.bridge
            .set_supply(defects.bridge.supply_v.unwrap_or(self.supply_v));
        self.comparator.set_defect(defects.comparator);
        self.heat.cool(&defects.cooling);
        self.heat.set_module(defects.module);
    }

    /// Sets the level of the comparator's test line.
    pub fn comparator_test(&mut self, level: bool) {
        self.comparator.test(level);
    }

    /// Draws the converter's noise of another seed from now on; its profile stays, as it is the device's own.
    pub fn reseed_noise(&mut self, seed: u64) {
        self.sensors.reseed_noise(seed);
    }

    /// Advances by [`STEP_S`] with the bridge's legs held.
    pub fn step(&mut self, legs: &Legs) {
        self.settle_contacts();
        // Without supply nothing drives the tile, and its own voltage stays below that of two diodes.
        let legs = if self.comparator.tripped() {
            Legs::default()
        } else {
            self.defects.bridge.legs(legs)
        };
        for index in schedule::sub_steps(self.age) {
            self.heat.step(index, &mut self.bridge, &legs);
        }
        self.steps += 1;
        self.age = self.age.saturating_add(1);
        let state = Sensed {
            display_c: self.display_c(),
            sink_c: self.sink_c(),
            skin_before_c: self.skin_before_c,
            skin_c: self.skin_c(),
            room_c: self.room_c,
            force_n: self.force_n,
            mirror_a: self.heat.tile().current().mirror_a,
        };
        self.sensors.step(STEP_S, &state);
        self.comparator
            .watch(self.sensors.pin_ratio(Channel::DisplayCheck as usize));
    }

    /// Contacts as force and time have them in the coming step.
    fn settle_contacts(&mut self) {
        // Half a step of slack: the sum of steps is not exact.
        let appeared = self.time_s() + 0.5 * STEP_S > self.appears_s.max(0.0);
        let settled = Some((self.force_n, appeared));
        if self.settled == settled {
            return;
        }
        if appeared && !self.settled.is_some_and(|(_, appeared)| appeared) {
            // Until now nothing has happened to the object, whatever lies behind it.
            self.heat.place_object(self.object_start_c);
            self.age = 0;
        }
        self.settled = settled;
        let Surfaces {
            skin,
            display,
            object,
        } = &self.surfaces;
        let on_display = Touch::under(self.force_n, skin, display);
        let on_object = Touch::under(self.force_n, skin, object).filter(|_| appeared);
        if touch::is_event(self.on_display, on_display)
            || touch::is_event(self.on_object, on_object)
        {
            self.age = 0;
        }
        self.heat.touch(on_display, on_object, appeared);
        (self.on_display, self.on_object) = (on_display, on_object);
        if let Some(vessels) = &self.vessels {
            self.heat.set_flow(vessels.flow(self.force_n));
        }
    }

    /// Converts one channel as it was at the end of the last step; each conversion draws its own noise.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        self.sensors.convert(channel)
    }

    /// nFAULT is low: the bridge's driver or the comparator pulls it.
    #[must_use]
    pub fn bridge_fault(&self) -> bool {
        (self.bridge.fault() || self.comparator.tripped()) && !self.defects.bridge.fault_pin_dead
    }

    /// The comparator has cut the bridge supply.
    #[must_use]
    pub const fn supply_cut(&self) -> bool {
        self.comparator.tripped()
    }

    /// Time, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.start_s + self.steps as f64 * STEP_S
    }

    /// Force of the finger, N.
    #[must_use]
    pub const fn force_n(&self) -> f64 {
        self.force_n
    }

    /// True surface of the display, deg C.
    #[must_use]
    pub fn display_c(&self) -> f64 {
        self.heat.display_c()
    }

    /// Surface of the skin on the display, deg C.
    #[must_use]
    pub fn skin_c(&self) -> f64 {
        self.heat.skin_c(Finger::OnDisplay)
    }

    /// Surface of the same skin on the real object, deg C.
    #[must_use]
    pub fn skin_real_c(&self) -> f64 {
        self.heat.skin_c(Finger::OnObject)
    }

    /// The skin at the depth of its receptors of cold and of warmth ([`RECEPTORS_M`]), deg C; none where the finger is
    /// thinner than that.
    #[must_use]
    pub fn receptors_c(&self, finger: Finger) -> [Option<f64>; RECEPTORS_M.len()] {
        let read = |probe: Option<Probe>| probe.map(|probe| self.heat.depth_c(finger, &probe));
        self.receptors.map(read)
    }

    /// Surface of the real object, deg C.
    #[must_use]
    pub fn object_c(&self) -> f64 {
        self.heat.object_c()
    }

    /// The sink, deg C.
    #[must_use]
    pub fn sink_c(&self) -> f64 {
        self.heat.tile().sink_c()
    }

    /// What the sensors take in, before the converter.
    #[must_use]
    pub fn taken(&self) -> Taken {
        self.sensors.taken()
    }

    /// Current through the tile, A; positive cools the display.
    #[must_use]
    pub fn current_a(&self) -> f64 {
        self.heat.tile().current().mean_a
    }

    /// What has crossed the tile's borders since the start.
    #[must_use]
    pub fn energy(&self) -> Energy {
        self.heat.energy()
    }
}

#[cfg(test)]
mod tests;
