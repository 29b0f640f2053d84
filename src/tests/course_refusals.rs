//! The words of every refusal of a course: value, place and what is allowed.

use std::format;
use std::string::String;
use std::vec::Vec;

use contact_model::fixed_point::Celsius;

use super::courses::{Bench, FIRST};
use super::objects::checksum;
use crate::device::Device;
use crate::device::safety::{Fault, ThermalDose};
use crate::protocol::CommandHandler;
use crate::tests::tuned_settings;

const NO_COURSE: &str = "err no course is loaded; upload begin course first";
const NOT_BEGUN: &str = "err no upload has begun; upload begin object COUNT DIRECT first";

#[test]
fn every_wrong_course_is_refused_with_its_reason() {
    let mut bench = Bench::armed();
    let begin = "upload begin course 3 absolute";
    assert_eq!(bench.send("play now"), "err no course is loaded; upload begin course first");
    for (lines, answer) in [
        (
            &["upload begin course 129 absolute"][..],
            "err number of points '129' out of range; 2 to 128",
        ),
        (&["upload begin course 3"], "err temperatures missing; known: absolute relative"),
        (
            &[begin, "upload row 0 1 30", "upload row 1 0.5 30"],
            "err row 1: time 500 ms is not after 1000 ms, that of the row before",
        ),
        (&[begin, "upload row 0 0 42.1"], "err temperature '42.1' out of range; 15 to 42 C"),
        (&[begin, "upload row 0 0 14"], "err temperature '14' out of range; 15 to 42 C"),
        (
            &["upload begin course 3 relative", "upload row 0 0 28"],
            "err temperature '28' out of range; -27 to 27 K",
        ),
        (
            &[begin, "upload row 0 0 30", "upload row 1 0.01 32"],
            "err row 1: too fast: 200 K/s from the point before; at most 100 K/s",
        ),
        (&[begin, "upload row 0 4000 30"], "err time '4000' out of range; 0 to 3600 s"),
        (&[begin, "upload row 1 0 30"], "err not the next row, which is 0"),
        (&["play soon"], "err unknown start of a course 'soon'; known: now trigger landing"),
        (&["play now 0"], "err repeats '0' out of range; 1 to 1000"),
        (&["play now 2 off"], "err unknown end of a course 'off'; known: hold neutral"),
        (&["hold 30 0.001"], "err rate '0.001' out of range; 0.01 to 100 K/s"),
        (&["hold 43"], "err temperature '43' out of range; 15 to 42 C"),
        (&["skin"], "err skin missing; 15 to 42 C; or sensor"),
        (&["skin cold"], "err skin 'cold' is not a decimal number; 15 to 42 C; or sensor"),
        (
            &["pulse 30 42 1 600 1"],
            "err too hot for too long: CEM43 would be 2.51 min; below 0.50 min is allowed",
        ),
        (&["events maybe"], "err unknown switch 'maybe'; known: on off"),
        (
            &["trigger-out land,touch"],
            "err unknown event 'touch'; known: land lift start end flux none",
        ),
    ] {
        let (last, before) = lines.split_last().expect("a line");
        bench.send_ok(before);
        assert_eq!(bench.send(last), answer, "{lines:?}");
    }
    let hot = bench.upload("absolute", &[(0.0, 42.0), (160.0, 42.0)]);
    assert_eq!(hot, "err too hot for too long: CEM43 would be 0.67 min; below 0.50 min is allowed");
    // Nothing was loaded.
    assert_eq!(bench.send("play now"), "err no course is loaded; upload begin course first");
    bench.steps(1);
}

#[test]
fn a_course_whose_repeats_or_earlier_dose_would_trip_is_refused() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 42.0), (50.0, 42.0)]), "ok");
    let refused = "err too hot for too long: CEM43 would be 0.62 min; below 0.50 min is allowed";
    assert_eq!(bench.send("play now 3"), refused);
    bench.send_ok(&["play landing 2", "arm"]);
    bench.steps(1);
    // 20 s at 43 °C.
    let before = ThermalDose::from_any_retained_word(20_000 << 8);
    bench.device.restore_finger_thermal_dose(FIRST, before);
    let refused = "err too hot for too long: CEM43 would be 0.54 min; below 0.50 min is allowed";
    assert_eq!(bench.send("play now"), refused);
    assert_eq!(bench.state(), "armed");
}

#[test]
fn stimuli_need_a_driven_display_and_no_fault() {
    let mut bench = Bench::off();
    for (line, command) in [("hold 30", "hold"), ("play now", "play")] {
        assert_eq!(bench.send(line), format!("err {command} needs a driven display: arm first"));
    }
    // Loading needs no display.
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (1.0, 31.0)]), "ok");
    bench.device.trip_all(Fault::Stack);
    for line in ["hold 30", "play now", "upload begin course 2 absolute", "pulse 30 31 1 1 1"] {
        assert_eq!(bench.send(line), "err tripped by stack; clear it first", "{line}");
    }
    // The upload has not begun.
    assert!(bench.send("upload row 0 0 30").starts_with("err no upload has begun"));
}

#[test]
fn what_the_finger_would_feel_is_refused_while_a_course_plays_and_allowed_while_it_is_held() {
    let mut bench = Bench::armed();
    bench.send_ok(&["pulse 26 27 10 0.05 5"]);
    let refused = "err not while an object or a course is presented: abort or arm first";
    assert_eq!(bench.send("set tile 2.7 0.03 0.2 0.1 0.01"), refused);
    bench.steps(400);
    assert!(!bench.send("calibrate display 24").contains("presented"));
}

#[test]
fn a_line_without_a_checksum_is_refused_while_checksums_are_on() {
    let mut bench = Bench::armed();
    bench.send_ok(&["checksum on", "checksum on*2C"]);
    let refused = "err checksum missing, the line has 7D; send the line again with it";
    assert_eq!(bench.send("law pi-10hz"), refused);
    assert_eq!(bench.send("law*7A"), "ok law=model");
    bench.send_ok(&["checksum off*42", "law pi"]);
}

#[test]
fn points_that_are_too_many_not_later_or_out_of_turn_are_refused_and_the_upload_goes_on() {
    let mut bench = Bench::armed();
    bench.send_ok(&["upload begin course 2 absolute", "upload row 0 0.5 30"]);
    for (line, answer) in [
        (
            "upload row 1 0.5 30",
            "err row 1: time 500 ms is not after 500 ms, that of the row before",
        ),
        ("upload row 2 1 30", "err not the next row, which is 1"),
        ("upload row 128 1 30", "err row '128' out of range; 0 to 127"),
        ("upload row 1 -0.5 30", "err time '-0.5' out of range; 0 to 3600 s"),
        ("upload row 1 1", "err temperature missing; 15 to 42 C"),
        ("upload row 1 1 warm", "err temperature 'warm' is not a decimal number; 15 to 42 C"),
    ] {
        assert_eq!(bench.send(line), answer, "{line}");
    }
    bench.send_ok(&["upload row 1 1 31"]);
    assert_eq!(bench.send("upload row 2 2 32"), "err not the next row, which is 2");
    let lines = ["upload begin course 2 absolute", "upload row 0 0.5 30", "upload row 1 1 31"];
    let commit = format!("upload commit {:08x}", checksum(&lines.map(String::from)));
    bench.send_ok(&[&commit, "play now"]);
}

#[test]
fn a_course_of_the_most_points_is_accepted_and_one_point_more_is_not() {
    let mut bench = Bench::armed();
    let points: Vec<_> =
        (0..129).map(|point| (f64::from(point), 30.0 + f64::from(point % 2))).collect();
    assert_eq!(bench.upload("absolute", &points[..128]), "ok");
    assert_eq!(
        bench.upload("absolute", &points),
        "err number of points '129' out of range; 2 to 128"
    );
    assert_eq!(
        bench.upload("absolute", &points[..1]),
        "err number of points '1' out of range; 2 to 128"
    );
    bench.send_ok(&["play now"]);
}

#[test]
fn a_wrong_checksum_of_an_upload_leaves_the_course_before() {
    let mut bench = Bench::armed();
    let begin = "upload begin course 2 absolute";
    let rows = ["upload row 0 0 20", "upload row 1 1 21"];
    let sum = checksum(&[begin, rows[0], rows[1]].map(String::from));
    let wrong = format!("err checksum is {sum:08x}; nothing is changed, upload again");
    bench.send_ok(&[begin, rows[0], rows[1]]);
    assert_eq!(bench.send(&format!("upload commit {:08x}", sum ^ 1)), wrong);
    // The upload has ended, and nothing was loaded.
    assert_eq!(bench.send(&format!("upload commit {sum:08x}")), NOT_BEGUN);
    assert_eq!(bench.send("play now"), NO_COURSE);
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0)]), "ok");
    bench.send_ok(&[begin, rows[0], rows[1]]);
    assert_eq!(bench.send(&format!("upload commit {:08x}", sum ^ 1)), wrong);
    bench.send_ok(&["play now"]);
    assert_eq!(bench.steps(201)[200], 31.0);
}

#[test]
fn a_wrong_checksum_of_a_line_is_refused_with_both_and_nothing_is_done() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0)]), "ok");
    let wrong = "err checksum 00 is wrong, the line has 52; send the line again";
    assert_eq!(bench.send("play now*00"), wrong);
    assert_eq!(bench.state(), "armed");
    bench.send_ok(&["play now*52"]);
    assert_eq!(bench.state(), "stimulus");
}

#[test]
fn half_an_upload_and_a_course_are_lost_by_a_reset() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0)]), "ok");
    bench.send_ok(&["upload begin course 2 absolute", "upload row 0 0 25"]);
    bench.device = Device::new(&tuned_settings());
    bench.handler = CommandHandler::new(tuned_settings());
    assert_eq!(bench.send("upload row 1 1 26"), NOT_BEGUN);
    assert_eq!(bench.send("upload commit 00000000"), NOT_BEGUN);
    bench.arm();
    assert_eq!(bench.send("play now"), NO_COURSE);
}

#[test]
fn an_upload_that_began_before_a_trip_is_refused_at_its_commit() {
    let mut bench = Bench::armed();
    bench.send_ok(&["upload begin course 2 absolute", "upload row 0 0 25", "upload row 1 1 26"]);
    let lines = ["upload begin course 2 absolute", "upload row 0 0 25", "upload row 1 1 26"];
    bench.device.trip_all(Fault::Stack);
    let commit = format!("upload commit {:08x}", checksum(&lines.map(String::from)));
    assert_eq!(bench.send(&commit), "err tripped by stack; clear it first");
}

#[test]
fn a_relative_course_that_leaves_the_range_above_or_below_this_skin_is_refused() {
    let mut bench = Bench::armed();
    bench.send_ok(&["skin 34"]);
    for (points, reached_c) in [
        ([(0.0, -2.0), (0.5, 8.25)], "42.25"),
        ([(0.0, -19.5), (0.5, 1.0)], "14.50"),
        // Both ends; the lower one is named.
        ([(0.0, -20.0), (0.5, 9.0)], "14.00"),
    ] {
        assert_eq!(bench.upload("relative", &points), "ok");
        for order in ["play now", "play trigger", "play landing 3 neutral"] {
            assert_eq!(
                bench.send(order),
                format!(
                    "err with the present skin the course reaches {reached_c} C; 15 to 42 C are allowed"
                )
            );
        }
    }
    // By the sensor, which shows some 34 °C.
    bench.send_ok(&["skin sensor"]);
    assert_eq!(bench.upload("relative", &[(0.0, 0.0), (0.2, 9.0)]), "ok");
    let answer = bench.send("play now");
    let reached_c: f64 = (answer.strip_prefix("err with the present skin the course reaches "))
        .and_then(|rest| rest.strip_suffix(" C; 15 to 42 C are allowed"))
        .and_then(|number| number.parse().ok())
        .expect(&answer);
    assert!((42.5..43.5).contains(&reached_c), "{answer}");
    assert_eq!(bench.state(), "armed");
}

#[test]
fn the_dose_of_a_relative_course_is_that_above_this_skin() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("relative", &[(0.0, 8.0), (160.0, 8.0)]), "ok");
    // 160 s at 42 °C are 40 s at 43 °C, at 40 °C a sixteenth of that.
    bench.send_ok(&["skin 34"]);
    let refused = "err too hot for too long: CEM43 would be 0.67 min; below 0.50 min is allowed";
    assert_eq!(bench.send("play landing"), refused);
    bench.send_ok(&["skin 32", "play landing"]);
}

#[test]
fn a_relative_course_that_stays_below_39_c_gives_no_dose() {
    let mut bench = Bench::armed();
    let hour = [(0.0, 5.0), (3600.0, 5.0)];
    assert_eq!(bench.upload("relative", &hour), "ok");
    bench.send_ok(&["skin 33", "play landing 9"]);
    bench.send_ok(&["skin 34"]);
    // At 39 °C the dose begins: nine hours are 9 / 256 of an hour at 43 °C.
    let refused = "err too hot for too long: CEM43 would be 2.11 min; below 0.50 min is allowed";
    assert_eq!(bench.send("play landing 9"), refused);
}

#[test]
fn a_pulse_is_refused_for_each_of_its_numbers() {
    let mut bench = Bench::armed();
    for (line, answer) in [
        ("pulse 14 30 1 1 1", "err temperature '14' out of range; 15 to 42 C"),
        ("pulse 30 43 1 1 1", "err temperature '43' out of range; 15 to 42 C"),
        ("pulse 30 31 0 1 1", "err rate '0' out of range; 0.01 to 100 K/s"),
        ("pulse 30 31 1 3601 1", "err time '3601' out of range; 0 to 3600 s"),
        ("pulse 30 31 1 1 101", "err rate '101' out of range; 0.01 to 100 K/s"),
        ("pulse 30 31 1 1", "err rate missing; 0.01 to 100 K/s"),
        ("pulse 15 35 0.015625 2400 0.01", "err too long: 3680000 ms; 3600000 ms at most"),
    ] {
        assert_eq!(bench.send(line), answer, "{line}");
    }
    assert_eq!(bench.send("play now"), NO_COURSE);
    assert_eq!(bench.state(), "armed");
}

/// What no order can check beforehand: the skin changes while the course waits.
#[test]
fn a_relative_course_that_a_warmer_skin_takes_beyond_the_range_is_limited_to_it() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("relative", &[(0.0, 0.0), (0.1, 5.0)]), "ok");
    bench.send_ok(&["skin 34", "play landing", "skin 41"]);
    assert_eq!(bench.steps(50)[49], 41.0);
    bench.touching = true;
    let setpoints = bench.steps(200);
    assert_eq!(setpoints[199], 42.0);
    assert!(setpoints.iter().all(|setpoint_c| *setpoint_c <= 42.0));
    assert!(bench.step().limited);
}

/// The display of the bench does not move.
#[test]
fn a_set_point_that_the_display_does_not_follow_is_reported_as_limited() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0)]), "ok");
    bench.send_ok(&["play now"]);
    bench.steps(100);
    let telemetry = bench.step();
    assert_eq!(telemetry.setpoint, Some(Celsius::lit("31")));
    assert!(telemetry.limited);
    assert!(bench.send("state").contains(" setpoint_c=31.00 limited "));
}
