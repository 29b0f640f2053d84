//! Commissioning commands on devices with five fingers and with one.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::device::{arm, samples};
use crate::commissioning::StorageOrder;
use crate::device::sense::{SCANS_PER_TICK, Samples};
use crate::device::{Device, FingerIndex};
use crate::protocol::CommandHandler;
use crate::settings::{Settings, decode_settings_record};

/// Lines that hold all commissioned settings, as a device reports them.
const SETTINGS: [&str; 8] = [
    "set steps 10 0.000 -0.310 0.127 1.000 -2.250 0.004 0.000",
    "set steps 17 0.500 -0.499 0.333 0.000 0.000 4.000",
    "set correction display -0.123456 0.0012345 -0.00001234",
    "set correction check 1.200000 -0.0500000 0.00200000",
    "set correction sink 0.000001 0.0000001 0.00000001",
    "set correction skin 0.000000 0.0000000 0.00000000",
    "set correction room -1.200000 0.0500000 -0.00200000",
    "set tile 2.911500 0.057812 0.102600 0.101112 0.015902",
];

/// A device and its command handler.
pub struct Bench<const FINGERS: usize> {
    pub handler: CommandHandler<FINGERS>,
    pub device: Device<FINGERS>,
}

impl<const FINGERS: usize> Bench<FINGERS> {
    pub fn new() -> Self {
        let settings = Settings::default();
        Self { handler: CommandHandler::new(settings), device: Device::new(&settings) }
    }

    /// Sends a line, and returns the answer.
    pub fn send(&mut self, line: &str) -> String {
        let answer =
            self.handler.answer(line, |finger, command| self.device.execute(finger, command));
        answer.map_or_else(|error| error.to_string(), |reply| reply.to_string())
    }

    /// A device that has started with what this one stores.
    pub fn restarted(&self) -> Self {
        let record = self.handler.record_to_save_or_forget(StorageOrder::Save);
        let stored = decode_settings_record::<FINGERS>(&record).expect("a valid record");
        let stored = stored.expect("settings rather than factory defaults");
        let mut restarted = Self::new();
        restarted.handler = CommandHandler::from_stored(&stored);
        restarted.device.restore_settings(&stored.fingers);
        restarted
    }

    /// The answers that report the settings of the finger that `address` names.
    fn settings(&mut self, address: &str) -> Vec<String> {
        (1..=8).map(|line| self.send(&format!("{address}settings {line}"))).collect()
    }

    /// Steps at 26 °C and a skin of 34 °C until all averages are complete.
    fn complete_averages(&mut self) {
        for tick in 0..600u16 {
            for finger in FingerIndex::all() {
                let count = |counts: u16| counts * SCANS_PER_TICK as u16 + tick % 2;
                let samples = Samples {
                    display: count(2000),
                    display_check: count(2000),
                    sink: count(2000),
                    skin: count(1650),
                    room: count(2000),
                    force: count(410),
                    current: 0,
                    supply: count(3464),
                    bridge_fault: false,
                    emergency_stop: false,
                    comparator_side_differs: false,
                    scattering_thermistors: 0,
                };
                self.device.step_finger(finger, &samples);
            }
        }
    }
}

impl Bench<1> {
    /// An armed device.
    pub fn armed() -> Self {
        let mut one = Self::new();
        for tick in 0..10 {
            one.device.step_finger(FingerIndex::FIRST, &samples(tick % 2));
        }
        arm(&mut one.device, FingerIndex::FIRST);
        one
    }
}

#[test]
fn an_addressed_set_line_changes_only_its_finger() {
    let mut five = Bench::<5>::new();
    let unchanged = five.settings("@0 ");
    for line in SETTINGS {
        assert_eq!(five.send(&format!("@3 {line}")), "@3 ok");
    }
    let expected: Vec<_> = SETTINGS.iter().map(|line| format!("@3 ok {line}")).collect();
    assert_eq!(five.settings("@3 "), expected);
    for finger in [0, 1, 2, 4] {
        let address = format!("@{finger} ");
        let expected: Vec<_> = unchanged.iter().map(|line| line.replace("@0 ", &address)).collect();
        assert_eq!(five.settings(&address), expected);
    }
}

#[test]
fn reported_settings_are_accepted_and_reported_again() {
    let mut one = Bench::<1>::new();
    for line in SETTINGS {
        assert_eq!(one.send(line), "ok");
    }
    for (line, answer) in SETTINGS.iter().zip(one.settings("")) {
        assert_eq!(answer, format!("ok {line}"));
    }
}

#[test]
fn an_unaddressed_change_is_made_by_all_fingers_and_a_query_answered_by_the_first() {
    let mut five = Bench::<5>::new();
    assert_eq!(five.send("set correction room 0.5 0 0"), "ok");
    assert_eq!(five.send("@4 set correction room 0.25 0 0"), "@4 ok");
    for (finger, offset) in ["0.5", "0.5", "0.5", "0.5", "0.25"].iter().enumerate() {
        let answer = five.send(&format!("@{finger} settings 7"));
        assert!(
            answer.starts_with(&format!("@{finger} ok set correction room {offset}")),
            "{answer}"
        );
    }
    assert_eq!(five.send("settings 7"), "@0 ok set correction room 0.500000 0.0000000 0.00000000");
    assert_eq!(five.send("settings"), "@0 ok lines=8");
    assert_eq!(Bench::<1>::new().send("settings"), "ok lines=8");
    assert!(five.send("@2 margins").starts_with("@2 ok gain="));
    five.complete_averages();
    let answer = five.send("@1 calibrate display 26.5");
    assert!(answer.starts_with("@1 ok points=1 worst_mk=0."), "{answer}");
    // Requests that take long address one finger at a time.
    assert_eq!(five.send("calibrate display 26.5"), "err finger (as @0) missing");
    assert_eq!(five.send("tune result"), "err finger (as @0) missing");
}

#[test]
fn an_error_names_the_first_finger_that_refuses_and_the_others_execute_the_line() {
    let mut five = Bench::<5>::new();
    five.complete_averages();
    arm(&mut five.device, FingerIndex::new(2).expect("a finger"));
    assert_eq!(five.send("@2 material copper"), "@2 ok");
    assert_eq!(five.send("@2 start"), "@2 ok");
    let refused = "@2 err not while an object or a course is presented: abort or arm first";
    assert_eq!(five.send("set correction display 0.2 0 0"), refused);
    assert_eq!(five.send("set steps 10 0.5"), refused);
    assert_eq!(five.send("calibrate check clear"), refused);
    assert_eq!(five.send("@2 calibrate display 26"), refused);
    assert_eq!(five.send("@2 set tile 2.5 0.05 0.1 0.1 0.016"), refused);
    for finger in [0, 1, 3, 4] {
        let answer = five.send(&format!("@{finger} settings 3"));
        let set = format!("@{finger} ok set correction display 0.200000 0.0000000 0.00000000");
        assert_eq!(answer, set);
    }
    assert_eq!(
        five.send("@2 settings 3"),
        "@2 ok set correction display 0.000000 0.0000000 0.00000000"
    );
    // 2000 counts are 26.0 °C.
    assert_eq!(
        five.send("@1 calibrate sink 23.5"),
        "@1 err the device reads 26.04 C; allowed is within 2 C of that"
    );
    assert_eq!(five.send("@5 margins"), "err unknown finger '5' after @; known: 0 to 4");
    assert_eq!(
        five.send("@1 set colour 3"),
        "@1 err unknown setting 'colour'; known: steps correction tile flux surface"
    );
    assert_eq!(five.send("@0 tune result"), "@0 err nothing was tuned since arm; tune first");
}

/// The current of the self-test moves the readings.
#[test]
fn calibrate_is_refused_during_the_self_test() {
    let mut one = Bench::<1>::new();
    one.complete_averages();
    assert_eq!(one.send("arm"), "ok");
    let before = one.settings("");
    let refused = one.send("calibrate room 25.5");
    assert!(refused.starts_with("err the self-test goes on"), "{refused}");
    assert_eq!(one.settings(""), before);
}

#[test]
fn invalid_arguments_are_refused_and_change_nothing() {
    let mut one = Bench::<1>::new();
    let before = one.settings("");
    for (line, answer) in [
        ("settings 0", "err line of settings '0' out of range; 1 to 10 (whole)"),
        ("settings 1.5", "err line of settings '1.5' out of range; 1 to 10 (whole)"),
        ("settings 11", "err line of settings '11' out of range; 1 to 10 (whole)"),
        ("set", "err setting missing; known: steps correction tile flux surface"),
        ("set steps", "err border missing; 10 to 22 (whole)"),
        ("set steps 10", "err step missing; -4 to 4 counts"),
        ("set steps 10.5 1", "err border '10.5' out of range; 10 to 22 (whole)"),
        ("set steps 23 1", "err border '23' out of range; 10 to 22 (whole)"),
        ("set steps 22 1 1", "err unexpected '1' after the command"),
        ("set steps 10 1 2 3 4 3 2 1 0", "err unexpected '0' after the command"),
        ("set steps 10 1 2 nan", "err step 'nan' is not a decimal number; -4 to 4 counts"),
        ("set correction", "err sensor missing; known: display check sink skin room"),
        ("set correction skin 0 0", "err curvature missing; -0.002 to 0.002 1/K"),
        (
            "set correction skin 0 inf 0",
            "err slope 'inf' is not a decimal number; -0.05 to 0.05 K/K",
        ),
        (
            "set correction nose 0 0 0",
            "err unknown sensor 'nose'; known: display check sink skin room",
        ),
        ("set tile 2.7 0.06 0.1 0 0.01", "err lag '0' out of range; 0.001 to 5 s"),
        ("set tile 1e30 0.06 0.1 0.1 0.01", "err gain '1e30' out of range; 0.1 to 15 K/s/A"),
        ("calibrate", "err sensor missing; known: display check sink skin room"),
        ("calibrate display", "err reference temperature missing; 0 to 60 C"),
        ("calibrate display 26 C", "err unexpected 'C' after the command"),
        ("calibrate display clear now", "err unexpected 'now' after the command"),
        ("calibrate display 61", "err reference temperature '61' out of range; 0 to 60 C"),
        ("tune it", "err unknown tune 'it'; known: result"),
        ("margins 3", "err unexpected '3' after the command"),
    ] {
        assert_eq!(one.send(line), answer, "{line}");
    }
    assert_eq!(one.settings(""), before);
}

/// One point shifts a restored calibration, but hardly changes its slope, curvature and steps, which many points had
/// determined.
#[test]
fn a_point_refines_a_restored_calibration() {
    let mut one = Bench::<1>::new();
    one.complete_averages();
    let set = "set correction display 0.400000 0.0100000 0.00010000";
    assert_eq!(one.send("set steps 14 0.5 0.5"), "ok");
    assert_eq!(one.send(set), "ok");
    let answer = one.send("calibrate display 26.5");
    assert!(answer.starts_with("ok points=1 worst_mk=0."), "{answer}");
    let numbers: Vec<f64> =
        (one.send("settings 3").split(' ')).filter_map(|word| word.parse().ok()).collect();
    let [_, slope, curvature] = numbers[..] else { panic!("{numbers:?}") };
    assert!((slope - 0.01).abs() < 2e-3 && (curvature - 1e-4).abs() < 1e-5, "{numbers:?}");
    let steps = one.send("settings 1");
    assert!(steps.starts_with("ok set steps 10 0.0"), "{steps}");
    assert!(steps.contains(" 0.5"), "{steps}");
    // The steps are cleared with the last correction of the display's sensors.
    assert_eq!(one.send("calibrate display clear"), "ok");
    assert_eq!(one.send("settings 1"), "ok set steps 10 0.000 0.000 0.000 0.000 0.000 0.000 0.000");
}

/// Each point deviates by less than what is rejected by itself; together they end at the range that `set` accepts.
#[test]
fn a_calibration_never_leaves_the_range_that_set_accepts() {
    let mut one = Bench::<1>::new();
    one.complete_averages();
    let reads = |one: &mut Bench<1>| -> f64 {
        let answer = one.send("calibrate room 60");
        let word = answer.split(' ').nth(4).expect("the reading");
        word.parse().expect("degrees")
    };
    let first = reads(&mut one);
    let mut answer = String::new();
    for point in 1..=24 {
        let reads_c = reads(&mut one);
        answer = one.send(&format!("calibrate room {:.2}", reads_c + 0.4));
        if answer.starts_with("err ") {
            break;
        }
        assert!(answer.starts_with(&format!("ok points={point} ")), "{answer}");
    }
    assert_eq!(
        answer,
        "err no correction fits this and the points before; clear them and begin again"
    );
    assert!((0.7..1.6).contains(&(reads(&mut one) - first)));
    let line = one.send("settings 7");
    assert_eq!(one.send(line.strip_prefix("ok ").expect("a line")), "ok");
}
