//! A station on a bench: physical quantities in, set-point and bridge command out.

mod any_input;
mod faults;
mod model_law;
mod rendering;
mod states;

use contact_model::material::{self, Material, REFERENCE_DISPLAY, SKIN};
use contact_model::{pressure, reference};
use std::mem;
use std::string::{String, ToString};

use crate::device::Telemetry;
use crate::device::command::Addressed;
use crate::device::drive::Drive;
use crate::device::drive::Outputs;
use crate::device::sense::Samples;
use crate::device::{State, Station};
use crate::protocol::Desk;
use crate::settings::{Settings, Tile};

/// Part of the way that its thermistor goes in a tick: that of a lag of 0.1 s.
const FOLLOWS: f64 = 0.01;

/// A station and the world that its sensors see.
#[derive(Clone, Debug)]
struct Bench {
    station: Station,
    desk: Desk<1>,
    /// Of the last tick.
    tick: u32,
    /// Surface of the plate, which the thermistors follow.
    plate_c: f64,
    display_c: f64,
    check_c: f64,
    sink_c: f64,
    skin_c: f64,
    room_c: f64,
    force_n: f64,
    /// Current that the device demanded in the last tick, magnitude.
    demanded_a: f64,
    /// Measured; what was asked for if nothing else.
    current_a: Option<f64>,
    bridge_fault: bool,
    /// The host gives a sign of life on every tick.
    host_there: bool,
    /// The plate answers the demanded current as a tile of its class, and its thermistors follow it.
    answers: bool,
    /// The converter's noise: one unit of each sum once in 40 ticks.
    noise: u16,
}

impl Bench {
    /// Nobody touches, nothing is wrong, telemetry comes on every tick.
    fn new() -> Self {
        let mut bench = Self {
            station: Station::new(&Settings::default()),
            desk: Desk::new(Settings::default()),
            tick: 0,
            plate_c: 30.0,
            display_c: 30.0,
            check_c: 30.0,
            sink_c: 25.0,
            skin_c: 34.0,
            room_c: 24.0,
            force_n: 0.0,
            demanded_a: 0.0,
            current_a: None,
            bridge_fault: false,
            host_there: true,
            answers: false,
            noise: 1,
        };
        assert_eq!(bench.host("stream 1"), "ok");
        assert_eq!(bench.host("law pi"), "ok");
        bench
    }

    /// Sends a line, gives the answer.
    fn host(&mut self, line: &str) -> String {
        let done = self.desk.answer(line, |request| {
            let said = self
                .station
                .execute(request.said)
                .map_err(Addressed::device)?;
            Ok(Addressed::device(said))
        });
        done.map_or_else(|error| error.to_string(), |reply| reply.to_string())
    }

    /// Sends lines that must be obeyed; `arm` until the device is armed.
    fn obey(&mut self, lines: &[&str]) {
        for line in lines {
            assert_eq!(self.host(line), "ok", "{line}");
            self.pass_self_test();
        }
    }

    /// A bench on which `material` is presented, and nobody touches it.
    fn presenting(material: &str) -> Self {
        let mut bench = Self::new();
        let chosen = ["material ", material].concat();
        bench.obey(&[&chosen, "arm", "start"]);
        bench.step();
        bench
    }

    /// The same with a display that answers.
    fn answering(material: &str) -> Self {
        let mut bench = Self::presenting(material);
        bench.answers = true;
        bench
    }

    /// One tick of a self-test, on a display that answers with 2.7 K/s per ampere and a comparator that works.
    fn step_tested(&mut self) {
        let (outputs, telemetry) = self.step_all();
        let moved_k = 2.7e-3 * telemetry.demand.to_num::<f64>();
        (self.display_c, self.check_c) = (self.display_c - moved_k, self.check_c - moved_k);
        self.bridge_fault = outputs.comparator_test;
    }

    /// Lets the device test itself.
    fn pass_self_test(&mut self) {
        let (display_c, check_c, current_a) = (self.display_c, self.check_c, self.current_a);
        let answers = mem::replace(&mut self.answers, false);
        self.current_a = None;
        while self.state() == State::SelfTest {
            self.step_tested();
        }
        (self.display_c, self.check_c, self.current_a) = (display_c, check_c, current_a);
        (self.plate_c, self.answers) = (display_c, answers);
    }

    /// What the converter makes of the world: 10 k thermistors of beta 3950 K under 10 k that warm themselves, 410
    /// counts and 300 counts/N, 400 counts/A, sixteen conversions.
    fn samples(&self) -> Samples {
        let thermistor = |t_c: f64, warmer_k: f64| {
            let ohm = 10e3 * (3950.0 * (1.0 / (t_c + warmer_k + 273.15) - 1.0 / 298.15)).exp();
            (65536.0 * ohm / (ohm + 10e3)).round() as u16
        };
        let current_a = self.current_a.unwrap_or(self.demanded_a);
        Samples {
            display: thermistor(self.display_c, 0.034),
            display_check: thermistor(self.check_c, 0.034),
            sink: thermistor(self.sink_c, 0.034),
            skin: thermistor(self.skin_c, 0.09),
            room: thermistor(self.room_c, 0.27),
            force: (16.0 * (410.0 + 300.0 * self.force_n)).round() as u16,
            current: (16.0 * 400.0 * current_a).round() as u16,
            bridge_fault: self.bridge_fault,
        }
    }

    /// One tick.
    fn step(&mut self) -> (Drive, Telemetry) {
        let (outputs, telemetry) = self.step_all();
        (outputs.drive, telemetry)
    }

    fn step_all(&mut self) -> (Outputs, Telemetry) {
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
        if self.host_there {
            self.station.hear();
        }
        let outputs = self.station.step(&samples);
        let telemetry = self.station.telemetry().expect("streamed on every tick");
        self.tick = telemetry.tick;
        self.demanded_a = telemetry.demand.to_num::<f64>().abs();
        if self.answers {
            let ampere = telemetry.demand.to_num::<f64>();
            let Tile {
                gain_k_s_a,
                joule_per_a,
                leak_1_s,
                ..
            } = Tile::CLASS;
            let pumped_k_s = gain_k_s_a * (ampere - joule_per_a * ampere * ampere);
            let leak_k_s = leak_1_s * (self.plate_c - self.sink_c);
            self.plate_c -= 1e-3 * (pumped_k_s + leak_k_s);
            self.display_c += FOLLOWS * (self.plate_c - self.display_c);
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

    fn state(&self) -> State {
        self.station.state()
    }

    /// Set-point of one tick, °C.
    fn setpoint_c(&mut self) -> f64 {
        let (_, telemetry) = self.step();
        assert_eq!(telemetry.state.fault(), None);
        telemetry.setpoint.expect("the bridge is driven").to_num()
    }

    /// The thesis's contact of this finger with an object, in `f64`.
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

/// One count of a thermistor's sum is 1.4 mK at 25 to 35 °C, so rounding moves a temperature by 0.7 mK, and
/// what is computed from skin and room by little more.
#[track_caller]
fn assert_close(actual_c: f64, expected_c: f64) {
    assert!(
        (actual_c - expected_c).abs() < 2e-3,
        "{actual_c} °C, expected {expected_c} °C"
    );
}
