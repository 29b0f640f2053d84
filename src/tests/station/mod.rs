//! Tests of one station: physical quantities in, set-point and bridge command out.

mod any_input;
mod faults;
mod model_law;
mod rendering;
mod states;
mod supply;

use contact_model::material::{self, Material, REFERENCE_DISPLAY, SKIN};
use contact_model::{pressure, reference};
use std::mem;
use std::string::{String, ToString};

use crate::device::Telemetry;
use crate::device::command::WithSourceFinger;
use crate::device::drive::Drive;
use crate::device::drive::{BoardOutputs, ComparatorTest};
use crate::device::sense::Samples;
use crate::device::{StateName, Station};
use crate::protocol::CommandHandler;
use crate::settings::Tile;
use crate::tests::tuned_settings;

/// Coefficient per tick of the thermistor's low-pass filter: a lag of 0.1 s.
const SENSOR_LAG_COEFFICIENT: f64 = 0.01;

/// A station, its command handler and the physical quantities that its sensors measure.
#[derive(Clone, Debug)]
struct TestBench {
    station: Station,
    handler: CommandHandler<1>,
    /// Number of the last tick.
    tick: u32,
    /// Temperature of the plate's surface, which the thermistors lag behind.
    plate_c: f64,
    display_c: f64,
    check_c: f64,
    sink_c: f64,
    skin_c: f64,
    room_c: f64,
    force_n: f64,
    /// Magnitude of the current that the station demanded in the last tick.
    demanded_a: f64,
    /// Measured current; `None` for the demanded one.
    measured_a: Option<f64>,
    bridge_fault: bool,
    /// Bridge supply behind its switch.
    supply_v: f64,
    emergency_stop: bool,
    /// The line of the comparator's side does not have the level that the board drives.
    comparator_side_differs: bool,
    /// A byte from the host arrives before every tick.
    host_alive: bool,
    /// Set-point of the last tick.
    last_setpoint_c: Option<f64>,
    /// The plate responds to the demanded current as the nominal tile does.
    plate_responds: bool,
    /// Noise of the converter: added to each sum once in 40 ticks.
    noise: u16,
}

impl TestBench {
    /// Untouched and without a fault, with telemetry on every tick, the law `pi` and the thesis's finger.
    fn new() -> Self {
        let mut bench = Self {
            station: Station::new(&tuned_settings()),
            handler: CommandHandler::new(tuned_settings()),
            tick: 0,
            plate_c: 30.0,
            display_c: 30.0,
            check_c: 30.0,
            sink_c: 25.0,
            skin_c: 34.0,
            room_c: 24.0,
            force_n: 0.0,
            demanded_a: 0.0,
            measured_a: None,
            bridge_fault: false,
            supply_v: 12.0,
            emergency_stop: false,
            comparator_side_differs: false,
            host_alive: true,
            last_setpoint_c: None,
            plate_responds: false,
            noise: 1,
        };
        assert_eq!(bench.send("stream 1"), "ok");
        assert_eq!(bench.send("law pi"), "ok");
        assert_eq!(bench.send("finger thesis"), "ok");
        bench
    }

    /// Sends a line, and returns the answer.
    fn send(&mut self, line: &str) -> String {
        let answer = self.handler.answer(line, |_, command| {
            let content =
                self.station.execute(&command).map_err(WithSourceFinger::from_whole_device)?;
            Ok(WithSourceFinger::from_whole_device(content))
        });
        answer.map_or_else(|error| error.to_string(), |reply| reply.to_string())
    }

    /// Sends lines that must be accepted; completes the self-test that `arm` starts.
    fn send_ok(&mut self, lines: &[&str]) {
        for line in lines {
            assert_eq!(self.send(line), "ok", "{line}");
            self.complete_self_test();
        }
    }

    /// A station that presents `material` and is not touched.
    fn presenting(material: &str) -> Self {
        let mut bench = Self::new();
        let material_line = ["material ", material].concat();
        bench.send_ok(&[&material_line, "arm", "start"]);
        bench.step();
        bench
    }

    /// The same with a plate that responds to the current.
    fn presenting_with_plate(material: &str) -> Self {
        let mut bench = Self::presenting(material);
        bench.plate_responds = true;
        bench
    }

    /// One tick of a self-test, on a display that responds with 2.7 K/s per ampere and with a working comparator.
    fn step_self_test(&mut self) {
        self.step_self_test_with(Self::apply_comparator_test);
    }

    /// One tick of a self-test with another comparator.
    fn step_self_test_with(&mut self, comparator: impl FnOnce(&mut Self, ComparatorTest)) {
        let (outputs, telemetry) = self.step_with_outputs();
        let moved_k = 2.7e-3 * telemetry.demand.to_num::<f64>();
        (self.display_c, self.check_c) = (self.display_c - moved_k, self.check_c - moved_k);
        comparator(self, outputs.comparator_test);
    }

    /// A comparator that works at once: a test pulls the fault line, and cuts the supply, which falls to 4 V.
    fn apply_comparator_test(&mut self, test: ComparatorTest) {
        self.bridge_fault = test != ComparatorTest::None;
        self.supply_v = if self.bridge_fault { 4.0 } else { 12.0 };
    }

    /// Steps until the self-test has ended, and restores the temperatures.
    fn complete_self_test(&mut self) {
        let (display_c, check_c, measured_a) = (self.display_c, self.check_c, self.measured_a);
        let plate_responds = mem::replace(&mut self.plate_responds, false);
        self.measured_a = None;
        while self.state() == StateName::SelfTest {
            self.step_self_test();
        }
        (self.display_c, self.check_c, self.measured_a) = (display_c, check_c, measured_a);
        (self.plate_c, self.plate_responds) = (display_c, plate_responds);
    }

    /// Sums of sixteen conversions: 10 kΩ thermistors with a beta of 3950 K and self-heating under 10 kΩ, a force
    /// sensor with 410 counts at zero and 300 counts/N, a current mirror with 400 counts/A, the supply behind 33 and
    /// 10 kΩ.
    fn samples(&self) -> Samples {
        let thermistor = |t_c: f64, self_heating_k: f64| {
            let ohm =
                10e3 * (3950.0 * (1.0 / (t_c + self_heating_k + 273.15) - 1.0 / 298.15)).exp();
            (65536.0 * ohm / (ohm + 10e3)).round() as u16
        };
        let current_a = self.measured_a.unwrap_or(self.demanded_a);
        Samples {
            display: thermistor(self.display_c, 0.034),
            display_check: thermistor(self.check_c, 0.034),
            sink: thermistor(self.sink_c, 0.034),
            skin: thermistor(self.skin_c, 0.09),
            room: thermistor(self.room_c, 0.27),
            force: (16.0 * (410.0 + 300.0 * self.force_n)).round() as u16,
            current: (16.0 * 400.0 * current_a).round() as u16,
            supply: (16.0 * 4096.0 / 3.3 * 10.0 / 43.0 * self.supply_v).round() as u16,
            bridge_fault: self.bridge_fault,
            emergency_stop: self.emergency_stop,
            comparator_side_differs: self.comparator_side_differs,
            scattering_thermistors: 0,
        }
    }

    /// Advances by one tick.
    fn step(&mut self) -> (Drive, Telemetry) {
        let (outputs, telemetry) = self.step_with_outputs();
        (outputs.drive, telemetry)
    }

    fn step_with_outputs(&mut self) -> (BoardOutputs, Telemetry) {
        let mut samples = self.samples();
        let noisy = [
            &mut samples.display,
            &mut samples.display_check,
            &mut samples.sink,
            &mut samples.skin,
            &mut samples.room,
            &mut samples.force,
        ];
        if self.tick % 40 == 20 {
            for sum in noisy {
                *sum = sum.saturating_add(self.noise);
            }
        }
        if self.host_alive {
            self.station.note_host_activity();
        }
        let outputs = self.station.step(&samples);
        let telemetry = self.station.telemetry_if_due().expect("streamed on every tick");
        self.tick = telemetry.tick;
        self.last_setpoint_c = telemetry.setpoint.map(|setpoint| setpoint.to_num());
        self.demanded_a = telemetry.demand.to_num::<f64>().abs();
        if self.plate_responds {
            let demand_a = telemetry.demand.to_num::<f64>();
            let Tile { gain_k_s_a, joule_per_a, leak_1_s, .. } = Tile::FACTORY_DEFAULT;
            let pumped_k_s = gain_k_s_a * (demand_a - joule_per_a * demand_a * demand_a);
            let leak_k_s = leak_1_s * (self.plate_c - self.sink_c);
            self.plate_c -= 1e-3 * (pumped_k_s + leak_k_s);
            self.display_c += SENSOR_LAG_COEFFICIENT * (self.plate_c - self.display_c);
            self.check_c = self.display_c;
        }
        (outputs, telemetry)
    }

    fn steps(&mut self, ticks: u32) -> (Drive, Telemetry) {
        for _ in 1..ticks {
            self.step();
        }
        self.step()
    }

    fn state(&self) -> StateName {
        self.station.state()
    }

    /// Advances by one tick, and returns its set-point, °C.
    fn setpoint_c(&mut self) -> f64 {
        let (_, telemetry) = self.step();
        assert_eq!(telemetry.state.fault(), None);
        telemetry.setpoint.expect("the bridge is driven").to_num()
    }

    /// Advances by one tick, and asserts that its set-point is `wanted_c`; under a plain law within its limits: 17 to 41 °C, and
    /// not faster towards 43 °C than with 7 effective dead times, towards 14 °C than with 14, unless that is faster than 5 K/s. Returns
    /// whether they did not matter.
    #[track_caller]
    fn assert_setpoint(&mut self, wanted_c: f64) -> bool {
        let mut limited_c = wanted_c;
        if self.send("law") != "ok law=model" {
            let last_c = self.last_setpoint_c.unwrap_or(self.display_c);
            let Tile { sensor_lag_s, dead_time_s, .. } = Tile::FACTORY_DEFAULT;
            let dead_time_ms = 1e3 * (sensor_lag_s + dead_time_s + 0.05);
            let [cold_ms, warm_ms] = [14.0, 7.0].map(|times| times * dead_time_ms);
            let lowest_c = (last_c + (14.0 - last_c) / cold_ms).min(14.0 + 5e-3 * cold_ms);
            let highest_c = (last_c + (43.0 - last_c) / warm_ms).max(43.0 - 5e-3 * warm_ms);
            limited_c = wanted_c.clamp(17.0, 41.0).clamp(lowest_c, highest_c);
        }
        assert_close(self.setpoint_c(), limited_c);
        limited_c == wanted_c
    }

    /// The same for as many ticks as it takes until the limits do not matter.
    #[track_caller]
    fn assert_reaches_setpoint(&mut self, wanted_c: f64) {
        assert!((0..20_000).any(|_| self.assert_setpoint(wanted_c)));
    }

    /// The contact of this finger with an object by the thesis's equations, in `f64`.
    fn contact(&self, material: &str, object_c: f64) -> reference::Contact<f64> {
        let object: &Material = material::find(material).expect("a material of the thesis");
        let pressure_pa = pressure::pressure_pa(self.force_n);
        reference::Contact::new(
            (&SKIN, self.skin_c),
            (object, object_c),
            &REFERENCE_DISPLAY,
            pressure_pa,
        )
    }
}

/// Asserts agreement to 2 mK: a count of a thermistor's sum is 1.4 mK at 25 to 35 °C, so rounding shifts a temperature
/// by
/// 0.7 mK, and a set-point that is computed from skin and room by little more.
#[track_caller]
fn assert_close(actual_c: f64, expected_c: f64) {
    assert!((actual_c - expected_c).abs() < 2e-3, "{actual_c} °C, expected {expected_c} °C");
}
