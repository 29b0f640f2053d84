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

/// Interval at which a stream that is full is tried again.
const RETRY: Duration = Duration::from_millis(1);

/// Writes to a stream that does not block, as far as it takes the bytes within this time. Returns the number of bytes that
/// are lost; those of a stream that is closed are not counted.
pub fn write_or_lose(stream: &mut impl Write, mut bytes: &[u8], patience: Duration) -> usize {
    let begin = Instant::now();
    while !bytes.is_empty() {
        match stream.write(bytes) {
            Ok(written) => bytes = bytes.get(written..).unwrap_or_default(),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                if begin.elapsed() >= patience {
                    return bytes.len();
                }
                sleep(RETRY);
            }
            Err(_closed) => return 0,
        }
    }
    0
}

/// Says once for each client that it does not read.
#[derive(Debug, Default)]
pub struct LossNotice(bool);

impl LossNotice {
    /// Notes bytes that a client did not take, and returns their number.
    pub fn note(&mut self, lost: usize) -> usize {
        if lost > 0 && !std::mem::replace(&mut self.0, true) {
            eprintln!(
                "hil-sim: the client does not read; what the device sends is lost until it does"
            );
        }
        lost
    }
}
