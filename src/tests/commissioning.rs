//! Lines that commission five fingers, or one.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::device::arm;
use crate::device::Device;
use crate::device::sense::{SCANS_PER_TICK, Samples};
use crate::protocol::Desk;
use crate::settings::Settings;

/// Settings that a device has given of itself.
const LINES: [&str; 8] = [
    "set steps 10 0.000 -0.310 0.127 1.000 -2.250 0.004 0.000",
    "set steps 17 0.500 -0.499 0.333 0.000 0.000 4.000",
    "set correction display -0.123456 0.0012345 -0.00001234",
    "set correction check 1.200000 -0.0500000 0.00200000",
    "set correction sink 0.000001 0.0000001 0.00000001",
    "set correction skin 0.000000 0.0000000 0.00000000",
    "set correction room -1.200000 0.0500000 -0.00200000",
    "set tile 2.911500 0.057812 0.102600 0.101112 0.015902",
];

struct Bench<const FINGERS: usize> {
    desk: Desk<FINGERS>,
    device: Device<FINGERS>,
}

impl<const FINGERS: usize> Bench<FINGERS> {
    fn new() -> Self {
        let settings = Settings::default();
        Self {
            desk: Desk::new(settings),
            device: Device::new(&settings),
        }
    }

    fn host(&mut self, line: &str) -> String {
        let done = self
            .desk
            .answer(line, |request| self.device.execute(request));
        done.map_or_else(|error| error.to_string(), |reply| reply.to_string())
    }

    /// Its settings, by the lines that it gives of them.
    fn lines(&mut self, of: &str) -> Vec<String> {
        (1..=8)
            .map(|line| self.host(&format!("{of}settings {line}")))
            .collect()
    }

    /// 25 degrees everywhere, for so long that points can be taken; each finger's display sees another noise.
    fn watch(&mut self) {
        for tick in 0..600u16 {
            for finger in 0..FINGERS {
                let count = |counts: u16| counts * SCANS_PER_TICK as u16 + tick % 2;
                let samples = Samples {
                    display: count(2000),
                    display_check: count(2000),
                    sink: count(2000),
                    skin: count(1650),
                    room: count(2000),
                    force: count(410),
                    current: 0,
                    bridge_fault: false,
                };
                self.device.step(finger, &samples);
            }
        }
    }
}

#[test]
fn a_line_changes_the_finger_that_it_names() {
    let mut five = Bench::<5>::new();
    let untouched = five.lines("@0 ");
    for line in LINES {
        assert_eq!(five.host(&format!("@3 {line}")), "@3 ok");
    }
    let told: Vec<_> = LINES.iter().map(|line| format!("@3 ok {line}")).collect();
    assert_eq!(five.lines("@3 "), told);
    for finger in [0, 1, 2, 4] {
        let of = format!("@{finger} ");
        let same: Vec<_> = untouched
            .iter()
            .map(|line| line.replace("@0 ", &of))
            .collect();
        assert_eq!(five.lines(&of), same);
    }
}

/// What a device gives of its settings is what it takes, and says the same again.
#[test]
fn lines_of_settings_restore_them() {
    let mut one = Bench::<1>::new();
    for line in LINES {
        assert_eq!(one.host(line), "ok");
    }
    for (line, told) in LINES.iter().zip(one.lines("")) {
        assert_eq!(told, format!("ok {line}"));
    }
}

#[test]
fn all_obey_an_order_and_the_first_answers_a_question() {
    let mut five = Bench::<5>::new();
    assert_eq!(five.host("set correction room 0.5 0 0"), "ok");
    assert_eq!(five.host("@4 set correction room 0.25 0 0"), "@4 ok");
    for (finger, offset) in ["0.5", "0.5", "0.5", "0.5", "0.25"].iter().enumerate() {
        let told = five.host(&format!("@{finger} settings 7"));
        assert!(
            told.starts_with(&format!("@{finger} ok set correction room {offset}")),
            "{told}"
        );
    }
    assert_eq!(
        five.host("settings 7"),
        "@0 ok set correction room 0.500000 0.0000000 0.00000000"
    );
    assert_eq!(five.host("settings"), "@0 ok lines=8");
    assert_eq!(Bench::<1>::new().host("settings"), "ok lines=8");
    assert!(five.host("@2 margins").starts_with("@2 ok gain="));
    five.watch();
    let told = five.host("@1 calibrate display 26.5");
    assert!(told.starts_with("@1 ok points=1 worst_mk=0."), "{told}");
    // What takes long is for one at a time.
    assert_eq!(
        five.host("calibrate display 26.5"),
        "err finger (as @0) missing"
    );
    assert_eq!(five.host("tune result"), "err finger (as @0) missing");
}

#[test]
fn refusals_name_the_first_finger_that_refuses_and_the_others_obey() {
    let mut five = Bench::<5>::new();
    five.watch();
    arm(&mut five.device, 2);
    assert_eq!(five.host("@2 material copper"), "@2 ok");
    assert_eq!(five.host("@2 start"), "@2 ok");
    let refused = "@2 err not while an object is presented: abort or arm first";
    assert_eq!(five.host("set correction display 0.2 0 0"), refused);
    assert_eq!(five.host("set steps 10 0.5"), refused);
    assert_eq!(five.host("calibrate check clear"), refused);
    assert_eq!(five.host("@2 calibrate display 26"), refused);
    assert_eq!(five.host("@2 set tile 2.5 0.05 0.1 0.1 0.016"), refused);
    for finger in [0, 1, 3, 4] {
        let told = five.host(&format!("@{finger} settings 3"));
        let set = format!("@{finger} ok set correction display 0.200000 0.0000000 0.00000000");
        assert_eq!(told, set);
    }
    assert_eq!(
        five.host("@2 settings 3"),
        "@2 ok set correction display 0.000000 0.0000000 0.00000000"
    );
    // 2000 counts are 26.0 degrees.
    assert_eq!(
        five.host("@1 calibrate sink 23.5"),
        "@1 err the device reads 26.04 C; allowed is within 2 C of that"
    );
    assert_eq!(
        five.host("@5 margins"),
        "err unknown finger '5' after @; known: 0 to 4"
    );
    assert_eq!(
        five.host("@1 set colour 3"),
        "@1 err unknown setting 'colour'; known: steps correction tile"
    );
    assert_eq!(
        five.host("@0 tune result"),
        "@0 err nothing was tuned since arm; tune first"
    );
}

/// What is read then is moved by the test's own current.
#[test]
fn a_self_test_that_goes_on_keeps_calibration_from_changing_anything() {
    let mut one = Bench::<1>::new();
    one.watch();
    assert_eq!(one.host("arm"), "ok");
    let before = one.lines("");
    let refused = one.host("calibrate room 25.5");
    assert!(
        refused.starts_with("err the self-test goes on"),
        "{refused}"
    );
    assert_eq!(one.lines(""), before);
}

#[test]
fn nonsense_is_refused_and_changes_nothing() {
    let mut one = Bench::<1>::new();
    let before = one.lines("");
    for (line, answer) in [
        (
            "settings 0",
            "err line of settings '0' out of range; 1 to 8 (whole)",
        ),
        (
            "settings 1.5",
            "err line of settings '1.5' out of range; 1 to 8 (whole)",
        ),
        (
            "settings 9",
            "err line of settings '9' out of range; 1 to 8 (whole)",
        ),
        ("set", "err setting missing"),
        ("set steps", "err border missing"),
        ("set steps 10", "err step missing"),
        (
            "set steps 10.5 1",
            "err border '10.5' out of range; 10 to 22 (whole)",
        ),
        (
            "set steps 23 1",
            "err border '23' out of range; 10 to 22 (whole)",
        ),
        ("set steps 22 1 1", "err unexpected '1' after the command"),
        (
            "set steps 10 1 2 3 4 3 2 1 0",
            "err unexpected '0' after the command",
        ),
        (
            "set steps 10 1 2 nan",
            "err step 'nan' is not a decimal number; -4 to 4 counts",
        ),
        ("set correction", "err sensor missing"),
        ("set correction skin 0 0", "err curvature missing"),
        (
            "set correction skin 0 inf 0",
            "err slope 'inf' is not a decimal number; -0.05 to 0.05 K/K",
        ),
        (
            "set correction nose 0 0 0",
            "err unknown sensor 'nose'; known: display check sink skin room",
        ),
        (
            "set tile 2.7 0.06 0.1 0 0.01",
            "err lag '0' out of range; 0.001 to 5 s",
        ),
        (
            "set tile 1e30 0.06 0.1 0.1 0.01",
            "err gain '1e30' out of range; 0.1 to 15 K/s/A",
        ),
        ("calibrate", "err sensor missing"),
        ("calibrate display", "err reference temperature missing"),
        (
            "calibrate display 26 C",
            "err unexpected 'C' after the command",
        ),
        (
            "calibrate display clear now",
            "err unexpected 'now' after the command",
        ),
        (
            "calibrate display 61",
            "err reference temperature '61' out of range; 0 to 60 C",
        ),
        ("tune it", "err unexpected 'it' after the command"),
        ("margins 3", "err unexpected '3' after the command"),
    ] {
        assert_eq!(one.host(line), answer, "{line}");
    }
    assert_eq!(one.lines(""), before);
}

/// One point on a restored calibration moves it there, and keeps what many points had found.
#[test]
fn a_point_after_restored_settings_refines_them() {
    let mut one = Bench::<1>::new();
    one.watch();
    let set = "set correction display 0.400000 0.0100000 0.00010000";
    assert_eq!(one.host("set steps 14 0.5 0.5"), "ok");
    assert_eq!(one.host(set), "ok");
    let told = one.host("calibrate display 26.5");
    assert!(told.starts_with("ok points=1 worst_mk=0."), "{told}");
    let numbers: Vec<f64> = (one.host("settings 3").split(' '))
        .filter_map(|word| word.parse().ok())
        .collect();
    let [_, slope, curvature] = numbers[..] else {
        panic!("{numbers:?}")
    };
    assert!(
        (slope - 0.01).abs() < 2e-3 && (curvature - 1e-4).abs() < 1e-5,
        "{numbers:?}"
    );
    let steps = one.host("settings 1");
    assert!(steps.starts_with("ok set steps 10 0.0"), "{steps}");
    assert!(steps.contains(" 0.5"), "{steps}");
    // Without points and corrections of either sensor nothing is left of the steps.
    assert_eq!(one.host("calibrate display clear"), "ok");
    assert_eq!(
        one.host("settings 1"),
        "ok set steps 10 0.000 0.000 0.000 0.000 0.000 0.000 0.000"
    );
}

/// Points that walk away from the class values by less than what is refused at once end where `set` would.
#[test]
fn a_calibration_never_leaves_what_can_be_restored() {
    let mut one = Bench::<1>::new();
    one.watch();
    let reads = |one: &mut Bench<1>| -> f64 {
        let told = one.host("calibrate room 60");
        let word = told.split(' ').nth(4).expect("what it reads");
        word.parse().expect("degrees")
    };
    let first = reads(&mut one);
    let mut told = String::new();
    for point in 1..=24 {
        let reads_c = reads(&mut one);
        told = one.host(&format!("calibrate room {:.2}", reads_c + 0.4));
        if told.starts_with("err ") {
            break;
        }
        assert!(told.starts_with(&format!("ok points={point} ")), "{told}");
    }
    assert_eq!(
        told,
        "err no correction fits this and the points before; clear them and begin again"
    );
    assert!((0.7..1.6).contains(&(reads(&mut one) - first)));
    let line = one.host("settings 7");
    assert_eq!(one.host(line.strip_prefix("ok ").expect("a line")), "ok");
}
