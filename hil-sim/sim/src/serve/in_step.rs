//! Serves a device whose time another program rules, by the line to its surroundings.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{sleep, yield_now};
use std::time::{Duration, Instant};

use super::{BYTES_PER_MS, ClientLine, Clock};
use crate::commissioning::{SimulatedSurroundings, SurroundingsAction};
use crate::engine::Engine;
use crate::simulated_link::run_1_ms;

/// Longest real time for bytes of the client to arrive, and for it to take those of the device.
const PATIENCE: Duration = Duration::from_secs(5);
/// Interval at which the lines are looked at while nothing arrives, and how long nothing must have arrived.
const IDLE: Duration = Duration::from_millis(1);
const BUSY: Duration = Duration::from_millis(5);
/// Longest line to the surroundings, bytes.
const LINE_MAX_BYTES: usize = 96;

/// Serves a device in its place of use until `stop` is set. Its time stands still until a client of the surroundings is
/// connected, passes as that client says, and as the clock says after it has gone.
///
/// # Errors
/// The device did something that is not modelled.
pub fn serve_in_step<E: Engine>(
    engine: &mut E,
    surroundings: &mut SimulatedSurroundings,
    [device_line, surroundings_line]: [&mut dyn ClientLine; 2],
    clock: &mut Clock,
    stop: &AtomicBool,
) -> Result<(), E::Stop> {
    let mut device =
        InStep { engine, line: device_line, client: None, taken: 0, written: 0, ms: 0 };
    let mut received = Vec::new();
    // Whether a client of the surroundings has been there.
    let mut begun = false;
    let mut idle = Idle(Instant::now());
    while !stop.load(Ordering::Relaxed) {
        if surroundings_line.poll().is_none() {
            received.clear();
            let due = begun && clock.wait_for_next_ms(device.client.is_some());
            device.poll();
            if due {
                let bytes = device.line.read(BYTES_PER_MS);
                device.taken += bytes.len() as u64;
                device.run_1_ms(&bytes, Duration::ZERO)?;
            } else if !begun {
                idle.wait();
            }
            continue;
        }
        begun = true;
        received.extend(surroundings_line.read(LINE_MAX_BYTES));
        let Some(line) = next_line(&mut received) else {
            device.poll();
            idle.wait();
            continue;
        };
        let answer = match surroundings.execute(&line, device.engine.world()) {
            Ok(SurroundingsAction::Answer(answer)) => answer,
            Ok(SurroundingsAction::Wait { ms, sent }) => {
                clock.resume();
                device.wait(ms, sent, clock, stop)?
            }
            Err(why) => format!("err {why}"),
        };
        surroundings_line.write(format!("{answer}\n").as_bytes(), PATIENCE);
        idle = Idle(Instant::now());
        clock.resume();
    }
    Ok(())
}

/// Waits while nothing arrives. A client that lets time pass by single milliseconds sends a line every 20 us, so the first
/// waits only let other programs run.
struct Idle(Instant);

impl Idle {
    fn wait(&self) {
        if self.0.elapsed() < BUSY {
            yield_now();
        } else {
            sleep(IDLE);
        }
    }
}

/// Removes and returns the first line, without its end. One that is too long is returned as far as it has come, to be refused.
fn next_line(received: &mut Vec<u8>) -> Option<String> {
    let end = received.iter().position(|byte| *byte == b'\n');
    let end = end.or_else(|| received.len().checked_sub(1).filter(|end| *end >= LINE_MAX_BYTES))?;
    let line: Vec<u8> = received.drain(..=end).collect();
    Some(String::from_utf8_lossy(&line).trim_end().into())
}

/// The device, its line, and what the present client has exchanged on it.
struct InStep<'a, E> {
    engine: &'a mut E,
    line: &'a mut dyn ClientLine,
    client: Option<u64>,
    /// Bytes of the client that the device was given, and bytes of the device that the client was.
    taken: u64,
    written: u64,
    /// Time since power-up.
    ms: u64,
}

impl<E: Engine> InStep<'_, E> {
    /// Looks for another client.
    fn poll(&mut self) {
        let client = self.line.poll();
        if client != self.client {
            // What the last client has sent is on its way to the device.
            let rest = self.line.read(usize::MAX);
            if !rest.is_empty() {
                self.engine.send(&rest);
            }
            (self.client, self.taken, self.written) = (client, 0, 0);
        }
    }

    fn run_1_ms(&mut self, bytes: &[u8], patience: Duration) -> Result<usize, E::Stop> {
        run_1_ms(self.engine, bytes)?;
        self.ms += 1;
        let mut sent = Vec::new();
        self.engine.receive(&mut sent);
        let lost = self.line.write(&sent, patience);
        self.written += (sent.len() - lost) as u64;
        Ok(lost)
    }

    /// Lets `ms` milliseconds pass when the client has sent `sent` bytes in all; returns the answer.
    fn wait(
        &mut self,
        ms: u64,
        sent: u64,
        clock: &mut Clock,
        stop: &AtomicBool,
    ) -> Result<String, E::Stop> {
        let mut bytes = Vec::new();
        let idle = Idle(Instant::now());
        loop {
            self.poll();
            let missing = sent.saturating_sub(self.taken);
            let arrived = self.line.read(missing.try_into().unwrap_or(usize::MAX));
            self.taken += arrived.len() as u64;
            bytes.extend(arrived);
            if self.taken >= sent {
                break;
            }
            if idle.0.elapsed() > PATIENCE || stop.load(Ordering::Relaxed) {
                let taken = self.taken;
                return Ok(format!(
                    "err {taken} of {sent} bytes have arrived from the client of the device"
                ));
            }
            idle.wait();
        }
        for _ in 0..ms {
            clock.wait_for_next_ms(true);
            let lost = self.run_1_ms(&bytes, PATIENCE)?;
            bytes.clear();
            if lost > 0 || stop.load(Ordering::Relaxed) {
                return Ok("err the client of the device does not read".into());
            }
        }
        Ok(format!("ok {} {}", self.ms, self.written))
    }
}
