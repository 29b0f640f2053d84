//! Scenes: the finger, the object, the plant and the device, and the events in a run.

mod fault;
mod file;
mod infrared;
mod nesting;
mod object;
mod parameter_node;
mod parse;
mod plant;
mod source;
mod word;

use std::path::Path;

use contact_model::material::{MATERIALS, Material, REFERENCE_DISPLAY, SKIN};
use contact_model::pressure::pressure_pa;
use contact_model::reference::{Contact, interface_temperature};
use thermal_client::course::Course;
use thermal_client::text;
pub use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_device::{PWM_PERIOD_STEPS_OF_FIVE_FINGERS, PWM_STEPS_PER_SECOND};
use thermal_plant::bridge::BridgeParams;
use thermal_plant::finger::FingerParams;
use thermal_plant::object::ObjectConfig;
use thermal_plant::parameters::FingerDraw;
use thermal_plant::slab::{BackBoundary, Layer};
use thermal_plant::{Params, PlantConfig};

use crate::processor::{ChipState, Injection};

pub(crate) use fault::ActiveDefects;
pub use fault::{
    ActiveFault, DRIFT_K_S, FaultKind, ProcessorKey, ProcessorKind, ScheduledFault, Sensor,
    ValueRange, fault_names, fault_table,
};
pub use infrared::Infrared;
pub(crate) use object::custom_line;
pub use source::SceneError;

/// The names of all materials, for messages.
pub fn known_materials() -> String {
    MATERIALS.map(|(name, _)| name).join(", ")
}

/// A scene that has passed every check.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Duration from time zero on, s.
    pub duration_s: f64,
    /// Time before zero in which the device is powered up, armed and settles, s.
    pub settle_s: f64,
    /// Skin temperature before contact, °C.
    pub skin_c: f64,
    /// Room temperature, °C.
    pub room_c: f64,
    /// Seed of every random draw.
    pub seed: u64,
    /// Whether the device was calibrated and tuned before the scene.
    pub commissioned: bool,
    /// Whether the operator has measured the surface of the display, and tells the device.
    pub measured_surface: bool,
    /// Whether the finger was enrolled on the device on another day.
    pub enrolled: bool,
    /// The microcontroller before its program starts.
    pub chip: ChipState,
    /// Contact model that the device uses.
    pub mode: ContactModel,
    /// Control law; `None` for the default of the device.
    pub law: Option<Law>,
    /// The object that the display imitates.
    pub object: Object,
    /// The finger that the operator lets the device assume.
    pub assumed_finger: AssumedFinger,
    /// Whether the device is given a half-space of the object's material, whatever the object is.
    pub object_as_half_space: bool,
    /// Nominal parameters with the scene's finger, neither drawn nor set below `plant`: what the exact set-point is for.
    pub nominal: Params,
    /// Parameters of finger, display and electronics.
    pub params: Params,
    /// Which of them were drawn.
    pub draws: Draws,
    /// The infrared camera that observes the finger on the real object, if any.
    pub infrared: Option<Infrared>,
    /// Changes of the force, in order of time.
    pub forces: Vec<Force>,
    /// Faults of plant, converter and host.
    pub faults: Vec<ScheduledFault>,
    /// Faults of the processor.
    pub injections: Vec<Injection>,
    /// Times of the rising edges at the trigger input, s; counted to a microsecond.
    pub triggers_s: Vec<f64>,
    /// Lines that the host sends.
    pub host: Vec<HostLine>,
    /// Temperatures that the display follows from the landing on, in place of those of the object. No scene file has one.
    pub course: Option<Course>,
}

/// The object that the display imitates.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Name of the material, or `custom`.
    pub name: String,
    /// Its properties; of a layered object they determine the contact resistance, and what a half-space would be.
    pub material: Material,
    /// Temperature before contact, °C, which the device is given; the room's if absent.
    pub start_c: Option<f64>,
    /// Time at which it appears, s.
    pub appears_t_s: f64,
    /// Its layers, from the touched face down; one for an object of one material, endless for a half-space.
    pub layers: Vec<Layer>,
    /// Boundary condition behind the last layer.
    pub back: BackBoundary,
}

impl Object {
    /// Whether it is a half-space of its material.
    pub fn is_half_space(&self) -> bool {
        self.layers == ObjectConfig::half_space(self.material, 0.0).layers
    }
}

/// Random draws of a scene's plant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Draws {
    /// Seed of all parameters but those of the contact.
    pub plant: Option<u64>,
    /// Seed of the contact law.
    pub contact: Option<u64>,
    /// The finger.
    pub finger: Option<FingerDraw>,
}

/// A change to a force that is then held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force {
    /// Start, s.
    pub t_s: f64,
    /// Force at the end of the ramp, N.
    pub force_n: f64,
    /// Duration of the linear ramp from the previous force, s.
    pub ramp_s: f64,
}

/// A line that the host sends.
#[derive(Clone, Debug, PartialEq)]
pub struct HostLine {
    /// Time, s.
    pub t_s: f64,
    /// The line without its end.
    pub line: String,
}

impl Scene {
    /// Reads and checks a scene.
    ///
    /// # Errors
    /// The first thing that is wrong, with file and line, and what is allowed.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let text = text::read(path, text::DOCUMENT_BYTES_MAX)
            .map_err(|error| SceneError::unreadable(path, &error))?;
        Self::parse(&text, path)
    }

    /// Checks a scene's text; `path` is for messages.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, SceneError> {
        parse::scene(text, path)
    }

    /// Temperature of the object before contact, °C.
    pub fn object_c(&self) -> f64 {
        self.object.start_c.unwrap_or(self.room_c)
    }

    /// Whether Eq. 3-1 or Eq. 6-12 give the exact set-point: Eq. 3-1 in its mode, Eq. 6-12 if the finger is the thesis's,
    /// without a film of air, the object a half-space, and no layer of a heat-flux sensor between them.
    pub fn has_closed_form(&self) -> bool {
        let finger_is_thesiss = self.nominal.finger == FingerParams::homogeneous();
        self.mode == ContactModel::SemiInfinite
            || (self.object.is_half_space() && finger_is_thesiss && self.nominal.flux.is_none())
    }

    /// The exact set-point for a nominal finger of known temperature before contact, °C, `since_s` after it landed with
    /// `force_n`, if finger and object are half-spaces. At landing, and therefore for the preset, neither these nor the force
    /// matter.
    pub fn exact_setpoint_c(&self, since_s: f64, force_n: f64) -> f64 {
        let object = &self.object.material;
        match self.mode {
            ContactModel::SemiInfinite => {
                interface_temperature(&SKIN, self.skin_c, object, self.object_c())
            }
            ContactModel::ContactResistance => {
                let (finger, object) = ((&SKIN, self.skin_c), (object, self.object_c()));
                Contact::new(finger, object, &REFERENCE_DISPLAY, pressure_pa(force_n))
                    .at(since_s)
                    .display_c
            }
        }
    }

    /// A notice if no line describes the object to the device as it is: one whose back has another temperature.
    pub fn untold_back(&self) -> Option<String> {
        let (BackBoundary::Film { temperature_c, .. }, false, object_c) =
            (self.object.back, self.object_as_half_space, self.object_c())
        else {
            return None;
        };
        (temperature_c != object_c).then(|| {
            format!(
                "the back of the object is at {temperature_c} C; the device cannot be told that, and takes it for \
                 {object_c} C like the object"
            )
        })
    }

    /// Configuration of the plant.
    pub fn plant_config(&self) -> PlantConfig {
        PlantConfig {
            skin_c: self.skin_c,
            room_c: self.room_c,
            object: ObjectConfig {
                surface: self.object.material.surface,
                layers: self.object.layers.clone(),
                start_c: self.object_c(),
                back: self.object.back,
            },
            start_s: -self.settle_s,
            appears_s: self.object.appears_t_s,
            duration_s: self.duration_s,
            seed: self.seed,
            params: self.params.clone(),
        }
    }

    /// This scene on a device for five fingers, whose PWM has a frequency of its own; a frequency that the scene gives stays.
    pub fn on_five_fingers(&self) -> Self {
        let mut scene = self.clone();
        let pwm_hz = &mut scene.params.bridge.pwm_hz;
        if *pwm_hz == BridgeParams::NOMINAL.pwm_hz {
            *pwm_hz = f64::from(PWM_STEPS_PER_SECOND) / f64::from(PWM_PERIOD_STEPS_OF_FIVE_FINGERS);
        }
        scene
    }

    /// Settling time before time zero, ms.
    pub(crate) fn settle_ms(&self) -> u64 {
        (self.settle_s * 1e3).round() as u64
    }

    /// Force at a time, N.
    pub fn force_n(&self, t_s: f64) -> f64 {
        let mut held_n = 0.0;
        for force in self.forces.iter().take_while(|force| force.t_s <= t_s) {
            let since_s = t_s - force.t_s;
            held_n = if since_s < force.ramp_s {
                held_n + (force.force_n - held_n) * since_s / force.ramp_s
            } else {
                force.force_n
            };
        }
        held_n
    }
}
