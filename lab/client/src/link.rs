//! The line to a device: bytes to it, lines from it, and a clock.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Longest line from a device that is kept whole, bytes; what is longer is delivered in parts.
const LINE_MAX_BYTES: usize = 1024;

/// Time within which an interruption ends a wait.
const INTERRUPTED_WITHIN: Duration = Duration::from_millis(50);

/// A line to a device. Its clock is its own, so that a simulated device runs in virtual time and a real one in real time.
pub trait Link {
    /// Sends bytes.
    ///
    /// # Errors
    /// The device can no longer be reached.
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError>;

    /// Waits for the next line from the device, at most `timeout` by the link's clock; `None` if there is none.
    ///
    /// # Errors
    /// The device can no longer be reached, or the wait was interrupted.
    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError>;

    /// Time by the link's clock, from an arbitrary zero on; it never goes back.
    fn now(&self) -> Duration;
}

/// A line from a device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReceivedLine {
    /// The line without its end; bytes that are no text are replaced.
    pub text: String,
    /// Time by the link's clock at which its end was received.
    pub at: Duration,
}

/// Why a link does not work.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// The device can no longer be reached, for this reason.
    #[error("the link to the device is gone: {0}")]
    Gone(String),
    /// The person or program at this end has ended the wait. The link still works.
    #[error("interrupted")]
    Interrupted,
}

/// A link whose waits a person can end, as by Ctrl-C. It works on afterwards, so that the bridge can be switched off.
#[derive(Debug)]
pub struct Interruptible<L> {
    link: L,
    requested: Arc<AtomicBool>,
}

impl<L> Interruptible<L> {
    /// A link whose present or next wait ends with [`LinkError::Interrupted`] whenever `requested` is set.
    pub const fn new(link: L, requested: Arc<AtomicBool>) -> Self {
        Self { link, requested }
    }

    /// The link.
    pub const fn inner(&mut self) -> &mut L {
        &mut self.link
    }
}

impl<L: Link> Link for Interruptible<L> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.link.send(bytes)
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let end = self.link.now() + timeout;
        loop {
            if self.requested.swap(false, Ordering::Relaxed) {
                return Err(LinkError::Interrupted);
            }
            let rest = end.saturating_sub(self.link.now());
            let received = self.link.receive(rest.min(INTERRUPTED_WITHIN))?;
            if received.is_some() || self.link.now() >= end {
                return Ok(received);
            }
        }
    }

    fn now(&self) -> Duration {
        self.link.now()
    }
}

impl<L: Link + ?Sized> Link for Box<L> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        (**self).send(bytes)
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        (**self).receive(timeout)
    }

    fn now(&self) -> Duration {
        (**self).now()
    }
}

/// Splits received bytes into lines.
#[derive(Clone, Debug, Default)]
pub struct LineSplitter(Vec<u8>);

impl LineSplitter {
    /// The buffer to which received bytes are appended.
    pub const fn received(&mut self) -> &mut Vec<u8> {
        &mut self.0
    }

    /// Removes and returns the complete lines, without line ends. A line without an end is returned in parts, so that a
    /// device that sends none cannot fill the memory.
    pub fn complete(&mut self) -> Vec<String> {
        let end = self.0.iter().rposition(|byte| *byte == b'\n');
        let end = end.map_or(0, |end| end + 1);
        let end = if self.0.len() - end > LINE_MAX_BYTES { self.0.len() } else { end };
        if end == 0 {
            return Vec::new();
        }
        let rest = self.0.split_off(end);
        let complete = std::mem::replace(&mut self.0, rest);
        let lines = complete.strip_suffix(b"\n").unwrap_or(&complete).split(|byte| *byte == b'\n');
        lines.map(|line| String::from_utf8_lossy(line.trim_ascii_end()).into_owned()).collect()
    }
}
