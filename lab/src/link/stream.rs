//! Lines in real time: serial port and TCP.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::path::Path;
use std::time::{Duration, Instant};

use thermal_client::link::{LineSplitter, Link, LinkError, ReceivedLine};

use super::own_port::OwnPort;

/// Baud rate of the device.
const BAUD: u32 = 1_000_000;
/// Longest time in which bytes to the device must be taken.
const WRITE_TIMEOUT: Duration = Duration::from_secs(2);
/// Shortest wait for bytes; the operating systems know no shorter one.
const READ_TIMEOUT_MIN: Duration = Duration::from_millis(1);

/// A stream of bytes to and from a device.
pub trait Stream: Read + Write {
    /// Sets how long a read waits for the first byte.
    ///
    /// # Errors
    /// The operating system refuses.
    fn set_timeout(&mut self, timeout: Duration) -> io::Result<()>;
}

impl Stream for TcpStream {
    fn set_timeout(&mut self, timeout: Duration) -> io::Result<()> {
        self.set_read_timeout(Some(timeout))
    }
}

impl Stream for OwnPort {
    fn set_timeout(&mut self, timeout: Duration) -> io::Result<()> {
        self.set_read_timeout(timeout)
    }
}

/// A line to a device over a stream of bytes. Its clock begins when it is opened.
#[derive(Debug)]
pub struct StreamLink<S> {
    stream: S,
    splitter: LineSplitter,
    received: VecDeque<ReceivedLine>,
    opened: Instant,
}

/// Opens a serial port for this program alone, before a byte is written.
///
/// # Errors
/// There is no such port, it is in use, or it does not know the baud rate.
pub fn serial(name: &Path) -> io::Result<StreamLink<OwnPort>> {
    let mut port = OwnPort::open(name, BAUD)?;
    port.set_write_timeout(WRITE_TIMEOUT)?;
    port.discard_buffers()?;
    Ok(StreamLink::new(port))
}

/// Connects to a device by TCP.
///
/// # Errors
/// Nobody listens there.
pub fn tcp(address: impl ToSocketAddrs) -> io::Result<StreamLink<TcpStream>> {
    let stream = TcpStream::connect(address)?;
    // Lines are short, and each is waited for.
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
    Ok(StreamLink::new(stream))
}

impl<S: Stream> StreamLink<S> {
    /// A line over a stream.
    pub fn new(stream: S) -> Self {
        Self {
            stream,
            splitter: LineSplitter::default(),
            received: VecDeque::new(),
            opened: Instant::now(),
        }
    }

    /// Waits for bytes, at most `timeout`.
    fn read(&mut self, timeout: Duration) -> Result<(), LinkError> {
        let gone = |error: io::Error| LinkError::Gone(error.to_string());
        self.stream.set_timeout(timeout.max(READ_TIMEOUT_MIN)).map_err(gone)?;
        let mut bytes = [0; 4096];
        match self.stream.read(&mut bytes) {
            Ok(0) => return Err(LinkError::Gone("the other end has closed it".into())),
            Ok(count) => self.splitter.received().extend(&bytes[..count]),
            Err(error) => match error.kind() {
                ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                _ => return Err(gone(error)),
            },
        }
        let at = self.now();
        let lines = self.splitter.complete().into_iter();
        self.received.extend(lines.map(|text| ReceivedLine { text, at }));
        Ok(())
    }
}

impl<S: Stream> Link for StreamLink<S> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        let sent = self.stream.write_all(bytes);
        sent.and_then(|()| self.stream.flush()).map_err(|error| LinkError::Gone(error.to_string()))
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let end = self.now() + timeout;
        while self.received.is_empty() {
            self.read(end.saturating_sub(self.now()))?;
            if self.now() >= end {
                break;
            }
        }
        Ok(self.received.pop_front())
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }
}
