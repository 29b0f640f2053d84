//! Serves a simulated device on a line to other programs, byte for byte.
//!
//! Time passes in steps of a millisecond: the bytes of the client that have arrived go to the device, device and plant run
//! for a millisecond, and what the device has sent goes to the client. The client gets as many bytes into the device as a
//! serial line carries, 100 each millisecond; the others wait, in bounded memory, and then in the operating system of the
//! client. What a client does not take in is lost, as on a serial line.

mod client;
mod clock;
mod device;
mod in_step;
#[cfg(unix)]
mod pty;
mod set_up;
mod tcp;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

pub use client::OutgoingBytes;
pub use clock::{Clock, Speed};
pub use device::{
    FiveFingers, OneFinger, ServeError, ServedDevice, read_scene, scenes_of_five_fingers,
};
pub use in_step::serve_in_step;
#[cfg(unix)]
pub use pty::PtyLine;
pub use set_up::set_up;
pub use tcp::{TcpLine, TcpLineError};

use crate::engine::BAUD;

/// Bytes that the serial line carries in a millisecond: a byte has ten bits.
const BYTES_PER_MS: usize = (BAUD / 10 / 1000) as usize;

/// A line as the operating system has it, with at most one client at a time.
pub trait ClientLine {
    /// Receives what has arrived, accepts and refuses clients. Returns the number of the client that is connected, counted
    /// from 1. Never waits.
    fn poll(&mut self) -> Option<u64>;

    /// The next bytes from the clients, at most `limit`.
    fn read(&mut self, limit: usize) -> Vec<u8>;

    /// Sends bytes to the client, which has this much time to take them. Returns how many it does not take; these are lost.
    fn write(&mut self, bytes: &[u8], patience: Duration) -> usize;
}

/// Serves a device until `stop` is set.
///
/// # Errors
/// The device did something that is not modelled.
pub fn serve<D: ServedDevice>(
    device: &mut D,
    line: &mut dyn ClientLine,
    clock: &mut Clock,
    stop: &AtomicBool,
) -> Result<(), D::Stop> {
    let mut sent = Vec::new();
    let mut connected = false;
    while !stop.load(Ordering::Relaxed) {
        let due = clock.wait_for_next_ms(connected);
        connected = line.poll().is_some();
        if !due {
            continue;
        }
        let bytes = line.read(BYTES_PER_MS);
        if !bytes.is_empty() {
            device.send(&bytes);
        }
        device.run_1_ms()?;
        device.receive(&mut sent);
        if !sent.is_empty() {
            line.write(&sent, Duration::ZERO);
            sent.clear();
        }
    }
    Ok(())
}
