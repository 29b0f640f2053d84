//! Streams of clients, which never make the device wait.

use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Write};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Bytes that may wait for the device, beyond which a client's bytes wait at the client.
const WAITING_MAX: usize = 4096;

/// Bytes from clients that wait for the device, in order.
#[derive(Debug, Default)]
pub struct IncomingBytes(VecDeque<u8>);

impl IncomingBytes {
    /// Receives what has arrived from a stream that does not block, as far as there is room. Returns whether the stream is
    /// open.
    pub fn receive(&mut self, stream: &mut impl Read) -> bool {
        let mut bytes = [0; WAITING_MAX];
        loop {
            let room = WAITING_MAX - self.0.len();
            if room == 0 {
                return true;
            }
            match stream.read(&mut bytes[..room]) {
                Ok(0) => return false,
                Ok(received) => self.0.extend(&bytes[..received]),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return error.kind() == ErrorKind::WouldBlock,
            }
        }
    }

    /// Removes and returns the next bytes, at most `limit`.
    pub fn take(&mut self, limit: usize) -> Vec<u8> {
        self.0.drain(..limit.min(self.0.len())).collect()
    }
}

/// Bytes that wait for a client: 0.6 s of a full line. A serial port has about as many, a pseudo-terminal 4 KiB.
const UNREAD_MAX: usize = 65_536;
/// Interval at which a stream that is full is tried again.
const RETRY: Duration = Duration::from_millis(1);

/// Bytes of the device that its client has not taken yet, in order.
#[derive(Debug, Default)]
pub struct OutgoingBytes {
    unread: VecDeque<u8>,
    notice: LossNotice,
}

impl OutgoingBytes {
    /// Sends bytes on a stream that does not block, after those that wait. What there is no room for within this time is lost;
    /// returns the number of bytes that are.
    pub fn send(&mut self, stream: &mut impl Write, bytes: &[u8], patience: Duration) -> usize {
        let begin = Instant::now();
        self.unread.extend(bytes);
        self.flush(stream);
        while self.unread.len() > UNREAD_MAX && begin.elapsed() < patience {
            sleep(RETRY);
            self.flush(stream);
        }
        let lost = self.unread.len().saturating_sub(UNREAD_MAX);
        self.unread.truncate(UNREAD_MAX);
        self.notice.note(lost);
        lost
    }

    /// Writes what waits, as far as the stream takes it. Nothing waits for a stream that is closed.
    pub fn flush(&mut self, stream: &mut impl Write) {
        while !self.unread.is_empty() {
            match stream.write(self.unread.as_slices().0) {
                Ok(written) => drop(self.unread.drain(..written)),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                Err(_closed) => self.unread.clear(),
            }
        }
    }
}

/// Says once for each client that it does not read.
#[derive(Debug, Default)]
struct LossNotice(bool);

impl LossNotice {
    fn note(&mut self, lost: usize) {
        if lost > 0 && !std::mem::replace(&mut self.0, true) {
            eprintln!(
                "hil-sim: the client does not read; what the device sends is lost until it does"
            );
        }
    }
}
