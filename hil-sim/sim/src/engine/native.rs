//! The native engine: calls the logic of the device directly.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::fmt::Display;

use thermal_commissioning::StorageOrder;
use thermal_device::command::WithSourceFinger;
use thermal_device::drive::{BoardOutputs, ComparatorTest, Drive};
use thermal_device::safety::{Fault, ThermalDose, TripCause};
use thermal_device::sense::{DigitalInputs, SCANS_PER_TICK, Samples, Scan};
use thermal_device::{
    Device, FingerIndex, PWM_PERIOD_STEPS_OF_FIVE_FINGERS, PWM_PERIOD_STEPS_OF_ONE_FINGER,
};
use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::comparator::ComparatorTest as PlantTest;
use thermal_plant::sensors::Channel;
use thermal_protocol::{
    CommandHandler, Error, LineReader, OutgoingLine, Reply, wrap_as_telemetry_line,
};
use thermal_settings::{Settings, StoredSettings, decode_settings_record};

use super::{BAUD, DeviceReset, Engine};
use crate::World;
use crate::processor::{MachineFault, NotInjected, ResetCause};

/// Nanoseconds of one half millisecond, of one byte on the line, and of the tick after the whole-millisecond
/// boundary that lies before it.
const HALF_NS: u64 = 500_000;
const BYTE_NS: u64 = 10 * 1_000_000_000 / BAUD;
const TICK_NS: u64 = 730_000;

/// Timeout of the window watchdog, ms.
const WINDOW_MS: u64 = 46;

/// BoardOutputs after a reset.
const OFF: BoardOutputs = BoardOutputs {
    drive: Drive::Off,
    comparator_test: ComparatorTest::None,
};

/// Scans between the boundaries: four end the first step's tick, eight and four follow.
const SCANS_BEFORE_START: usize = 4;
const SCANS_IN_FIRST_HALF: usize = 8;

/// The logic of one finger without the microcontroller.
#[derive(Debug)]
pub struct NativeEngine {
    world: World,
    handler: CommandHandler<1>,
    device: Device<1>,
    reader: LineReader,
    /// Bytes on the line to the device with their arrival times, ns.
    incoming: VecDeque<(u64, u8)>,
    outgoing: Vec<u8>,
    scans: [Scan; SCANS_PER_TICK],
    filled: usize,
    /// Number of scans discarded before those of each tick, while the multiplexers settle.
    settling_scans: usize,
    pwm_period_steps: u16,
    /// Whether the bridge has pulled its fault pin since the last tick, as the board's break flag records.
    fault: bool,
    outputs: BoardOutputs,
    /// Time for which no tick has run, while the outputs keep their state.
    hung_ms: Option<u64>,
    resets: Vec<DeviceReset>,
    /// Settings in the simulated flash.
    stored: Option<[StoredSettings; 1]>,
    /// Half milliseconds since the first boundary.
    halves: u64,
}

impl NativeEngine {
    /// A device that has just started its first tick.
    #[must_use]
    pub fn new(world: World) -> Self {
        Self::with_discarded_scans(world, PWM_PERIOD_STEPS_OF_ONE_FINGER, 0, 0)
    }

    /// One of several fingers that share the converter through multiplexers: one scan is discarded before those of each
    /// tick. For the finger that the multiplexers select at power-up (`settled`), two scans are discarded the first time,
    /// because no switch precedes the first one.
    #[must_use]
    pub fn multiplexed(world: World, settled: bool) -> Self {
        Self::with_discarded_scans(world, PWM_PERIOD_STEPS_OF_FIVE_FINGERS, 1, settled.into())
    }

    fn with_discarded_scans(
        world: World,
        pwm_period_steps: u16,
        settling_scans: usize,
        more_at_first: usize,
    ) -> Self {
        let settings = Settings::default();
        let mut native = Self {
            world,
            handler: CommandHandler::new(settings),
            device: Device::new(&settings),
            reader: LineReader::new(),
            incoming: VecDeque::new(),
            outgoing: Vec::new(),
            scans: [Scan::default(); SCANS_PER_TICK],
            filled: 0,
            settling_scans,
            pwm_period_steps,
            fault: false,
            outputs: OFF,
            hung_ms: None,
            resets: Vec::new(),
            stored: None,
            halves: 0,
        };
        native.discard_scans(more_at_first);
        native.start_tick();
        native
    }

    /// Converts all channels and discards the codes.
    fn discard_scans(&mut self, scans: usize) {
        for _ in 0..scans {
            let _unsettled = Channel::ALL.map(|channel| self.world.convert(channel));
        }
    }

    /// Takes the first scans of a tick.
    fn start_tick(&mut self) {
        self.discard_scans(self.settling_scans);
        self.filled = 0;
        self.scan(SCANS_BEFORE_START);
    }

    fn scan(&mut self, count: usize) {
        for scan in &mut self.scans[self.filled..self.filled + count] {
            *scan = Channel::ALL.map(|channel| self.world.convert(channel));
        }
        self.filled += count;
    }

    fn tick(&mut self) {
        self.execute_received_lines((self.halves - 1) * HALF_NS + TICK_NS);
        let inputs = DigitalInputs {
            bridge_fault: self.fault,
            emergency_stop: self.world.emergency_stop(),
        };
        let samples = Samples::from_scans(&self.scans, inputs);
        self.fault = self.world.bridge_fault();
        self.outputs = self.device.step_finger(FingerIndex::FIRST, &samples);
        self.world
            .comparator_test(match self.outputs.comparator_test {
                ComparatorTest::None => PlantTest::None,
                ComparatorTest::Hot => PlantTest::Hot,
                ComparatorTest::Cold => PlantTest::Cold,
            });
        if let Some(telemetry) = self.device.finger_telemetry_if_due(FingerIndex::FIRST) {
            self.send_line(&wrap_as_telemetry_line(telemetry));
        }
    }

    /// Restarts the logic with the bridge off and with the trip cause and dose that the board retains. The start-up time of
    /// the board is not modelled.
    fn restart(&mut self, cause: ResetCause) {
        let tripped = self.device.earliest_trip_cause().copied();
        let cause_retained = match cause {
            ResetCause::PowerOn => None,
            ResetCause::WindowWatchdog => {
                tripped.or(Some(TripCause::without_readings(Fault::TickLost)))
            }
            _ => tripped,
        };
        let dose = match cause {
            ResetCause::PowerOn => ThermalDose::default(),
            _ => ThermalDose::from_any_retained_word(
                self.device
                    .finger_thermal_dose(FingerIndex::FIRST)
                    .to_retained_word(),
            ),
        };
        let settings = Settings::default();
        self.device = Device::new_optionally_tripped(cause_retained, &settings);
        self.device
            .restore_finger_thermal_dose(FingerIndex::FIRST, dose);
        self.handler = match &self.stored {
            Some(stored) => {
                self.device.restore_settings(stored);
                CommandHandler::from_stored(stored)
            }
            None => CommandHandler::new(settings),
        };
        self.reader = LineReader::new();
        (self.fault, self.outputs, self.hung_ms) = (false, OFF, None);
        self.resets.push(DeviceReset {
            t_s: (self.halves * HALF_NS) as f64 * 1e-9,
            cause,
        });
    }

    fn send_line(&mut self, line: &dyn Display) {
        let mut bytes = OutgoingLine::new();
        self.handler.write_line(&mut bytes, line);
        self.outgoing.extend_from_slice(&bytes);
    }

    /// Writes the settings and restarts; the time that this takes is not modelled.
    fn store_and_restart(&mut self, order: StorageOrder) {
        self.stored = decode_settings_record(&self.handler.record_to_save_or_forget(order))
            .ok()
            .flatten();
        self.restart(ResetCause::Software);
    }

    /// Executes the lines whose last byte has arrived before the tick.
    fn execute_received_lines(&mut self, now_ns: u64) {
        while let Some((_, byte)) = self.incoming.pop_front_if(|(at, _)| *at <= now_ns) {
            if LineReader::is_line_end(byte) {
                self.device.note_host_activity();
            }
            let Some(line) = self.reader.push(byte) else {
                continue;
            };
            let executed = line
                .map_err(|error| WithSourceFinger::from_whole_device(Error::from(error)))
                .and_then(|line| {
                    self.handler.answer(&line, |finger, command| {
                        self.device.execute(finger, command)
                    })
                });
            if let Ok(WithSourceFinger {
                content: Reply::Restart(order),
                ..
            }) = &executed
            {
                self.store_and_restart(*order);
            }
            match executed {
                Ok(reply) => self.send_line(&reply),
                Err(error) => self.send_line(&error),
            }
        }
    }
}

impl Engine for NativeEngine {
    type Stop = Infallible;

    const NAME: &'static str = "native";

    fn world(&mut self) -> &mut World {
        &mut self.world
    }

    fn legs(&mut self) -> BridgeOutputs {
        match self.outputs.drive {
            Drive::Off => BridgeOutputs::default(),
            Drive::On(duty) => {
                let steps = self.pwm_period_steps;
                let (a, b) = duty.input_high_times(steps);
                let leg = |part: u16| Leg::Duty(f64::from(part) / f64::from(steps));
                BridgeOutputs {
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
            match &mut self.hung_ms {
                None => self.tick(),
                Some(WINDOW_MS) => self.restart(ResetCause::WindowWatchdog),
                Some(ms) => *ms += 1,
            }
            self.start_tick();
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

    /// A hung core or missing samples stop the ticks until the window watchdog resets the device; a reset restarts the
    /// logic. Other faults do not apply to an engine without a processor.
    fn inject(&mut self, fault: &MachineFault, _after_us: u32) -> Result<(), NotInjected> {
        match fault {
            MachineFault::HungCore | MachineFault::DebuggerHalt | MachineFault::AdcStopped => {
                self.hung_ms = Some(0);
            }
            MachineFault::DmaStopped { controller: 2, .. } => self.hung_ms = Some(0),
            MachineFault::BrownOut => self.restart(ResetCause::BrownOut),
            MachineFault::PowerCycle { .. } => self.restart(ResetCause::PowerOn),
            MachineFault::ResetPin => self.restart(ResetCause::Pin),
            _ => {
                return Err(NotInjected::NotApplicable {
                    fault: *fault,
                    engine: Self::NAME,
                });
            }
        }
        Ok(())
    }

    fn resets(&self) -> Vec<DeviceReset> {
        self.resets.clone()
    }
}
