#![doc = include_str!("../README.md")]

pub mod bridge;
pub mod comparator;
mod config;
pub mod contact;
mod defects;
pub mod energy;
pub mod finger;
pub mod infrared;
pub mod lone_finger;
pub mod object;
pub mod parameters;
pub mod reference;
mod sample;
pub mod sensors;
pub mod slab;
mod substeps;
pub mod supply;
pub mod thermal;
pub mod tile;
mod tr_bdf2;

use bridge::{Bridge, BridgeOutputs, Current, InductorRipple, Load, Output};
use comparator::{Comparator, ComparatorTest};
pub use config::{ConfigError, HostParams, Params, PlantConfig};
use contact::{ContactLaw, SkinContact};
use contact_model::material::Surface;
pub use defects::Defects;
use energy::Energy;
use finger::Vessels;
pub use sample::SampleTouch;
use sensors::{BONDED, CHANNELS, Channel, FluxSensor, SensorInputs, SensorReadings, Sensors};
use slab::{DepthProbe, Grading, Slab, steady_state};
use supply::Supply;
pub use thermal::Finger;
use thermal::ThermalModel;
use tile::Tile;

/// Step of the plant, s; bridge outputs and force are constant within it.
pub const STEP_S: f64 = 1e-3;

/// Depths of the cold and warm receptors, m (thesis, section 2.2: 0.15 to 0.17 mm, 0.3 to 0.6 mm).
pub const RECEPTORS_M: [f64; 2] = [0.16e-3, 0.45e-3];

/// Simulated hardware of one finger.
#[derive(Clone, Debug)]
pub struct Plant {
    start_s: f64,
    appears_s: f64,
    object_start_c: f64,
    skin_before_c: f64,
    room_c: f64,
    surfaces: Surfaces,
    contact_law: ContactLaw,
    resistance_factor: f64,
    vessels: Option<Vessels>,
    bridge: Bridge,
    /// Current out of the bridge in the last step.
    bridge_current: Current,
    /// Nominal voltage of the source, V.
    source_v: f64,
    supply: Supply,
    comparator: Comparator,
    /// Fraction of the inductors' ripple behind the filters of the current measurement.
    ripple_share: f64,
    defects: Defects,
    heat: ThermalModel,
    receptors: [Option<DepthProbe>; RECEPTORS_M.len()],
    sensors: Sensors,
    /// Heat-flux sensor on the display, if it is fitted.
    flux: Option<FluxSensor>,
    /// Surface temperature of the skin beside the skin thermistor, deg C, if it is not that on the display.
    skin_elsewhere_c: Option<f64>,
    /// Number of steps made.
    steps: u64,
    force_n: f64,
    /// Force, N, and presence of the object for which the contacts were last updated.
    contact_state: Option<(f64, bool)>,
    on_display: Option<SkinContact>,
    on_object: Option<SkinContact>,
    /// Number of steps since the last abrupt change of contact.
    steps_since_change: u32,
}

/// Surfaces in contact.
#[derive(Clone, Copy, Debug)]
struct Surfaces {
    skin: Surface,
    display: Surface,
    object: Surface,
}

impl Plant {
    /// A plant in steady state without current: finger without contact, tile and sink at the temperature of the coolant.
    ///
    /// # Errors
    /// If the configuration does not pass its [check](PlantConfig::check).
    pub fn new(config: &PlantConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let params = &config.params;
        let simulated_s = config.duration_s - config.start_s;
        let mesh =
            |layers: &[slab::Layer], back| Slab::new(layers, back, simulated_s, &Grading::STANDARD);
        let finger = mesh(&params.finger.layers, params.finger.back());
        let object = mesh(&config.object.layers, config.object.back);
        let air_w_m2k = params.finger.air_w_m2k;
        let steady =
            steady_state(&finger, config.skin_c, air_w_m2k * (config.skin_c - config.room_c))
                .ok_or_else(|| ConfigError::cold_finger(air_w_m2k))?;
        config::check_core(steady.core_c)?;
        let mut heat = ThermalModel::new(
            (&finger, config.skin_c),
            (&object, config.object.start_c),
            Tile::new(params.tile, config.room_c),
            (air_w_m2k, config.room_c),
            STEP_S,
        );
        heat.set_finger_at_rest(&steady);
        let at_rest = SensorInputs {
            display_c: heat.display_c(),
            sink_c: heat.tile().sink_c(),
            skin_before_c: config.skin_c,
            skin_c: config.skin_c,
            room_c: config.room_c,
            force_n: 0.0,
            mirror_a: 0.0,
            mirror_ripple: InductorRipple::default(),
            supply_counts: 0.0,
        };
        let sensors = Sensors::new(params.sensors, &at_rest, config.seed);
        let flux = (params.flux)
            .map(|flux| FluxSensor::new(flux, air_flux_w_m2(&heat, config.room_c), config.seed));
        Ok(Self {
            start_s: config.start_s,
            appears_s: config.appears_s,
            object_start_c: config.object.start_c,
            skin_before_c: config.skin_c,
            room_c: config.room_c,
            surfaces: Surfaces {
                skin: params.finger.surface,
                display: params.display,
                object: config.object.surface,
            },
            contact_law: params.contact,
            resistance_factor: params.finger.resistance_factor,
            vessels: params.finger.vessels,
            bridge: Bridge::new(params.bridge, params.tile.resistance_ohm()),
            bridge_current: Current::default(),
            source_v: params.bridge.supply_v,
            supply: Supply::new(params.supply),
            ripple_share: (params.sensors.mirror).ripple_share(params.bridge.pwm_hz),
            comparator: Comparator::new(
                &params.comparator,
                &BONDED,
                sensors.pin_ratio(Channel::DisplayCheck as usize),
            ),
            defects: Defects::default(),
            heat,
            receptors: RECEPTORS_M.map(|depth_m| DepthProbe::at(&finger, depth_m)),
            sensors,
            flux,
            skin_elsewhere_c: None,
            steps: 0,
            force_n: 0.0,
            contact_state: None,
            on_display: None,
            on_object: None,
            steps_since_change: u32::MAX,
        })
    }

    /// Sets the force of the finger, N, from the next step on; zero and negative forces lift it.
    pub fn set_force(&mut self, force_n: f64) {
        self.force_n = force_n.max(0.0);
    }

    /// Sets the surface temperature of the skin that the skin thermistor lies beside, deg C, from the next step on: that of a
    /// finger which touches something else than this display. `None`: the finger is at this display.
    pub fn set_skin_elsewhere(&mut self, skin_c: Option<f64>) {
        self.skin_elsewhere_c = skin_c;
    }

    /// Sets the hardware defects from the next step on.
    pub fn set_defects(&mut self, defects: &Defects) {
        if self.defects == *defects {
            return;
        }
        self.defects = *defects;
        self.sensors.set_defects(&defects.sensors);
        self.supply.set_defects(&defects.supply);
        self.comparator.set_defects(&defects.comparator);
        self.heat.set_cooling(&defects.cooling);
        self.heat.set_module(defects.module);
        if let Some(flux) = &mut self.flux {
            flux.set_defect(defects.flux);
        }
    }

    /// Sets the test of the comparator.
    pub fn comparator_test(&mut self, test: ComparatorTest) {
        self.comparator.set_test(test);
    }

    /// Sets the comparator's latch, as the microcontroller's reset line does.
    pub fn set_latch(&mut self) {
        self.comparator.set_latch();
    }

    /// Clears the comparator's latch and connects the supply at once, as a passed self-test does in 80 ms. For what uses
    /// the plant without a device.
    pub fn connect_supply(&mut self) {
        self.comparator.clear();
        self.supply.set_node(self.source_v);
    }

    /// Whether the emergency stop's sense line reads as pressed.
    pub const fn emergency_stop(&self) -> bool {
        self.defects.supply.emergency_stop || self.defects.supply.stop_sense_open
    }

    /// Stuck level of the line that selects the side of the comparator's tests; `None` if the line is sound.
    pub const fn side_stuck(&self) -> Option<bool> {
        self.defects.comparator.side_stuck
    }

    /// Current out of the bridge in the last step.
    pub const fn bridge_current(&self) -> Current {
        self.bridge_current
    }

    /// The resistor in place of the tile, ohm, if there is one.
    pub const fn load_ohm(&self) -> Option<f64> {
        match self.defects.bridge.output {
            Output::Resistor(ohm) => Some(ohm),
            Output::Tile | Output::Open => None,
        }
    }

    /// Voltage of the bridge's supply behind its switch, V.
    pub const fn supply_v(&self) -> f64 {
        self.supply.node_v()
    }

    /// Sensed voltage of the bridge's supply behind its switch, V.
    pub fn sensed_supply_v(&self) -> f64 {
        self.supply.sensed_v()
    }

    /// Reseeds the noise of the A/D converters; their non-linearity, which belongs to the device, stays.
    pub fn reseed_noise(&mut self, seed: u64) {
        self.sensors.reseed_noise(seed);
        if let Some(flux) = &mut self.flux {
            flux.reseed_noise(seed);
        }
    }

    /// Advances by [`STEP_S`] under constant bridge outputs.
    pub fn step(&mut self, legs: &BridgeOutputs) {
        self.update_contacts();
        let source_v = self.defects.bridge.supply_v.unwrap_or(self.source_v);
        let taken_a = self.bridge_current.supply_a;
        (self.supply).step(STEP_S, source_v, self.comparator.tripped(), taken_a);
        // Without its driver the bridge carries no current: the Seebeck voltage stays below that of two diodes.
        let legs = if self.supply.driver_is_on() {
            self.bridge.set_supply(self.supply.node_v());
            self.defects.bridge.apply(legs)
        } else {
            BridgeOutputs::default()
        };
        let (tile_legs, load_ohm) = match self.defects.bridge.output {
            Output::Tile => (legs, None),
            Output::Open => (BridgeOutputs::default(), None),
            Output::Resistor(ohm) => (BridgeOutputs::default(), Some(ohm)),
        };
        let before_j = self.heat.energy().from_finger_j;
        for index in substeps::of_step(self.steps_since_change) {
            self.heat.step(index, &mut self.bridge, &tile_legs);
        }
        if let Some(flux) = &mut self.flux {
            let mean_w_m2 = match self.on_display {
                Some(contact) => {
                    let taken_j = self.heat.energy().from_finger_j - before_j;
                    taken_j / (contact.area_m2 * STEP_S)
                }
                None => air_flux_w_m2(&self.heat, self.room_c),
            };
            flux.step(STEP_S, mean_w_m2);
        }
        self.bridge_current = match load_ohm {
            None => self.heat.tile().current(),
            Some(resistance_ohm) => {
                let load = Load { seebeck_v: 0.0, resistance_ohm };
                self.bridge.current(STEP_S, &legs, &load)
            }
        };
        self.steps += 1;
        self.steps_since_change = self.steps_since_change.saturating_add(1);
        let current = self.bridge_current;
        let state = SensorInputs {
            display_c: self.display_c(),
            sink_c: self.sink_c(),
            skin_before_c: self.skin_before_c,
            skin_c: self.skin_elsewhere_c.unwrap_or_else(|| self.skin_c()),
            room_c: self.room_c,
            force_n: self.force_n,
            mirror_a: current.mean_a.abs(),
            mirror_ripple: InductorRipple {
                half_a: self.ripple_share * current.inductor.half_a,
                ..current.inductor
            },
            supply_counts: self.supply.sensed_counts(),
        };
        self.sensors.step(STEP_S, &state);
        self.comparator.step(STEP_S, self.sensors.pin_ratio(Channel::DisplayCheck as usize));
    }

    /// Updates the contacts for the force and the time of the coming step.
    fn update_contacts(&mut self) {
        // Half a step of tolerance, since the sum of steps is rounded.
        let present = self.time_s() + 0.5 * STEP_S > self.appears_s.max(0.0);
        let contact_state = Some((self.force_n, present));
        if self.contact_state == contact_state {
            return;
        }
        if present && !self.contact_state.is_some_and(|(_, present)| present) {
            // The object keeps its start temperature until it appears, whatever its back boundary is.
            self.heat.set_object(self.object_start_c);
            self.steps_since_change = 0;
        }
        self.contact_state = contact_state;
        let Surfaces { skin, display, object } = &self.surfaces;
        let at_force = |other| {
            let contact = self.contact_law.at_force(self.force_n, skin, other)?;
            Some(SkinContact {
                resistance_m2k_w: self.resistance_factor * contact.resistance_m2k_w,
                ..contact
            })
        };
        let layer_m2k_w = (self.flux.as_ref()).map_or(0.0, FluxSensor::resistance_m2k_w);
        let on_display = at_force(display).map(|contact| SkinContact {
            resistance_m2k_w: contact.resistance_m2k_w + layer_m2k_w,
            ..contact
        });
        let on_object = at_force(object).filter(|_| present);
        if contact::is_abrupt(self.on_display, on_display)
            || contact::is_abrupt(self.on_object, on_object)
        {
            self.steps_since_change = 0;
        }
        self.heat.set_contacts(on_display, on_object, present);
        (self.on_display, self.on_object) = (on_display, on_object);
        if let Some(vessels) = &self.vessels {
            self.heat.set_flow(vessels.flow(self.force_n));
        }
    }

    /// Converts one channel: the signal moves from its value at the start of the last step to that at its end.
    pub fn convert(&mut self, channel: Channel) -> u16 {
        self.sensors.convert(channel)
    }

    /// Converts all channels in scan order; the codes are those of [`convert`](Self::convert).
    pub fn convert_scan(&mut self) -> [u16; CHANNELS] {
        self.sensors.convert_scan()
    }

    /// Code of the heat-flux sensor at the end of the last step, 0 to 4095; none if it is not fitted. Its converter samples once
    /// a step.
    pub fn flux_code(&self) -> Option<u16> {
        self.flux.as_ref().map(FluxSensor::code)
    }

    /// Flux that the heat-flux sensor is under, mean of the last step, W/m2: out of the skin, or without contact out of the air,
    /// into the display. None if it is not fitted.
    pub fn flux_w_m2(&self) -> Option<f64> {
        self.flux.as_ref().map(FluxSensor::flux_w_m2)
    }

    /// Whether driver or comparator pull nFAULT low.
    pub fn bridge_fault(&self) -> bool {
        let driver = self.bridge.fault() || self.supply.driver_reports_low();
        (driver || self.comparator.tripped()) && !self.defects.bridge.fault_pin_dead
    }

    /// Whether the comparator has cut the bridge supply.
    pub const fn supply_cut(&self) -> bool {
        self.comparator.tripped()
    }

    /// Simulated time, s.
    pub fn time_s(&self) -> f64 {
        self.start_s + self.steps as f64 * STEP_S
    }

    /// Contact force of the finger, N.
    pub const fn force_n(&self) -> f64 {
        self.force_n
    }

    /// True surface temperature of the display, deg C; that of the plate's face under the heat-flux sensor, if it is fitted.
    pub fn display_c(&self) -> f64 {
        self.heat.display_c()
    }

    /// Surface temperature of the skin on the display, deg C.
    pub fn skin_c(&self) -> f64 {
        self.heat.skin_c(Finger::OnDisplay)
    }

    /// Surface temperature of the same skin on the real object, deg C.
    pub fn skin_real_c(&self) -> f64 {
        self.heat.skin_c(Finger::OnObject)
    }

    /// Skin temperature at the depth of the cold and warm receptors ([`RECEPTORS_M`]), deg C; none if the finger is
    /// thinner.
    pub fn receptors_c(&self, finger: Finger) -> [Option<f64>; RECEPTORS_M.len()] {
        let read = |probe: Option<DepthProbe>| probe.map(|probe| self.heat.depth_c(finger, &probe));
        self.receptors.map(read)
    }

    /// Surface temperature of a display on which the skin would be as warm as it is on the real object, deg C: that skin less
    /// the heat that flows into the object times the resistance between display and skin, the layer of a heat-flux sensor
    /// included. For half-spaces under a constant force, without that layer, this is Eq. 6-12. None in the step before a
    /// contact and without one.
    pub fn exact_display_c(&self) -> Option<f64> {
        let display = self.on_display?;
        let flux_w_m2 = self.heat.flux_w_m2(Finger::OnObject);
        Some(self.skin_real_c() - display.resistance_m2k_w * flux_w_m2)
    }

    /// Surface temperature of the real object, deg C; before it appears, that at which it will.
    pub fn object_c(&self) -> f64 {
        match self.contact_state {
            Some((_, true)) => self.heat.object_c(),
            _ => self.object_start_c,
        }
    }

    /// Temperature of the sink, deg C.
    pub fn sink_c(&self) -> f64 {
        self.heat.tile().sink_c()
    }

    /// Readings of the sensors before the A/D converter.
    pub fn sensor_readings(&self) -> SensorReadings {
        self.sensors.sensor_readings()
    }

    /// Current through the tile, A; positive cools the display.
    pub fn current_a(&self) -> f64 {
        self.heat.tile().current().mean_a
    }

    /// Energy that has crossed the boundaries of the tile since the start.
    pub fn energy(&self) -> Energy {
        self.heat.energy()
    }
}

/// Heat flux out of the air into the display where it is not touched, W/m2.
fn air_flux_w_m2(heat: &ThermalModel, room_c: f64) -> f64 {
    heat.tile().film_w_m2k() * (room_c - heat.display_c())
}

#[cfg(test)]
mod tests;
