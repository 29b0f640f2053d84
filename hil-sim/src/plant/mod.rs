//! The simulated world around the device: Peltier tile, finger, real material, sensors and bridge.
//!
//! ```text
//! legs -> bridge -> volts -> [ sink | tile | display face ] - R - [ finger ]     what the device does
//!                                                 |           force  |
//!                                              sensors -> counts      [ object ] - R - [ finger ]   the truth
//! ```
//!
//! First version: one-dimensional, a plate at one temperature (no spreading around the finger), homogeneous skin
//! without blood. Parameters are class values; nothing here was measured on hardware.

pub mod bridge;
pub mod chain;
mod config;
pub mod display;
pub mod half_space;
pub mod object;
mod schedule;
pub mod sensors;
pub mod tile;
pub mod touch;

use contact_model::material::{REFERENCE_DISPLAY, SKIN, Surface};

use bridge::{Bridge, Current, Legs};
pub use config::{ConfigError, PlantConfig};
use display::{Energy, FingerOnDisplay};
use half_space::HalfSpace;
use object::FingerOnObject;
use sensors::{Channel, Sensed, Sensors};
use touch::Touch;

/// One step of the plant, s; legs and force are held over it.
pub const STEP_S: f64 = 0.5e-3;

/// The plant of one finger.
#[derive(Clone, Debug)]
pub struct Plant {
    start_s: f64,
    appears_s: f64,
    skin_before_c: f64,
    room_c: f64,
    object_surface: Surface,
    bridge: Bridge,
    current: Current,
    display: FingerOnDisplay,
    truth: FingerOnObject,
    sensors: Sensors,
    /// Steps made.
    steps: u64,
    force_n: f64,
    on_display: Option<Touch>,
    on_object: Option<Touch>,
    /// Steps made since temperatures last changed abruptly.
    age: u32,
}

impl Plant {
    /// A plant at rest: finger lifted, tile and sink at room temperature, no current.
    ///
    /// # Errors
    /// If the configuration does not pass its [check](PlantConfig::check).
    pub fn new(config: &PlantConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let skin = HalfSpace::new(&SKIN, config.duration_s);
        let object = HalfSpace::new(&config.object, config.duration_s);
        let display = FingerOnDisplay::new(config.tile, &skin, config.skin_c, config.room_c);
        let at_rest = Sensed {
            display_c: config.room_c,
            sink_c: config.room_c,
            skin_before_c: config.skin_c,
            skin_c: config.skin_c,
            room_c: config.room_c,
            force_n: 0.0,
            mirror_a: 0.0,
        };
        Ok(Self {
            start_s: config.start_s,
            appears_s: config.appears_s,
            skin_before_c: config.skin_c,
            room_c: config.room_c,
            object_surface: config.object.surface,
            bridge: Bridge::new(config.bridge, config.tile.resistance_ohm),
            current: Current::default(),
            display,
            truth: FingerOnObject::new(&object, config.object_start_c, &skin, config.skin_c),
            sensors: Sensors::new(config.sensors, &at_rest, config.seed),
            steps: 0,
            force_n: 0.0,
            on_display: None,
            on_object: None,
            age: u32::MAX,
        })
    }

    /// Presses the finger with a force, N, from the next step on; none or less lifts it.
    pub fn set_force(&mut self, force_n: f64) {
        self.force_n = force_n.max(0.0);
    }

    /// Advances by [`STEP_S`] with the bridge's legs held.
    pub fn step(&mut self, legs: &Legs) {
        self.settle_contacts();
        self.current = self.bridge.current(STEP_S, legs, &self.display.load());
        for sub_step_s in schedule::sub_steps_s(STEP_S, self.age) {
            self.display.step(sub_step_s, &self.current);
            self.truth.step(sub_step_s);
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
            mirror_a: self.current.mirror_a,
        };
        self.sensors.step(STEP_S, &state);
    }

    /// Contacts as force and time have them in the coming step.
    fn settle_contacts(&mut self) {
        let on_display = Touch::under(self.force_n, &SKIN.surface, &REFERENCE_DISPLAY);
        // Half a step of slack: the sum of steps is not exact.
        let appeared = self.time_s() + 0.5 * STEP_S > self.appears_s;
        let on_object = Touch::under(self.force_n, &SKIN.surface, &self.object_surface).filter(|_| appeared);
        if touch::is_event(self.on_display, on_display) || touch::is_event(self.on_object, on_object) {
            self.age = 0;
        }
        self.display.touch(on_display);
        self.truth.touch(on_object);
        (self.on_display, self.on_object) = (on_display, on_object);
    }

    /// Converts one channel as it was at the end of the last step; each conversion draws its own noise.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        self.sensors.convert(channel)
    }

    /// The bridge's driver pulls its fault pin.
    #[must_use]
    pub fn bridge_fault(&self) -> bool {
        self.bridge.fault()
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
        self.display.display_c()
    }

    /// Surface of the skin on the display, deg C.
    #[must_use]
    pub fn skin_c(&self) -> f64 {
        self.display.skin_c()
    }

    /// Surface of the same skin on the real object, deg C.
    #[must_use]
    pub fn skin_real_c(&self) -> f64 {
        self.truth.skin_c()
    }

    /// Surface of the real object, deg C.
    #[must_use]
    pub fn object_c(&self) -> f64 {
        self.truth.object_c()
    }

    /// The sink, deg C.
    #[must_use]
    pub fn sink_c(&self) -> f64 {
        self.display.sink_c()
    }

    /// Current through the tile, A; positive cools the display.
    #[must_use]
    pub const fn current_a(&self) -> f64 {
        self.current.mean_a
    }

    /// What has crossed the tile's borders since the start.
    #[must_use]
    pub const fn energy(&self) -> Energy {
        self.display.energy()
    }
}

#[cfg(test)]
mod tests;
