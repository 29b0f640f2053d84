//! The line to a simulated device, in virtual time.

use std::collections::VecDeque;
use std::time::Duration;

use thermal_client::link::{LineSplitter, Link, LinkError, ReceivedLine};

use crate::World;
use crate::engine::Engine;
use crate::host::sending_half;

/// Runs a device for a millisecond, in which `bytes` are sent to it.
///
/// # Errors
/// The engine stopped.
pub fn run_1_ms<E: Engine>(engine: &mut E, bytes: &[u8]) -> Result<(), E::Stop> {
    let legs = engine.legs();
    for half in 0..2 {
        if !bytes.is_empty() && sending_half(bytes) == half {
            engine.send(bytes);
        }
        if half == 0 {
            engine.world().step(legs);
        }
        engine.run_half_ms()?;
    }
    Ok(())
}

/// Both directions of a line in virtual time, which passes only while its owner waits for lines.
#[derive(Debug, Default)]
pub struct VirtualLine {
    to_send: Vec<u8>,
    splitter: LineSplitter,
    received: VecDeque<ReceivedLine>,
    ms: u64,
}

impl VirtualLine {
    /// Keeps bytes for the next millisecond.
    pub fn send(&mut self, bytes: &[u8]) {
        self.to_send.extend(bytes);
    }

    /// Passes a millisecond. `run_1_ms` runs the device for it, which is sent the bytes of the first argument, and appends what
    /// the device has sent to the second.
    ///
    /// # Errors
    /// Those of `run_1_ms`.
    pub fn pass_1_ms<E>(
        &mut self,
        run_1_ms: impl FnOnce(&[u8], &mut Vec<u8>) -> Result<(), E>,
    ) -> Result<(), E> {
        let bytes = std::mem::take(&mut self.to_send);
        run_1_ms(&bytes, self.splitter.received())?;
        self.ms += 1;
        let at = self.now();
        let lines = self.splitter.complete().into_iter();
        self.received.extend(lines.map(|text| ReceivedLine { text, at }));
        Ok(())
    }

    /// The next line, or `None` after `timeout`, with `run_1_ms` as for [`Self::pass_1_ms`].
    ///
    /// # Errors
    /// Those of `run_1_ms`.
    pub fn receive(
        &mut self,
        timeout: Duration,
        mut run_1_ms: impl FnMut(&[u8], &mut Vec<u8>) -> Result<(), LinkError>,
    ) -> Result<Option<ReceivedLine>, LinkError> {
        let end = self.now() + timeout;
        while self.received.is_empty() && self.now() < end {
            self.pass_1_ms(&mut run_1_ms)?;
        }
        Ok(self.next_line())
    }

    /// Whether a line was received that nobody has taken.
    pub fn has_line(&self) -> bool {
        !self.received.is_empty()
    }

    /// The oldest received line.
    pub fn next_line(&mut self) -> Option<ReceivedLine> {
        self.received.pop_front()
    }

    /// Loses what is on the line in either direction. Time goes on.
    pub fn clear(&mut self) {
        *self = Self { ms: self.ms, ..Self::default() };
    }

    /// Milliseconds since the beginning.
    pub const fn ms(&self) -> u64 {
        self.ms
    }

    /// Time since the beginning.
    pub const fn now(&self) -> Duration {
        Duration::from_millis(self.ms)
    }
}

/// A line to the device of an engine. Time passes only while its owner waits for lines.
#[derive(Debug)]
pub struct SimulatedLink<'a, E> {
    engine: &'a mut E,
    line: VirtualLine,
}

impl<'a, E: Engine> SimulatedLink<'a, E> {
    /// A line to a device.
    pub fn new(engine: &'a mut E) -> Self {
        Self { engine, line: VirtualLine::default() }
    }

    /// The world around the device.
    pub fn world(&mut self) -> &mut World {
        self.engine.world()
    }
}

impl<E: Engine> Link for SimulatedLink<'_, E> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.line.send(bytes);
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let engine = &mut *self.engine;
        self.line.receive(timeout, |bytes, received| {
            run_1_ms(engine, bytes).map_err(|stop| LinkError::Gone(stop.to_string()))?;
            engine.receive(received);
            Ok(())
        })
    }

    fn now(&self) -> Duration {
        self.line.now()
    }
}
