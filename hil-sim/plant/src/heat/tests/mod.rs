//! Bodies in contact: against exact solutions, conservation laws and the second law.

mod air;
mod energy;
mod first_moments;
mod interior;
mod order;
mod second_law;
mod variants;

use contact_model::material::{Material, REFERENCE_DISPLAY, SKIN};

use super::*;
use crate::bridge::{BridgeParams, Leg};
use crate::finger::FingerParams;
use crate::object::ObjectConfig;
use crate::slab::{Grading, equilibrium};
use crate::tile::TileParams;

const STEP_S: f64 = crate::STEP_S;
const SKIN_C: f64 = 34.0;
const ROOM_C: f64 = 24.0;

/// Bodies, stepped as a plant steps them.
struct Bench {
    heat: Heat,
    finger: Slab,
    object: Slab,
    bridge: Bridge,
    age: u32,
}

impl Bench {
    /// Apart; the finger in equilibrium with a room of 24 deg C, which object and tile share.
    fn new(finger: &FingerParams, object: &ObjectConfig, tile: TileParams) -> Self {
        let cut = |layers: &[_], back| Slab::new(layers, back, 100.0, &Grading::RUN);
        let (slab, object_slab) = (
            cut(&finger.layers, finger.back()),
            cut(&[object.layer()], object.back),
        );
        let loss_w_m2 = finger.air_w_m2k * (SKIN_C - ROOM_C);
        let rest = equilibrium(&slab, SKIN_C, loss_w_m2).expect("something keeps it warm");
        let mut heat = Heat::new(
            (&slab, SKIN_C),
            (&object_slab, object.start_c),
            Tile::new(tile, ROOM_C),
            (finger.air_w_m2k, ROOM_C),
            STEP_S,
        );
        heat.rest_finger(&rest.node_c, rest.core_c);
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
        Self::new(&FingerParams::homogeneous(), &object, TileParams::CLASS)
    }

    /// Presses finger on display and on object.
    fn touch(&mut self, on_display: Option<Touch>, on_object: Option<Touch>) {
        self.heat.touch(on_display, on_object, true);
        self.age = 0;
    }

    /// One step; a voltage on the tile, or none.
    fn step(&mut self, voltage_v: Option<f64>) {
        let legs = voltage_v.map_or_else(Legs::default, |v| {
            let supply_v = 12.0;
            Legs {
                a: Leg::Duty(1.0 - (-v).max(0.0) / supply_v),
                b: Leg::Duty(1.0 - v.max(0.0) / supply_v),
                enabled: true,
            }
        });
        for index in schedule::sub_steps(self.age) {
            self.heat.step(index, &mut self.bridge, &legs);
        }
        self.age = self.age.saturating_add(1);
    }
}

fn touch(material: &Material, force_n: f64) -> (Option<Touch>, Option<Touch>) {
    let under = |surface| Touch::under(force_n, &SKIN.surface, surface);
    (under(&REFERENCE_DISPLAY), under(&material.surface))
}
