//! Bodies in contact against exact solutions, energy conservation and the second law.

mod air;
mod energy;
mod first_moments;
mod interior_temperatures;
mod order_of_convergence;
mod rest;
mod second_law;
mod variants;

use contact_model::material::{Material, REFERENCE_DISPLAY, SKIN};

use super::*;
use crate::bridge::{BridgeParams, Leg};
use crate::contact::ContactLaw;
use crate::finger::FingerParams;
use crate::object::ObjectConfig;
use crate::slab::{Grading, steady_state};
use crate::tile::TileParams;

const STEP_S: f64 = crate::STEP_S;
const SKIN_C: f64 = 34.0;
const ROOM_C: f64 = 24.0;

/// Bodies, advanced by the sub-steps of the plant.
struct Bench {
    heat: ThermalModel,
    finger: Slab,
    object: Slab,
    bridge: Bridge,
    age: u32,
}

impl Bench {
    /// Bodies without contact, the finger in steady state in a room of 24 deg C.
    fn new(finger: &FingerParams, object: &ObjectConfig, tile: TileParams) -> Self {
        let cut = |layers: &[_], back| Slab::new(layers, back, 100.0, &Grading::STANDARD);
        let (slab, object_slab) =
            (cut(&finger.layers, finger.back()), cut(&object.layers, object.back));
        let loss_w_m2 = finger.air_w_m2k * (SKIN_C - ROOM_C);
        let steady = steady_state(&slab, SKIN_C, loss_w_m2).expect("a steady state");
        let mut heat = ThermalModel::new(
            (&slab, SKIN_C),
            (&object_slab, object.start_c),
            Tile::new(tile, ROOM_C),
            (finger.air_w_m2k, ROOM_C),
            STEP_S,
        );
        heat.set_finger_at_rest(&steady);
        Self {
            heat,
            finger: slab,
            object: object_slab,
            bridge: Bridge::new(BridgeParams::NOMINAL, tile.resistance_ohm()),
            age: u32::MAX,
        }
    }

    /// The thesis's finger and a half-space at the room's temperature.
    fn plain(material: &Material) -> Self {
        let object = ObjectConfig::half_space(*material, ROOM_C);
        Self::new(&FingerParams::homogeneous(), &object, TileParams::NOMINAL)
    }

    /// Sets both contacts and starts the sub-steps.
    fn touch(&mut self, on_display: Option<SkinContact>, on_object: Option<SkinContact>) {
        self.heat.set_contacts(on_display, on_object, true);
        self.age = 0;
    }

    /// One step with a voltage on the tile, or with the bridge off.
    fn step(&mut self, voltage_v: Option<f64>) {
        let legs = voltage_v.map_or_else(BridgeOutputs::default, |v| {
            let supply_v = 12.0;
            BridgeOutputs {
                a: Leg::Duty(1.0 - (-v).max(0.0) / supply_v),
                b: Leg::Duty(1.0 - v.max(0.0) / supply_v),
                enabled: true,
            }
        });
        for index in substeps::of_step(self.age) {
            self.heat.step(index, &mut self.bridge, &legs);
        }
        self.age = self.age.saturating_add(1);
    }
}

fn touch(material: &Material, force_n: f64) -> (Option<SkinContact>, Option<SkinContact>) {
    let under = |surface| ContactLaw::NOMINAL.at_force(force_n, &SKIN.surface, surface);
    (under(&REFERENCE_DISPLAY), under(&material.surface))
}
