//! A device that another program simulates and serves, in step with it: time passes only as this end says, so that a run has
//! the same result each time.

use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use thermal_client::commissioning::SurroundingsRequest;
use thermal_client::link::{LineSplitter, Link, LinkError, ReceivedLine};

use super::AskSurroundings;

/// Longest real time for a line of the server, which simulates a millisecond for it.
const TIMEOUT: Duration = Duration::from_secs(30);

/// A line to a served device, and the one to its surroundings. Its clock is that of the device since power-up.
#[derive(Debug)]
pub struct ServedLink {
    device: TcpStream,
    surroundings: BufReader<TcpStream>,
    /// Bytes sent to the device, and received from it.
    sent: u64,
    read: u64,
    ms: u64,
    splitter: LineSplitter,
    received: VecDeque<ReceivedLine>,
}

impl ServedLink {
    /// Connects to the device and to its surroundings.
    ///
    /// # Errors
    /// Nobody listens there.
    pub fn connect(
        device: impl ToSocketAddrs,
        surroundings: impl ToSocketAddrs,
    ) -> io::Result<Self> {
        let (device, surroundings) =
            (TcpStream::connect(device)?, TcpStream::connect(surroundings)?);
        for stream in [&device, &surroundings] {
            stream.set_nodelay(true)?;
            stream.set_read_timeout(Some(TIMEOUT))?;
        }
        Ok(Self {
            device,
            surroundings: BufReader::new(surroundings),
            sent: 0,
            read: 0,
            ms: 0,
            splitter: LineSplitter::default(),
            received: VecDeque::new(),
        })
    }

    /// Sends a line to the surroundings; returns the answer after `ok`.
    ///
    /// # Errors
    /// The surroundings refuse it, or the line is gone.
    pub fn request(&mut self, request: &SurroundingsRequest) -> Result<String, LinkError> {
        let mut answer = String::new();
        let line = format!("{request}\n");
        let sent = self.surroundings.get_mut().write_all(line.as_bytes());
        sent.and_then(|()| self.surroundings.read_line(&mut answer))
            .map_err(|error| LinkError::Gone(format!("surroundings: {error}")))?;
        match answer.trim_end().strip_prefix("ok") {
            Some(rest) => Ok(rest.trim().into()),
            None => Err(LinkError::Gone(format!(
                "the surroundings answer '{request}' with '{}'",
                answer.trim_end()
            ))),
        }
    }

    /// Lets a millisecond pass, and fetches what the device has sent in it.
    fn step(&mut self) -> Result<(), LinkError> {
        let wait = SurroundingsRequest::Wait { ms: 1, sent: self.sent };
        let answer = self.request(&wait)?;
        let numbers = answer.split_once(' ');
        let numbers = numbers.and_then(|(ms, written)| {
            Some((ms.parse::<u64>().ok()?, written.parse::<u64>().ok()?))
        });
        let (ms, written) = numbers.ok_or_else(|| {
            LinkError::Gone(format!("the surroundings answer '{wait}' with 'ok {answer}'"))
        })?;
        let new = written.saturating_sub(self.read);
        let fetched = (&mut self.device).take(new).read_to_end(self.splitter.received());
        match fetched {
            Ok(count) if count as u64 == new => {}
            Ok(_) => return Err(LinkError::Gone("the other end has closed it".into())),
            Err(error) => return Err(LinkError::Gone(error.to_string())),
        }
        (self.ms, self.read) = (ms, self.read + new);
        let at = self.now();
        let lines = self.splitter.complete().into_iter();
        self.received.extend(lines.map(|text| ReceivedLine { text, at }));
        Ok(())
    }
}

impl Link for ServedLink {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.device.write_all(bytes).map_err(|error| LinkError::Gone(error.to_string()))?;
        self.sent += bytes.len() as u64;
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let end = self.now() + timeout;
        while self.received.is_empty() && self.now() < end {
            self.step()?;
        }
        Ok(self.received.pop_front())
    }

    fn now(&self) -> Duration {
        Duration::from_millis(self.ms)
    }
}

impl AskSurroundings for ServedLink {
    fn ask_surroundings(&mut self, request: &SurroundingsRequest) -> Result<String, String> {
        self.request(request).map_err(|error| error.to_string())
    }
}
