//! A simulated device in real time.

use std::thread::sleep;
use std::time::{Duration, Instant};

use super::{Link, LinkError, ReceivedLine};

/// A line to a simulated device whose virtual time passes no faster than real time.
#[derive(Debug)]
pub struct PacedLink<L> {
    link: L,
    /// When the virtual time was zero.
    zero: Instant,
}

impl<L: Link> PacedLink<L> {
    /// Paces a line from now on.
    pub fn new(link: L) -> Self {
        let now = Instant::now();
        let zero = now.checked_sub(link.now()).unwrap_or(now);
        Self { link, zero }
    }
}

impl<L: Link> Link for PacedLink<L> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.link.send(bytes)
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let received = self.link.receive(timeout)?;
        sleep(self.link.now().saturating_sub(self.zero.elapsed()));
        Ok(received)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }
}
