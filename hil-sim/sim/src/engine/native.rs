//! The native engine: calls the logic of the device directly.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::fmt::Display;

use thermal_commissioning::StorageOrder;
use thermal_device::command::WithSourceFinger;
use thermal_device::drive::{BoardOutputs, ComparatorTest, Drive};
use thermal_device::events::UnsolicitedReport;
use thermal_device::safety::{Fault, ThermalDose, TripCause};
use thermal_device::sense::{DigitalInputs, SCANS_PER_TICK, Samples, Scan};
use thermal_device::{
    Device, FingerIndex, PWM_PERIOD_STEPS_OF_FIVE_FINGERS, PWM_PERIOD_STEPS_OF_ONE_FINGER,
    TriggerEdge,
};
use thermal_learner::{Learner, LearnerOutput};
use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::comparator::ComparatorTest as PlantTest;
use thermal_protocol::{CommandHandler, Error, LineReader, OutgoingLine, Reply, UnsolicitedLine};
use thermal_settings::{Settings, StoredDevice, StoredSettings, decode_settings_record};

use super::{BAUD, DeviceReset, Engine};
use crate::World;
use crate::five_fingers::{FINGERS as FIVE, FiveFingerEngine};
use crate::processor::{MachineFault, NotInjected, ResetCause};

/// Nanoseconds of one half millisecond, from a boundary of a finger to that of the next finger, and of one byte on the line.
const HALF_NS: u64 = 500_000;
const TURN_NS: u64 = 200_000;
const BYTE_NS: u64 = 10 * 1_000_000_000 / BAUD;
/// Nanoseconds of the tick after the boundary that lies a millisecond before the one after it: of one finger, and of five,
/// whose scans follow each other more closely.
const TICK_NS: u64 = 730_000;
const TICK_OF_FIVE_FINGERS_NS: u64 = 135_000;

/// From the start of a tick's first scan to the boundary after it, µs: of one finger, and of the first of five.
const SCAN_TO_BOUNDARY_US: u64 = 233;
const SCAN_TO_BOUNDARY_OF_FIVE_FINGERS_US: u64 = 66;
/// Time since the start of a first scan, µs, from which on an edge of the trigger input waits for the next tick, as the board's
/// does: of one finger, and of five.
const TRIGGER_WAITS_FROM_US: u16 = 900;
const TRIGGER_OF_FIVE_FINGERS_WAITS_FROM_US: u16 = 150;

/// Timeout of the window watchdog, ms.
const WINDOW_MS: u64 = 46;

/// BoardOutputs after a reset.
const OFF: BoardOutputs = BoardOutputs {
    drive: Drive::Off,
    comparator_test: ComparatorTest::None,
    trigger_output: false,
};

/// Scans between the boundaries: four end the first step's tick, eight and four follow.
const SCANS_BEFORE_START: usize = 4;
const SCANS_IN_FIRST_HALF: usize = 8;

/// The logic of one finger without the microcontroller.
pub type NativeEngine = NativeDevice<1>;
/// The logic of five fingers without the microcontroller.
pub type NativeFiveFingers = NativeDevice<FIVE>;

/// The logic of a device without the microcontroller.
#[derive(Debug)]
pub struct NativeDevice<const FINGERS: usize> {
    fingers: [Finger; FINGERS],
    handler: CommandHandler<FINGERS>,
    device: Device<FINGERS>,
    reader: LineReader,
    /// Bytes on the line to the device with their arrival times, ns.
    incoming: VecDeque<(u64, u8)>,
    outgoing: Vec<u8>,
    pwm_period_steps: u16,
    /// Level that the board drives on the line that selects the side of the comparators' tests.
    side_is_high: bool,
    /// Time for which no tick has run, while the outputs keep their state.
    hung_ms: Option<u64>,
    resets: Vec<DeviceReset>,
    /// Edges of the trigger input with the milliseconds whose ticks report them.
    trigger_edges: VecDeque<(u64, TriggerEdge)>,
    /// Settings in the simulated flash.
    stored: Option<StoredDevice<FINGERS>>,
    /// Time since the first boundary, ns.
    now_ns: u64,
    /// Boundaries of fingers so far, on a device with five.
    boundaries: usize,
}

/// One finger's world, and what the board has of it.
#[derive(Debug)]
struct Finger {
    world: World,
    scans: [Scan; SCANS_PER_TICK],
    filled: usize,
    /// Number of scans discarded before those of each tick, while the multiplexers settle.
    settling_scans: usize,
    /// Whether the bridge has pulled its fault pin since the last tick, as the board's break flag records.
    fault: bool,
    outputs: BoardOutputs,
    /// Code of the conversion that the last tick with a heat-flux sensor has started; `None` before the first.
    flux_code: Option<u16>,
    /// Runs only with a heat-flux sensor.
    learner: Learner,
    /// Its last result.
    learnt: Option<LearnerOutput>,
}

impl Finger {
    /// A finger whose first tick has just started. On a device with several, which share the converter through multiplexers,
    /// one scan is discarded before those of each tick. For the finger that the multiplexers select at power-up, two scans are
    /// discarded the first time, because no switch precedes the first one.
    fn new(world: World, settling_scans: usize, more_at_first: usize) -> Self {
        let mut finger = Self {
            world,
            scans: [Scan::default(); SCANS_PER_TICK],
            filled: 0,
            settling_scans,
            fault: false,
            outputs: OFF,
            flux_code: None,
            learner: Learner::new(),
            learnt: None,
        };
        finger.discard_scans(more_at_first);
        finger.start_tick();
        finger
    }

    /// Converts all channels and discards the codes.
    fn discard_scans(&mut self, scans: usize) {
        for _ in 0..scans {
            let _unsettled = self.world.convert_scan();
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
            *scan = self.world.convert_scan();
        }
        self.filled += count;
    }

    /// The samples of the tick whose scans are complete, with the scatter of the thermistors if the device needs it, and with
    /// the inputs that all fingers share.
    fn samples(&mut self, shared: DigitalInputs, needs_scatter: bool) -> Samples {
        let inputs = DigitalInputs { bridge_fault: self.fault, ..shared };
        self.fault = self.world.bridge_fault();
        Samples::from_scans(&self.scans, inputs, needs_scatter)
    }

    fn set_outputs(&mut self, outputs: BoardOutputs) {
        self.outputs = outputs;
        self.world.comparator_test(match outputs.comparator_test {
            ComparatorTest::None => PlantTest::None,
            ComparatorTest::Hot => PlantTest::Hot,
            ComparatorTest::Cold => PlantTest::Cold,
        });
    }

    fn legs(&self, pwm_period_steps: u16) -> BridgeOutputs {
        match self.outputs.drive {
            Drive::Off => BridgeOutputs::default(),
            Drive::On(duty) => {
                let (a, b) = duty.input_high_times(pwm_period_steps);
                let leg = |part: u16| Leg::Duty(f64::from(part) / f64::from(pwm_period_steps));
                BridgeOutputs { a: leg(a), b: leg(b), enabled: true }
            }
        }
    }
}

impl NativeEngine {
    /// A device that has just started its first tick.
    pub fn new(world: World) -> Self {
        let finger = Finger::new(world, 0, 0);
        Self::with_fingers([finger], PWM_PERIOD_STEPS_OF_ONE_FINGER)
    }

    /// What the device has learnt of the finger last; `None` before the first result, and without a heat-flux sensor.
    pub const fn learnt(&self) -> Option<&LearnerOutput> {
        let [finger] = &self.fingers;
        finger.learnt.as_ref()
    }
}

impl NativeFiveFingers {
    /// A device just before its first boundary.
    pub fn new(worlds: [World; FIVE]) -> Self {
        let mut more_at_first = 1;
        let fingers = worlds.map(|world| Finger::new(world, 1, std::mem::take(&mut more_at_first)));
        Self::with_fingers(fingers, PWM_PERIOD_STEPS_OF_FIVE_FINGERS)
    }
}

impl<const FINGERS: usize> NativeDevice<FINGERS> {
    /// The settings in the flash; `None` if none were saved.
    pub fn stored_settings(&self) -> Option<&[StoredSettings; FINGERS]> {
        self.stored.as_ref().map(|stored| &stored.fingers)
    }

    /// The device just after power-up with these settings in its flash.
    #[must_use]
    pub fn with_stored_settings(mut self, stored: [StoredSettings; FINGERS]) -> Self {
        let stored = StoredDevice::from(stored);
        self.device.restore_settings(&stored.fingers);
        self.handler = CommandHandler::from_stored(&stored);
        self.stored = Some(stored);
        self.read_chip();
        self
    }

    /// This device with the thermal doses that another one has counted, as that one would have them after a reset.
    #[must_use]
    pub fn with_doses_of(mut self, before: &Self) -> Self {
        self.keep_doses_of(&before.device);
        self
    }

    fn keep_doses_of(&mut self, before: &Device<FINGERS>) {
        for finger in FingerIndex::all() {
            let word = before.finger_thermal_dose(finger).to_retained_word();
            let dose = ThermalDose::from_any_retained_word(word);
            self.device.restore_finger_thermal_dose(finger, dose);
        }
    }

    fn with_fingers(fingers: [Finger; FINGERS], pwm_period_steps: u16) -> Self {
        let settings = Settings::default();
        let mut native = Self {
            fingers,
            handler: CommandHandler::new(settings),
            device: Device::new(&settings),
            reader: LineReader::new(),
            incoming: VecDeque::new(),
            outgoing: Vec::new(),
            pwm_period_steps,
            side_is_high: false,
            hung_ms: None,
            resets: Vec::new(),
            trigger_edges: VecDeque::new(),
            stored: None,
            now_ns: 0,
            boundaries: 0,
        };
        native.read_chip();
        native
    }

    /// Runs the tick of a finger, at this time.
    fn tick(&mut self, index: FingerIndex<FINGERS>, at_ns: u64) {
        self.execute_received_lines(at_ns);
        let mut worlds = self.fingers.iter().map(|finger| &finger.world);
        let shared = DigitalInputs {
            emergency_stop: worlds.clone().any(World::emergency_stop),
            comparator_side_differs: worlds
                .find_map(World::side_stuck)
                .is_some_and(|level| level != self.side_is_high),
            ..DigitalInputs::default()
        };
        if index == FingerIndex::FIRST {
            self.report_trigger_edge(at_ns / (2 * HALF_NS));
        }
        let finger = &mut self.fingers[index.index()];
        let needs_scatter = self.device.finger_needs_scatter(index);
        let samples = finger.samples(shared, needs_scatter);
        if self.device.finger_has_flux_sensor(index) {
            // The board for five fingers has no converter for it.
            let converted = (FINGERS == 1).then(|| finger.world.flux_code());
            let code = std::mem::replace(&mut finger.flux_code, converted);
            self.device.note_flux_code(index, code);
        }
        let outputs = self.device.step_finger(index, &samples);
        if let Some(input) = self.device.take_learner_input(index) {
            let output = finger.learner.advance(&input);
            self.device.put_learner_output(index, output);
            finger.learnt = Some(*output);
        }
        match outputs.comparator_test {
            ComparatorTest::None => {}
            test => self.side_is_high = test == ComparatorTest::Cold,
        }
        finger.set_outputs(outputs);
        while let Some(event) = self.device.take_finger_event(index) {
            self.send_report(event);
        }
        if let Some(telemetry) = self.device.finger_telemetry_if_due(index) {
            self.send_report(telemetry.into_report());
        }
    }

    fn send_report(&mut self, report: WithSourceFinger<UnsolicitedReport>) {
        let device = &mut self.device;
        let line =
            UnsolicitedLine::of_report(report, |finger, command| device.execute(finger, command));
        self.send_line(&line);
    }

    /// Raises the trigger input `after_us` µs after the last boundary.
    fn raise_trigger(&mut self, after_us: u32) {
        let (to_boundary_us, waits_from_us) = if FINGERS == 1 {
            (SCAN_TO_BOUNDARY_US, TRIGGER_WAITS_FROM_US)
        } else {
            (SCAN_TO_BOUNDARY_OF_FIVE_FINGERS_US, TRIGGER_OF_FIVE_FINGERS_WAITS_FROM_US)
        };
        let at_us = self.now_ns / 1000 + u64::from(after_us) + to_boundary_us;
        let us = (at_us % 1000) as u16;
        let ticks_ago = u8::from(us >= waits_from_us);
        let edge = TriggerEdge { us, ticks_ago };
        let reported_ms = at_us / 1000 + u64::from(ticks_ago);
        self.trigger_edges.push_back((reported_ms, edge));
    }

    /// Reports the last edge of the trigger input that is due in this millisecond to the device; a timer keeps one only.
    fn report_trigger_edge(&mut self, ms: u64) {
        let mut last = None;
        while let Some((_, edge)) = self.trigger_edges.pop_front_if(|(at_ms, _)| *at_ms <= ms) {
            last = Some(edge);
        }
        if let Some(edge) = last {
            self.device.note_trigger_edge(edge);
        }
    }

    /// Reports what differs between chips, though the logic without a chip does not react to it.
    fn read_chip(&mut self) {
        if let Some(finger) = self.fingers.first() {
            let chip = finger.world.chip();
            let board = &mut self.handler.board;
            board.brown_out_level = 3_u8.saturating_sub(chip.brown_out_code);
            board.clock_is_external = chip.external_clock;
            board.unique_id = chip.unique_id;
        }
    }

    /// Restarts the logic with the bridges off and with the trip cause and doses that the board retains. The start-up time of
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
        let before = std::mem::replace(
            &mut self.device,
            Device::new_optionally_tripped(cause_retained, &Settings::default()),
        );
        if cause != ResetCause::PowerOn {
            self.keep_doses_of(&before);
        }
        self.handler = match &self.stored {
            Some(stored) => {
                self.device.restore_settings(&stored.fingers);
                CommandHandler::from_stored(stored)
            }
            None => CommandHandler::new(Settings::default()),
        };
        self.read_chip();
        self.reader = LineReader::new();
        self.hung_ms = None;
        self.side_is_high = false;
        for finger in &mut self.fingers {
            (finger.fault, finger.outputs, finger.flux_code) = (false, OFF, None);
            finger.learner = Learner::new();
        }
        self.resets.push(DeviceReset { t_s: self.now_ns as f64 * 1e-9, cause });
    }

    fn send_line(&mut self, line: &dyn Display) {
        let mut bytes = OutgoingLine::new();
        self.handler.write_line(&mut bytes, line);
        self.outgoing.extend_from_slice(&bytes);
    }

    /// Writes the settings and restarts; the time that this takes is not modelled.
    fn store_and_restart(&mut self, order: StorageOrder) {
        self.stored =
            decode_settings_record(&self.handler.record_to_save_or_forget(order)).ok().flatten();
        self.restart(ResetCause::Software);
    }

    /// Executes the lines whose last byte has arrived before the tick.
    fn execute_received_lines(&mut self, tick_ns: u64) {
        while let Some((_, byte)) = self.incoming.pop_front_if(|(at, _)| *at <= tick_ns) {
            if LineReader::is_line_end(byte) {
                self.device.note_host_activity();
            }
            let Some(line) = self.reader.push(byte) else {
                continue;
            };
            let executed = line
                .map_err(|error| WithSourceFinger::from_whole_device(Error::from(error)))
                .and_then(|line| {
                    self.handler
                        .answer(&line, |finger, command| self.device.execute(finger, command))
                });
            if let Ok(WithSourceFinger { content: Reply::Restart(order), .. }) = &executed {
                self.store_and_restart(*order);
            }
            match executed {
                Ok(reply) => self.send_line(&reply),
                Err(error) => self.send_line(&error),
            }
        }
    }

    /// A hung core or missing samples stop the ticks until the window watchdog resets the device; a reset restarts the
    /// logic. Other faults do not apply to an engine without a processor.
    fn inject_fault(&mut self, fault: &MachineFault) -> Result<(), NotInjected> {
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
                    engine: NativeEngine::NAME,
                });
            }
        }
        Ok(())
    }

    /// Puts bytes on the line to the device, after those that are on it.
    fn put_on_line(&mut self, bytes: &[u8]) {
        let mut at = self.now_ns;
        if let Some((last, _)) = self.incoming.back() {
            at = at.max(*last);
        }
        for &byte in bytes {
            at += BYTE_NS;
            self.incoming.push_back((at, byte));
        }
    }
}

impl Engine for NativeEngine {
    type Stop = Infallible;

    const NAME: &'static str = "native";

    fn world(&mut self) -> &mut World {
        &mut self.fingers[0].world
    }

    fn legs(&mut self) -> BridgeOutputs {
        self.fingers[0].legs(self.pwm_period_steps)
    }

    fn run_half_ms(&mut self) -> Result<(), Infallible> {
        let [finger] = &mut self.fingers;
        finger.fault |= finger.world.bridge_fault();
        if self.now_ns.is_multiple_of(2 * HALF_NS) {
            finger.scan(SCANS_IN_FIRST_HALF);
        } else {
            finger.scan(SCANS_PER_TICK - finger.filled);
            match &mut self.hung_ms {
                None => self.tick(FingerIndex::FIRST, self.now_ns - HALF_NS + TICK_NS),
                Some(WINDOW_MS) => self.restart(ResetCause::WindowWatchdog),
                Some(ms) => *ms += 1,
            }
            self.fingers[0].start_tick();
        }
        self.now_ns += HALF_NS;
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) {
        self.put_on_line(bytes);
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        into.append(&mut self.outgoing);
    }

    fn inject(&mut self, fault: &MachineFault, _after_us: u32) -> Result<(), NotInjected> {
        self.inject_fault(fault)
    }

    fn trigger(&mut self, after_us: u32) -> Result<(), Infallible> {
        self.raise_trigger(after_us);
        Ok(())
    }

    fn resets(&self) -> Vec<DeviceReset> {
        self.resets.clone()
    }
}

impl FiveFingerEngine for NativeFiveFingers {
    type Stop = Infallible;

    const NAME: &'static str = NativeEngine::NAME;

    fn run_to(&mut self, index: usize) -> Result<(), Infallible> {
        let last_ns = self.now_ns;
        self.now_ns = self.boundaries as u64 * TURN_NS;
        self.boundaries += 1;
        // Nothing runs before a finger's first boundary.
        let begun = self.boundaries > FIVE;
        let Some(finger) = FingerIndex::new(index).filter(|_| begun) else {
            return Ok(());
        };
        let of_finger = &mut self.fingers[index];
        of_finger.fault |= of_finger.world.bridge_fault();
        of_finger.scan(SCANS_PER_TICK - of_finger.filled);
        let boundary_ns = last_ns - (FIVE as u64 - 1) * TURN_NS;
        match &mut self.hung_ms {
            None => self.tick(finger, boundary_ns + TICK_OF_FIVE_FINGERS_NS),
            Some(WINDOW_MS) => self.restart(ResetCause::WindowWatchdog),
            Some(ms) => *ms += u64::from(finger == FingerIndex::FIRST),
        }
        self.fingers[index].start_tick();
        Ok(())
    }

    fn world(&mut self, finger: usize) -> &mut World {
        &mut self.fingers[finger].world
    }

    fn legs(&mut self, finger: usize) -> BridgeOutputs {
        self.fingers[finger].legs(self.pwm_period_steps)
    }

    fn send(&mut self, bytes: &[u8]) {
        self.put_on_line(bytes);
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        into.append(&mut self.outgoing);
    }

    fn inject(&mut self, fault: &MachineFault) -> Result<(), NotInjected> {
        self.inject_fault(fault)
    }

    fn trigger(&mut self) -> Result<(), Infallible> {
        self.raise_trigger(0);
        Ok(())
    }

    fn resets(&self) -> Vec<DeviceReset> {
        self.resets.clone()
    }
}
