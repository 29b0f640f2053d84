//! The device's logic, called directly.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::fmt::Display;

use thermal_display::Hand;
use thermal_display::commission::{Desk, Order};
use thermal_display::drive::Drive;
use thermal_display::protocol::{Addressed, Error, LineReader, Reply};
use thermal_display::sense::{SCANS_PER_TICK, Samples, Scan};
use thermal_display::settings::{Settings, decode};

use super::{BAUD, Cost, Engine};
use crate::plant::bridge::{Leg, Legs};
use crate::plant::sensors::Channel;
use crate::world::World;

/// Nanoseconds of one half millisecond, of one byte on the line, and of the tick after the whole-millisecond
/// boundary that lies before it.
const HALF_NS: u64 = 500_000;
const BYTE_NS: u64 = 10 * 1_000_000_000 / BAUD;
const TICK_NS: u64 = 730_000;

/// Steps of the board's PWM period: 180 MHz / 96 kHz.
const PWM_STEPS: u16 = 1875;

/// Scans between the boundaries: four end the first step's tick, eight and four follow.
const SCANS_BEFORE_START: usize = 4;
const SCANS_IN_FIRST_HALF: usize = 8;

/// The logic of one finger without its microcontroller.
#[derive(Debug)]
pub struct Native {
    world: World,
    desk: Desk<1>,
    hand: Hand<1>,
    reader: LineReader,
    /// Bytes on their way to the device, and when they arrive.
    incoming: VecDeque<(u64, u8)>,
    outgoing: Vec<u8>,
    scans: [Scan; SCANS_PER_TICK],
    filled: usize,
    /// Scans before those of a tick that are made and left out, while multiplexers settle.
    settling_scans: usize,
    /// The bridge has pulled its fault pin since the last tick: the board's break flag keeps that.
    fault: bool,
    drive: Drive,
    /// Half milliseconds since the first boundary.
    halves: u64,
}

impl Native {
    /// A device that has just started its first tick.
    #[must_use]
    pub fn new(world: World) -> Self {
        Self::with(world, 0, 0)
    }

    /// One of several fingers that take turns on multiplexers: before the scans of a tick one is made that is left out.
    /// On the finger that power-up finds the multiplexers `settled` on it is two the first time, because there the first
    /// scan after a switch does not see the finger before.
    #[must_use]
    pub fn in_turn(world: World, settled: bool) -> Self {
        Self::with(world, 1, settled.into())
    }

    fn with(world: World, settling_scans: usize, more_at_first: usize) -> Self {
        let settings = Settings::default();
        let mut native = Self {
            world,
            desk: Desk::new(settings),
            hand: Hand::new(&settings),
            reader: LineReader::new(),
            incoming: VecDeque::new(),
            outgoing: Vec::new(),
            scans: [Scan::default(); SCANS_PER_TICK],
            filled: 0,
            settling_scans,
            fault: false,
            drive: Drive::Off,
            halves: 0,
        };
        native.settle(more_at_first);
        native.begin();
        native
    }

    /// Converts and leaves out.
    fn settle(&mut self, scans: usize) {
        for _ in 0..scans {
            let _unsettled = Channel::ALL.map(|channel| self.world.convert(channel));
        }
    }

    /// The first scans of a tick.
    fn begin(&mut self) {
        self.settle(self.settling_scans);
        self.filled = 0;
        self.scan(SCANS_BEFORE_START);
    }

    fn scan(&mut self, count: usize) {
        for scan in &mut self.scans[self.filled..self.filled + count] {
            *scan = Channel::ALL.map(|channel| self.world.convert(channel));
        }
        self.filled += count;
    }

    fn answer(&mut self, line: &dyn Display) {
        self.outgoing.extend(format!("{line}\n").into_bytes());
    }

    /// Starts anew, with what is stored by then; how long that takes is left out.
    fn restart(&mut self, order: Order) {
        let kept = decode(&self.desk.record(order)).ok().flatten();
        self.hand = Hand::new(&Settings::default());
        self.desk = match &kept {
            Some(kept) => {
                self.hand.restore(kept);
                Desk::restored(kept)
            }
            None => Desk::new(Settings::default()),
        };
        self.drive = Drive::Off;
    }

    /// Lines whose last byte has arrived before the tick.
    fn serve(&mut self, now_ns: u64) {
        while let Some((_, byte)) = self.incoming.pop_front_if(|(at, _)| *at <= now_ns) {
            let Some(line) = self.reader.push(byte) else {
                continue;
            };
            let executed = line
                .map_err(|error| Addressed::device(Error::from(error)))
                .and_then(|line| self.desk.answer(&line, |request| self.hand.execute(request)));
            if let Ok(Addressed {
                said: Reply::Restart(order),
                ..
            }) = &executed
            {
                self.restart(*order);
            }
            match executed {
                Ok(reply) => self.answer(&reply),
                Err(error) => self.answer(&error),
            }
        }
    }
}

impl Engine for Native {
    type Stop = Infallible;

    const NAME: &'static str = "native";

    fn world(&mut self) -> &mut World {
        &mut self.world
    }

    fn legs(&mut self) -> Legs {
        match self.drive {
            Drive::Off => Legs::default(),
            Drive::On(duty) => {
                let (a, b) = duty.legs(PWM_STEPS);
                let leg = |part: u16| Leg::Duty(f64::from(part) / f64::from(PWM_STEPS));
                Legs {
                    a: leg(a),
                    b: leg(b),
                    enabled: true,
                }
            }
        }
    }

    fn run_half_ms(&mut self) -> Result<(), Infallible> {
        self.fault |= self.world.bridge_fault();
        if self.halves.is_multiple_of(2) {
            self.scan(SCANS_IN_FIRST_HALF);
        } else {
            self.scan(SCANS_PER_TICK - self.filled);
            let tick_ns = (self.halves - 1) * HALF_NS + TICK_NS;
            self.serve(tick_ns);
            let samples = Samples::from_scans(&self.scans, self.fault);
            self.fault = self.world.bridge_fault();
            self.drive = self.hand.step(0, &samples);
            if let Some(telemetry) = self.hand.telemetry(0) {
                self.answer(&telemetry);
            }
            self.begin();
        }
        self.halves += 1;
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) {
        let mut at = self.halves * HALF_NS;
        if let Some((last, _)) = self.incoming.back() {
            at = at.max(*last);
        }
        for &byte in bytes {
            at += BYTE_NS;
            self.incoming.push_back((at, byte));
        }
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        into.append(&mut self.outgoing);
    }

    fn reset_cost(&mut self) {}

    fn cost(&self) -> Option<Cost> {
        None
    }
}
