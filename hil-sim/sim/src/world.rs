//! The surroundings of the device: plant, defects and infrared camera.

use thermal_plant::bridge::BridgeOutputs;
use thermal_plant::comparator::ComparatorTest;
use thermal_plant::infrared::{Camera, ParameterError, Reading};
use thermal_plant::sensors::Channel;
use thermal_plant::{ConfigError, Defects, Plant, PlantConfig};

use crate::processor::ChipState;
use crate::scene::{ActiveDefects, ActiveFault, Infrared, Scene};

/// The plant at the pins of the device, its present defects, and the camera.
#[derive(Clone, Debug)]
pub struct World {
    plant: Plant,
    defects: ActiveDefects,
    camera: Option<(Infrared, Camera)>,
    chip: ChipState,
    /// Largest current through a resistor in place of the tile.
    pulse: Pulse,
    /// Last code of every channel.
    codes: [u16; Channel::ALL.len()],
}

/// What an oscilloscope has caught of a pulse through a resistor in place of the tile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pulse {
    /// Mean voltage across the resistor, V, without its sign.
    pub mean_v: f64,
    /// Ripple of that voltage, RMS, V.
    pub ripple_v: f64,
    /// Half of the peak-to-peak ripple of the inductors' current, A.
    pub inductor_half_a: f64,
}

/// Why a world cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A value that the plant does not accept.
    #[error(transparent)]
    Plant(#[from] ConfigError),
    /// A value that the camera does not accept.
    #[error("infrared camera: {0}")]
    Camera(#[from] ParameterError),
}

impl World {
    /// The world of a scene, [`Scene::settle_s`] before its time zero.
    ///
    /// # Errors
    /// A value that the plant or the camera cannot take.
    pub fn new(scene: &Scene) -> Result<Self, WorldError> {
        let plant = Plant::new(&scene.plant_config())?;
        let camera = scene.infrared.map(|infrared| {
            let camera = infrared.camera(scene.seed)?;
            Ok::<_, ParameterError>((infrared, camera))
        });
        Ok(Self { chip: scene.chip, ..Self::with(plant, camera.transpose()?) })
    }

    /// The world of a scene on one of the five fingers of a device.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_five_fingers(scene: &Scene) -> Result<Self, WorldError> {
        Self::new(&scene.on_five_fingers())
    }

    /// The world of a plant without a camera, with its own seed for the converter's noise.
    ///
    /// # Errors
    /// A value that the plant cannot take.
    pub fn from_plant(config: &PlantConfig, noise_seed: u64) -> Result<Self, ConfigError> {
        let mut plant = Plant::new(config)?;
        plant.reseed_noise(noise_seed);
        Ok(Self::with(plant, None))
    }

    fn with(plant: Plant, camera: Option<(Infrared, Camera)>) -> Self {
        Self {
            plant,
            defects: ActiveDefects::default(),
            camera,
            chip: ChipState::default(),
            pulse: Pulse::default(),
            codes: [0; Channel::ALL.len()],
        }
    }

    /// Camera reading of the skin on the real object, `ms` milliseconds after time zero; `None` between frames.
    pub fn camera_reading(&mut self, ms: u64) -> Option<Reading> {
        let (infrared, camera) = self.camera.as_mut()?;
        let skin_c = self.plant.skin_real_c();
        infrared.has_frame(ms).then(|| camera.read(skin_c))
    }

    /// The microcontroller before its program starts.
    pub const fn chip(&self) -> ChipState {
        self.chip
    }

    /// The plant, read-only.
    pub const fn plant(&self) -> &Plant {
        &self.plant
    }

    /// Sets the force of the finger and replaces the active faults.
    pub fn set_force_and_faults(
        &mut self,
        force_n: f64,
        faults: impl Iterator<Item = ActiveFault>,
    ) {
        self.plant.set_force(force_n);
        self.defects = ActiveDefects::default();
        for fault in faults {
            self.defects.add(&fault);
        }
        self.plant.set_defects(&self.defects.plant);
    }

    /// Sets the surface temperature of the skin that the skin thermistor lies beside, deg C; `None` for that on the display.
    pub fn set_skin_elsewhere(&mut self, skin_c: Option<f64>) {
        self.plant.set_skin_elsewhere(skin_c);
    }

    /// Sets force and faults to those of a scene at a time, s.
    pub fn apply_scene(&mut self, scene: &Scene, t_s: f64) {
        let faults = scene.faults.iter().filter_map(|fault| fault.at(t_s));
        self.set_force_and_faults(scene.force_n(t_s), faults);
    }

    /// Sets the test of the comparator by the device. The engine sets it after each tick; undriven lines are pulled low,
    /// which is no test.
    pub fn comparator_test(&mut self, test: ComparatorTest) {
        self.plant.comparator_test(test);
    }

    /// Sets the comparator's latch, as the microcontroller's reset line does.
    pub fn set_latch(&mut self) {
        self.plant.set_latch();
    }

    /// Connects the bridge's supply without a self-test, for what uses the world without a device.
    pub fn connect_supply(&mut self) {
        self.plant.connect_supply();
    }

    /// Whether the emergency stop is pressed.
    pub const fn emergency_stop(&self) -> bool {
        self.plant.emergency_stop()
    }

    /// Stuck level of the line that selects the side of the comparator's tests; `None` if the line is sound.
    pub const fn side_stuck(&self) -> Option<bool> {
        self.plant.side_stuck()
    }

    /// Advances the plant by one step with the bridge legs driven as given.
    pub fn step(&mut self, legs: BridgeOutputs) {
        self.plant.step(&legs);
        if let Some(ohm) = self.plant.load_ohm() {
            let current = self.plant.bridge_current();
            let mean_v = current.mean_a.abs() * ohm;
            if mean_v > self.pulse.mean_v {
                self.pulse = Pulse {
                    mean_v,
                    ripple_v: current.ripple_a2.sqrt() * ohm,
                    inductor_half_a: current.inductor.half_a,
                };
            }
        }
    }

    /// The largest pulse through a resistor in place of the tile.
    pub const fn pulse(&self) -> Pulse {
        self.pulse
    }

    /// Arms the oscilloscope for another pulse.
    pub fn forget_pulse(&mut self) {
        self.pulse = Pulse::default();
    }

    /// Replaces the defects of the plant.
    pub fn set_plant_defects(&mut self, defects: Defects) {
        self.defects = ActiveDefects { plant: defects, ..ActiveDefects::default() };
        self.plant.set_defects(&self.defects.plant);
    }

    /// The same world with this microcontroller, before its program starts.
    #[must_use]
    pub fn with_chip(self, chip: ChipState) -> Self {
        Self { chip, ..self }
    }

    /// Moves the device to another world. Its comparator's latch and its bridge supply stay as they are.
    pub fn move_to(&mut self, mut place: Self) {
        if !self.plant.supply_cut() {
            place.connect_supply();
        }
        *self = Self { chip: self.chip, ..place };
    }

    /// Code at the input of the heat-flux sensor at the end of the last step, 0 to 4095. A board without the sensor has the input
    /// at ground.
    pub fn flux_code(&self) -> u16 {
        self.plant.flux_code().unwrap_or(0)
    }

    /// Whether nFAULT is low, pulled by the bridge driver or the comparator.
    pub fn bridge_fault(&self) -> bool {
        self.plant.bridge_fault()
    }

    /// Converts a channel; a frozen channel repeats its last code.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        let code = self.plant.convert(channel);
        let index = channel as usize;
        if !self.defects.frozen[index] {
            self.codes[index] = code;
        }
        self.codes[index]
    }

    /// Converts all channels in scan order; the codes are those of [`convert`](Self::convert).
    pub fn convert_scan(&mut self) -> [u16; Channel::ALL.len()] {
        let codes = self.plant.convert_scan();
        for ((last, code), frozen) in self.codes.iter_mut().zip(codes).zip(self.defects.frozen) {
            if !frozen {
                *last = code;
            }
        }
        self.codes
    }
}
