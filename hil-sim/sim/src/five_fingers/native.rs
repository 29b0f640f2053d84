//! Five native engines of one finger, each with its own line to the host.

use std::convert::Infallible;

use thermal_plant::bridge::BridgeOutputs;

use super::{FINGERS, FiveFingerEngine};
use crate::World;
use crate::engine::{DeviceReset, Engine, LineSplitter, NativeEngine};

/// Five native engines of one finger.
#[derive(Debug)]
pub struct NativeFiveFingers {
    fingers: [NativeEngine; FINGERS],
    lines: [LineSplitter; FINGERS],
    /// Lines sent at the end of the present tick.
    pending_lines: [Vec<u8>; FINGERS],
    /// Number of fingers that have reached their first boundary.
    started: usize,
}

impl NativeFiveFingers {
    /// Devices just before their first boundaries.
    #[must_use]
    pub fn new(worlds: [World; FINGERS]) -> Self {
        // The multiplexers select the first finger at power-up.
        let mut settled = true;
        Self {
            fingers: worlds.map(|world| {
                NativeEngine::multiplexed(world, std::mem::replace(&mut settled, false))
            }),
            lines: Default::default(),
            pending_lines: Default::default(),
            started: 0,
        }
    }
}

impl FiveFingerEngine for NativeFiveFingers {
    type Stop = Infallible;

    const NAME: &'static str = NativeEngine::NAME;

    fn run_to(&mut self, finger: usize) -> Result<(), Infallible> {
        if self.started < FINGERS {
            self.started += 1;
            return Ok(());
        }
        let device = &mut self.fingers[finger];
        device.run_half_ms()?;
        device.run_half_ms()?;
        device.send(&std::mem::take(&mut self.pending_lines[finger]));
        Ok(())
    }

    fn world(&mut self, finger: usize) -> &mut World {
        self.fingers[finger].world()
    }

    fn legs(&mut self, finger: usize) -> BridgeOutputs {
        self.fingers[finger].legs()
    }

    fn send(&mut self, finger: usize, line: &[u8]) {
        self.pending_lines[finger].extend_from_slice(line);
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
}
