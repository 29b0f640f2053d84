//! Five times the logic of one finger, each with a line to the host of its own.

use std::convert::Infallible;

use thermal_plant::bridge::BridgeOutputs;

use super::{FINGERS, Hand};
use crate::World;
use crate::engine::{Cost, DeviceReset, Engine, Lines, Native};

/// Five native devices of one finger.
#[derive(Debug)]
pub struct NativeHand {
    fingers: [Native; FINGERS],
    lines: [Lines; FINGERS],
    /// Lines that leave when the tick that runs is over.
    leaving: [Vec<u8>; FINGERS],
    /// Fingers that have reached their first boundary.
    started: usize,
}

impl NativeHand {
    /// Devices that are about to reach their first boundaries.
    #[must_use]
    pub fn new(worlds: [World; FINGERS]) -> Self {
        // Power-up finds the multiplexers settled on the first finger.
        let mut settled = true;
        Self {
            fingers: worlds
                .map(|world| Native::in_turn(world, std::mem::replace(&mut settled, false))),
            lines: Default::default(),
            leaving: Default::default(),
            started: 0,
        }
    }
}

impl Hand for NativeHand {
    type Stop = Infallible;

    const NAME: &'static str = Native::NAME;

    fn run_to(&mut self, finger: usize) -> Result<(), Infallible> {
        if self.started < FINGERS {
            self.started += 1;
            return Ok(());
        }
        let device = &mut self.fingers[finger];
        device.run_half_ms()?;
        device.run_half_ms()?;
        device.send(&std::mem::take(&mut self.leaving[finger]));
        Ok(())
    }

    fn world(&mut self, finger: usize) -> &mut World {
        self.fingers[finger].world()
    }

    fn legs(&mut self, finger: usize) -> BridgeOutputs {
        self.fingers[finger].legs()
    }

    fn send(&mut self, finger: usize, line: &[u8]) {
        self.leaving[finger].extend_from_slice(line);
    }

    fn receive(&mut self) -> Vec<(usize, String)> {
        let mut all = Vec::new();
        for (finger, (device, lines)) in self.fingers.iter_mut().zip(&mut self.lines).enumerate() {
            device.receive(lines.received());
            all.extend(lines.complete().into_iter().map(|line| (finger, line)));
        }
        all
    }

    fn resets(&self) -> Vec<DeviceReset> {
        self.fingers.iter().flat_map(Engine::resets).collect()
    }

    fn reset_cost(&mut self) {}

    fn cost(&self) -> Option<Cost> {
        None
    }
}
