//! The lines of the heat-flux sensor.

use std::format;
use std::string::String;
use std::vec::Vec;

use thermal_learner::Learner;

use super::commissioning::Bench;
use super::device::{samples, telemetry_line};
use crate::device::FingerIndex;
use crate::device::sense::{SCANS_PER_TICK, Samples};

const FITTED: &str = "flux=fitted counts_per_w_m2=0.119200 zero_counts=2048.000 lag_ms=5.000 \
                      resistance_mm2k_w=30.000";

/// Counts of the force sensor without and with a finger on the display.
const FREE: u16 = 410;
const TOUCHED: u16 = 1010;
/// Counts of the room's thermistor at the display's temperature, and 0.4 K below it.
const SAME: u16 = 2000;
const COOLER: u16 = 2020;

/// The line that sets the designed sensor.
const SET: &str = "flux set 0.1192 2048 5 30";

/// A device with one finger, and its learner.
struct Learning {
    bench: Bench<1>,
    learner: Learner,
}

impl Learning {
    fn new() -> Self {
        Self { bench: Bench::new(), learner: Learner::new() }
    }

    /// With the designed sensor.
    fn with_sensor() -> Self {
        let mut one = Self::new();
        assert_eq!(one.send(SET), "ok");
        one
    }

    fn send(&mut self, line: &str) -> String {
        self.bench.send(line)
    }

    fn has_sensor(&self) -> bool {
        self.bench.device.finger_has_flux_sensor(FingerIndex::FIRST)
    }

    /// Steps with these codes of the flux sensor and these counts of force and room, and lets the learner learn.
    fn step(
        &mut self,
        (force, room): (u16, u16),
        codes: impl IntoIterator<Item = impl Into<Option<u16>>>,
    ) {
        let finger = FingerIndex::FIRST;
        for (code, tick) in codes.into_iter().zip(0u16..) {
            let count = |counts: u16| counts * SCANS_PER_TICK as u16 + tick % 2;
            if self.has_sensor() {
                self.bench.device.note_flux_code(finger, code.into());
            }
            let samples = Samples { force: count(force), room: count(room), ..samples(tick % 2) };
            self.bench.device.step_finger(finger, &samples);
            if let Some(input) = self.bench.device.take_learner_input(finger) {
                let output = self.learner.advance(&input);
                self.bench.device.put_learner_output(finger, output);
            }
        }
    }

    /// Number of events since the last call.
    fn events(&mut self) -> usize {
        let events =
            core::iter::from_fn(|| self.bench.device.take_finger_event(FingerIndex::FIRST));
        let kinds = events.map(|event| format!("{event:?}"));
        kinds.filter(|kind| kind.contains("FingerKnowledge")).count()
    }
}

/// Noise of a count around a mean of half a count more.
fn noisy(code: u16) -> impl Iterator<Item = u16> {
    (0..).map(move |tick| code + tick % 2)
}

#[test]
fn a_sensor_is_set_by_either_line_reported_and_removed() {
    for line in [SET, "set flux 0.1192 2048 5 30"] {
        let mut one = Learning::new();
        assert_eq!(one.send("flux"), "ok flux=none");
        assert_eq!(one.send("settings 9"), "ok set surface nominal");
        assert!(!one.has_sensor());
        assert_eq!(one.send(line), "ok");
        assert!(one.has_sensor());
        let expected = format!("ok {FITTED} w_m2=- finger=learning");
        assert_eq!(one.send("flux"), expected);
        assert_eq!(one.send("settings"), "ok lines=9");
        let reported = "set flux 0.119200 2048.000 5.000 30.000";
        assert_eq!(one.send("settings 9"), format!("ok {reported}"));
        assert_eq!(one.send(reported), "ok");
        assert_eq!(one.send("settings 9"), format!("ok {reported}"));
        one.step((FREE, SAME), [2060, 2048 + 119]);
        // 119 counts over 0.1192 counts per W/m².
        let expected = format!("ok {FITTED} w_m2=998.3 finger=learning");
        assert_eq!(one.send("flux"), expected);
        assert_eq!(one.send("flux none"), "ok");
        assert_eq!(one.send("flux"), "ok flux=none");
        assert_eq!(one.send("settings"), "ok lines=8");
        assert!(!one.has_sensor());
    }
}

#[test]
fn each_finger_has_its_own_sensor() {
    let mut five = Bench::<5>::new();
    assert_eq!(five.send("@2 flux set 0.1 2000 4 20"), "@2 ok");
    for finger in FingerIndex::all() {
        let is_second = finger.index() == 2;
        assert_eq!(five.device.finger_has_flux_sensor(finger), is_second);
    }
    assert_eq!(five.send("flux"), "@0 ok flux=none");
    assert_eq!(five.send("@2 settings"), "@2 ok lines=9");
    assert_eq!(five.send("@3 settings"), "@3 ok lines=8");
    assert_eq!(five.send("flux set 0.1 2000 4 20"), "ok");
    assert_eq!(five.send("@4 settings"), "@4 ok lines=9");
}

#[test]
fn a_sensor_is_refused_while_an_object_is_presented() {
    let mut one = Bench::armed();
    assert_eq!(one.send(SET), "ok");
    assert_eq!(one.send("material copper"), "ok");
    assert_eq!(one.send("start"), "ok");
    let refused = "err not while an object or a course is presented: abort or arm first";
    for line in ["flux none", "set flux none", "flux set 0.1 2048 5 0", "flux zero"] {
        assert_eq!(one.send(line), refused, "{line}");
    }
    assert_eq!(one.send("settings"), "ok lines=9");
    assert!(one.send("flux").starts_with(&format!("ok {FITTED} ")));
}

#[test]
fn the_zero_is_the_mean_code_of_half_a_second_without_a_finger_at_the_rooms_temperature() {
    let mut one = Learning::new();
    assert_eq!(one.send("flux zero"), "err flux zero needs a heat-flux sensor; flux set first");
    assert_eq!(one.send(SET), "ok");
    one.step((FREE, SAME), noisy(2060).take(500));
    let early = "err not watched for long enough; wait half a second";
    assert_eq!(one.send("flux zero"), early);
    one.step((FREE, SAME), noisy(2060).take(20));
    assert_eq!(one.send("flux zero"), "ok");
    let line = one.send("settings 9");
    assert_eq!(line, "ok set flux 0.119200 2060.500 5.000 30.000");

    one.step((TOUCHED, SAME), noisy(2300).take(600));
    assert_eq!(one.send("flux zero"), "err flux zero needs a display without a finger on it");
    one.step((FREE, SAME), noisy(2070).take(500));
    assert_eq!(one.send("flux zero"), early);
    one.step((FREE, SAME), noisy(2070).take(600));
    one.step((FREE, COOLER), noisy(2070).take(600));
    let refused = one.send("flux zero");
    let expected = "err flux zero needs the display within 0.3 C of the room; they have 26.0";
    assert!(refused.starts_with(expected), "{refused}");
    one.step((FREE, SAME), noisy(2070).take(600));
    assert_eq!(one.send("flux zero"), "ok");
    let line = one.send("settings 9");
    assert_eq!(line, "ok set flux 0.119200 2070.500 5.000 30.000");

    // Codes of a display that differed from the room do not count.
    one.step((FREE, COOLER), noisy(2000).take(700));
    one.step((FREE, SAME), noisy(2070).take(400));
    assert_eq!(one.send("flux zero"), early);

    one.step((FREE, SAME), noisy(4090).take(600));
    assert_eq!(
        one.send("flux zero"),
        "err the heat-flux sensor has no code, or one at a rail or that does not change; look at its wires"
    );
}

/// What a device with a sensor in its settings and none on its board says, and one whose sensor is stuck.
#[test]
fn a_code_that_cannot_be_right_is_a_word_and_an_event() {
    for code in [0, 4095, 2048] {
        let mut one = Learning::with_sensor();
        assert_eq!(one.send("events on"), "ok");
        one.step((FREE, SAME), [code; 120]);
        let expected = format!("ok {FITTED} w_m2=- finger=sensor-range");
        assert_eq!(one.send("flux"), expected, "{code}");
        assert_eq!(one.events(), 1, "{code}");
        one.step((TOUCHED, SAME), [code; 600]);
        assert_eq!(one.send("flux"), expected, "{code}");
        assert_eq!(one.events(), 0, "{code}");
        one.step((FREE, SAME), noisy(2048).take(40));
        let answer: String = one.send("flux");
        assert!(!answer.contains("sensor-range"), "{answer}");
        assert_eq!(one.events(), 1, "{code}");
    }
}

#[test]
fn a_conversion_that_has_not_ended_is_a_word_and_an_event_at_once() {
    let mut one = Learning::with_sensor();
    assert_eq!(one.send("events on"), "ok");
    // The first tick has none.
    let codes = (0..120).map(|tick| (tick % 50 != 0).then_some(2048 + tick % 2));
    one.step((FREE, SAME), codes.clone().take(50));
    assert!(one.send("flux").ends_with(" finger=learning"));
    assert_eq!(one.events(), 0);
    one.step((FREE, SAME), codes.clone().take(10));
    let expected = format!("ok {FITTED} w_m2=- finger=no-code");
    assert_eq!(one.send("flux"), expected);
    let refused = one.send("flux zero");
    assert!(refused.contains("look at its wires"), "{refused}");
    one.step((FREE, SAME), codes.skip(1).take(20));
    assert!(one.send("flux").ends_with(" finger=learning"));
    assert_eq!(one.events(), 2);
}

#[test]
fn a_stored_sensor_is_there_after_a_restart() {
    let mut two = Bench::<2>::new();
    assert_eq!(two.send("@1 flux set 0.11925 2051.5 4.5 31.25"), "@1 ok");
    let mut restarted = two.restarted();
    let has_sensor = |finger| restarted.device.finger_has_flux_sensor(finger);
    assert!(FingerIndex::all().map(has_sensor).eq([false, true]));
    let line = "@1 ok set flux 0.119250 2051.500 4.500 31.250";
    assert_eq!(restarted.send("@1 settings 9"), line);
    assert_eq!(restarted.send("@0 settings"), "@0 ok lines=8");
}

#[test]
fn telemetry_has_flux_surface_and_finger_if_they_are_named() {
    let mut one = Learning::new();
    let line = |one: &mut Learning| {
        telemetry_line(&mut one.bench.device, FingerIndex::FIRST).expect("telemetry")
    };
    assert_eq!(one.send("stream 1 flux display surface finger"), "ok");
    one.step((FREE, SAME), [2048]);
    let line_without = line(&mut one);
    assert!(line_without.ends_with(" - - - untuned"), "{line_without}");
    assert_eq!(one.send(SET), "ok");
    one.step((FREE, SAME), [2048, 2048, 2048 + 119]);
    let line = line(&mut one);
    let words: Vec<_> = line.split(' ').collect();
    let ["T", "4", "off", display, "998.3", surface, "learning", "untuned"] = words[..] else {
        panic!("{line}");
    };
    // Nothing warms or cools the display.
    let kelvin = |word: &str| word.parse::<f64>().expect(word);
    assert!((kelvin(display) - kelvin(surface)).abs() < 0.1, "{line}");
}

/// It belongs to the finger, not to the sensor.
#[test]
fn a_contact_law_that_was_set_stays_with_another_sensor() {
    let mut one = Learning::new();
    assert_eq!(one.send("contact 0.9 245000 500"), "ok");
    for line in [SET, "flux set 0.1 2048 5 0", "flux none"] {
        assert_eq!(one.send(line), "ok", "{line}");
        one.step((FREE, SAME), noisy(2048).take(20));
        let set = "ok exponent=0.9000 hardness_pa=245000 gap_w_m2k=500.0";
        assert_eq!(one.send("contact"), set, "{line}");
    }
}
