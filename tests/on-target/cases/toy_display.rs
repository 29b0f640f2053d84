//! The device with samples of a display that is computed here, so that its ticks run as under a finger although nothing is
//! connected: plate, sensors and comparator as class values, without noise of the converter.

use thermal_display::device::command::WithSourceFinger;
use thermal_display::device::drive::ComparatorTest;
use thermal_display::device::sense::{DigitalInputs, SCANS_PER_TICK, Samples, Scan};
use thermal_display::device::{FingerIndex, StateName, Telemetry, execute_in_turn};
use thermal_display::settings::Tile;

use crate::board::Board;
use crate::cycles;
use crate::running_board::feed;

/// Coefficient per tick of the thermistor's low-pass filter: a lag of 0.1 s.
const SENSOR_LAG_COEFFICIENT: f64 = 0.01;
/// Response of the plate in the self-test, kelvin per ampere and tick.
const SELF_TEST_K_A: f64 = 2.7e-3;
const SINK_C: f64 = 25.0;
const SKIN_C: f64 = 34.0;
const ROOM_C: f64 = 24.0;

/// Physical state of the display.
pub struct ToyDisplay {
    pub force_n: f64,
    plate_c: f64,
    display_c: f64,
    demanded_a: f64,
    comparator_test: ComparatorTest,
    tick: u32,
}

impl ToyDisplay {
    pub fn new() -> Self {
        Self {
            force_n: 0.0,
            plate_c: 30.0,
            display_c: 30.0,
            demanded_a: 0.0,
            comparator_test: ComparatorTest::None,
            tick: 0,
        }
    }

    /// Conversions of a tick: 10 kΩ thermistors with a beta of 3950 K and self-heating under 10 kΩ, a force sensor with 410
    /// counts at zero and 300 counts/N, a current mirror with 400 counts/A, the supply behind 33 and 10 kΩ.
    fn scans(&self) -> [Scan; SCANS_PER_TICK] {
        let thermistor = |t_c: f64, self_heating_k: f64| {
            let inverse = 1.0 / (t_c + self_heating_k + 273.15) - 1.0 / 298.15;
            let ohm = 10e3 * libm::exp(3950.0 * inverse);
            65536.0 * ohm / (ohm + 10e3)
        };
        let is_cut = self.comparator_test != ComparatorTest::None;
        let supply_v = if is_cut { 4.0 } else { 12.0 };
        let sums = [
            thermistor(self.display_c, 0.034),
            thermistor(self.display_c, 0.034),
            thermistor(SINK_C, 0.034),
            thermistor(SKIN_C, 0.09),
            thermistor(ROOM_C, 0.27),
            16.0 * (410.0 + 300.0 * self.force_n),
            16.0 * 400.0 * self.demanded_a.abs(),
            16.0 * 4096.0 / 3.3 * 10.0 / 43.0 * supply_v,
        ];
        // A count more once in 40 ticks, without which a sample counts as frozen.
        let flicker = u16::from(self.tick % 40 == 20);
        let sums = sums.map(|sum| (sum + 0.5) as u16 + flicker);
        core::array::from_fn(|scan| sums.map(|sum| (sum + scan as u16) / SCANS_PER_TICK as u16))
    }

    /// A tick of the device on this display: its telemetry, and the cycles from samples to telemetry.
    pub fn step(&mut self, board: &mut Board) -> (Telemetry, u32) {
        feed(board);
        let (device, finger) = (&mut board.device, FingerIndex::FIRST);
        device.note_host_activity();
        let inputs = DigitalInputs {
            bridge_fault: self.comparator_test != ComparatorTest::None,
            emergency_stop: false,
            comparator_side_differs: false,
        };
        let scans = self.scans();
        let ((outputs, telemetry), cost) = cycles::measure(|| {
            let needs_scatter = device.finger_needs_scatter(finger);
            let samples = Samples::from_scans(&scans, inputs, needs_scatter);
            let outputs = device.step_finger(finger, &samples);
            (outputs, device.finger_telemetry_if_due(finger))
        });
        let WithSourceFinger { content, .. } = telemetry.expect("`stream 1` was sent");
        self.comparator_test = outputs.comparator_test;
        self.respond(&content);
        (content, cost)
    }

    fn respond(&mut self, telemetry: &Telemetry) {
        self.tick = telemetry.tick;
        self.demanded_a = telemetry.demand.to_num();
        if telemetry.state == StateName::SelfTest {
            self.plate_c -= SELF_TEST_K_A * self.demanded_a;
            self.display_c = self.plate_c;
            return;
        }
        let Tile { gain_k_s_a, joule_per_a, leak_1_s, .. } = Tile::FACTORY_DEFAULT;
        let pumped_k_s =
            gain_k_s_a * (self.demanded_a - joule_per_a * self.demanded_a * self.demanded_a);
        let leak_k_s = leak_1_s * (self.plate_c - SINK_C);
        self.plate_c -= 1e-3 * (pumped_k_s + leak_k_s);
        self.display_c += SENSOR_LAG_COEFFICIENT * (self.plate_c - self.display_c);
    }

    /// Steps until the device is in a state.
    pub fn step_until(&mut self, board: &mut Board, state: StateName) {
        const TICKS_MAX: u32 = 5000;
        let reached = (0..TICKS_MAX).any(|_| self.step(board).0.state == state);
        assert!(reached, "{} is not reached", state.name());
    }
}

/// Sends a line that the device must accept; the cycles for which executing it locks the device.
pub fn send(board: &mut Board, line: &str) -> u32 {
    feed(board);
    let (handler, device) = (&mut board.console.handler, &mut board.device);
    let mut lock_cycles = 0;
    let answer = handler.answer(line, |finger, command| {
        execute_in_turn(finger, |one| {
            let (result, cycles) = cycles::measure(|| device.execute_on_finger(one, &command));
            lock_cycles = cycles.max(lock_cycles);
            result
        })
    });
    if let Err(refusal) = answer {
        panic!("{line}: {refusal}");
    }
    lock_cycles
}
