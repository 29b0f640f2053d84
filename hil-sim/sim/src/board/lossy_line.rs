//! A serial line that loses bytes.

use thermal_plant::bridge::BridgeOutputs;

use crate::World;
use crate::engine::{Cost, DeviceReset, Engine};
use crate::processor::{MachineFault, NotInjected};

/// An engine behind a line that loses one of so many bytes from the device.
#[derive(Debug)]
pub struct LossyLine<E> {
    engine: E,
    /// Interval of lost bytes; `None` for a sound line.
    interval: Option<u64>,
    sent: u64,
}

impl<E> LossyLine<E> {
    /// The line of a board to this engine.
    pub const fn new(engine: E, interval: Option<u64>) -> Self {
        Self { engine, interval, sent: 0 }
    }
}

impl<E: Engine> Engine for LossyLine<E> {
    type Stop = E::Stop;

    const NAME: &'static str = E::NAME;

    fn world(&mut self) -> &mut World {
        self.engine.world()
    }

    fn legs(&mut self) -> BridgeOutputs {
        self.engine.legs()
    }

    fn run_half_ms(&mut self) -> Result<(), E::Stop> {
        self.engine.run_half_ms()
    }

    fn send(&mut self, bytes: &[u8]) {
        self.engine.send(bytes);
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        let Some(interval) = self.interval else {
            return self.engine.receive(into);
        };
        let mut sent = Vec::new();
        self.engine.receive(&mut sent);
        for byte in sent {
            self.sent += 1;
            if !self.sent.is_multiple_of(interval) {
                into.push(byte);
            }
        }
    }

    fn inject(&mut self, fault: &MachineFault, after_us: u32) -> Result<(), NotInjected> {
        self.engine.inject(fault, after_us)
    }

    fn trigger(&mut self, after_us: u32) -> Result<(), Self::Stop> {
        self.engine.trigger(after_us)
    }

    fn resets(&self) -> Vec<DeviceReset> {
        self.engine.resets()
    }

    fn reset_cost(&mut self) {
        self.engine.reset_cost();
    }

    fn cost(&self) -> Option<Cost> {
        self.engine.cost()
    }
}
