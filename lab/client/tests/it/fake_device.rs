//! A device that a test scripts.

use std::collections::VecDeque;
use std::time::Duration;

use thermal_client::client::Client;
use thermal_client::link::{LineSplitter, Link, LinkError, ReceivedLine};

/// What the device sends for a line: delays, ms, and texts.
type Script = Box<dyn FnMut(&str) -> Vec<(u64, String)>>;

/// A link to a device that answers as its script says. Its time passes while somebody waits.
pub struct FakeDevice {
    script: Script,
    splitter: LineSplitter,
    queue: VecDeque<(Duration, String)>,
    now: Duration,
    /// Lines that were sent to it, with their times.
    pub sent: Vec<(Duration, String)>,
    /// Time at which the link vanishes.
    pub vanishes_at: Option<Duration>,
}

impl FakeDevice {
    pub fn client(script: impl FnMut(&str) -> Vec<(u64, String)> + 'static) -> Client<Self> {
        Client::new(Self {
            script: Box::new(script),
            splitter: LineSplitter::default(),
            queue: VecDeque::new(),
            now: Duration::ZERO,
            sent: Vec::new(),
            vanishes_at: None,
        })
    }

    /// Lets the device send a line after some milliseconds.
    pub fn sends(&mut self, after_ms: u64, text: &str) {
        let at = self.now + Duration::from_millis(after_ms);
        let place = self.queue.partition_point(|(other, _)| *other <= at);
        self.queue.insert(place, (at, text.into()));
    }

    /// Blank lines that were sent to it, ms.
    pub fn blank_ms(&self) -> Vec<u128> {
        let blank = self.sent.iter().filter(|(_, line)| line.is_empty());
        blank.map(|(at, _)| at.as_millis()).collect()
    }
}

impl Link for FakeDevice {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.splitter.received().extend(bytes);
        for line in self.splitter.complete() {
            for (after_ms, text) in (self.script)(&line) {
                self.sends(after_ms, &text);
            }
            self.sent.push((self.now, line));
        }
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let end = self.now + timeout;
        if let Some(at) = self.vanishes_at.filter(|at| *at <= end) {
            self.now = at.max(self.now);
            return Err(LinkError::Gone("unplugged".into()));
        }
        let next = self.queue.pop_front_if(|(at, _)| *at <= end);
        self.now = next.as_ref().map_or(end, |(at, _)| (*at).max(self.now));
        Ok(next.map(|(at, text)| ReceivedLine { text, at }))
    }

    fn now(&self) -> Duration {
        self.now
    }
}

/// An answer after a millisecond.
pub fn answers(text: &str) -> Vec<(u64, String)> {
    vec![(1, text.into())]
}

/// A device that knows what follows; it answers every other line as the real one answers an unknown command.
pub fn knows(known: &'static [(&'static str, &'static str)]) -> Client<FakeDevice> {
    FakeDevice::client(move |line| {
        if line.is_empty() {
            return Vec::new();
        }
        match known.iter().find(|(known, _)| *known == line) {
            Some((_, answer)) => answers(answer),
            None => answers(&format!("err unknown command '{line}'; known: id state")),
        }
    })
}
