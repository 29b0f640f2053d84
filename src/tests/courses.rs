//! Courses from their lines to the set-points of a finger, and the words of every refusal.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::device::{arm, samples};
use super::objects::checksum;
use crate::device::TriggerEdge;
use crate::device::drive::BoardOutputs;
use crate::device::safety::{Fault, ThermalDose};
use crate::device::sense::{SCANS_PER_TICK, Samples};
use crate::device::{Device, FingerIndex, Telemetry};
use crate::protocol::{CommandHandler, UnaskedLine};
use crate::settings::Settings;

const FIRST: FingerIndex<1> = FingerIndex::FIRST;

/// An armed device of one finger whose display stays at the temperature of its samples.
struct Bench {
    device: Device<1>,
    handler: CommandHandler<1>,
    tick: u16,
    touching: bool,
    current: u16,
    outputs: Vec<BoardOutputs>,
    events: Vec<String>,
}

impl Bench {
    fn off() -> Self {
        Self {
            device: Device::new(&Settings::default()),
            handler: CommandHandler::new(Settings::default()),
            tick: 0,
            touching: false,
            current: 0,
            outputs: Vec::new(),
            events: Vec::new(),
        }
    }

    fn armed() -> Self {
        let mut bench = Self::off();
        arm(&mut bench.device, FIRST);
        bench.send_ok(&["stream 1", "events on"]);
        bench.steps(5);
        bench
    }

    fn send(&mut self, line: &str) -> String {
        let device = &mut self.device;
        let answer = (self.handler).answer(line, |finger, command| device.execute(finger, command));
        answer.map_or_else(|error| error.to_string(), |reply| reply.to_string())
    }

    fn send_ok(&mut self, lines: &[&str]) {
        for line in lines {
            assert_eq!(self.send(line), "ok", "{line}");
        }
    }

    fn upload(&mut self, kind: &str, points: &[(f64, f64)]) -> String {
        let mut lines: Vec<_> = [format!("upload begin course {} {kind}", points.len())].into();
        let rows = points.iter().enumerate();
        lines.extend(
            rows.map(|(index, (t_s, celsius))| format!("upload row {index} {t_s} {celsius}")),
        );
        let commit = format!("upload commit {:08x}", checksum(&lines));
        for line in &lines {
            let answer = self.send(line);
            if answer != "ok" {
                return answer;
            }
        }
        self.send(&commit)
    }

    fn step(&mut self) -> Telemetry {
        self.tick = self.tick.wrapping_add(1);
        self.device.note_host_activity();
        let untouched = samples(self.tick % 2);
        let force = if self.touching {
            450 * SCANS_PER_TICK as u16
        } else {
            0
        };
        let samples = Samples {
            force: untouched.force + force,
            current: self.current,
            ..untouched
        };
        self.outputs.push(self.device.step_finger(FIRST, &samples));
        while let Some(event) = self.device.take_finger_event(FIRST) {
            self.events.push(UnaskedLine(event.content).to_string());
        }
        let telemetry = self.device.finger_telemetry_if_due(FIRST);
        let telemetry = telemetry.expect("streamed on every tick").content;
        assert_eq!(telemetry.state.fault(), None);
        self.current = (6400.0 * telemetry.demand.to_num::<f64>().abs()) as u16;
        telemetry
    }

    /// Set-points of the next ticks, °C.
    fn steps(&mut self, ticks: usize) -> Vec<f64> {
        let setpoint = |bench: &mut Self| bench.step().setpoint.expect("driven").to_num();
        (0..ticks).map(|_| setpoint(self)).collect()
    }

    fn state(&mut self) -> String {
        let answer = self.send("state");
        let word = answer.split_ascii_whitespace().nth(1).expect("a state");
        word.trim_start_matches("state=").into()
    }
}

fn assert_close(actual_c: f64, expected_c: f64) {
    assert!(
        (actual_c - expected_c).abs() < 1e-5,
        "{actual_c} °C, expected {expected_c} °C"
    );
}

#[test]
fn a_course_is_followed_between_its_points_and_ends_on_the_last_one() {
    let mut bench = Bench::armed();
    assert_eq!(
        bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0), (0.15, 30.5)]),
        "ok"
    );
    bench.send_ok(&["play now"]);
    let setpoints = bench.steps(400);
    for (tick, expected_c) in [
        (0, 30.0),
        (50, 30.5),
        (100, 31.0),
        (125, 30.75),
        (150, 30.5),
        (399, 30.5),
    ] {
        assert_close(setpoints[tick], expected_c);
    }
    assert_eq!(bench.state(), "stimulus");
    assert_eq!(bench.events.len(), 2, "{:?}", bench.events);
    let tick_of = |event: &str| {
        event
            .split(' ')
            .nth(1)
            .expect("a tick")
            .parse::<u32>()
            .expect("a number")
    };
    assert_eq!(tick_of(&bench.events[1]) - tick_of(&bench.events[0]), 150);
    assert!(bench.events[0].ends_with(" 0 start") && bench.events[1].ends_with(" 0 end"));
}

#[test]
fn repeats_and_the_end_on_neutral() {
    let mut bench = Bench::armed();
    assert_eq!(
        bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0), (0.2, 30.0)]),
        "ok"
    );
    bench.send_ok(&["play now 3 neutral"]);
    let setpoints = bench.steps(601);
    for (tick, expected_c) in [
        (100, 31.0),
        (200, 30.0),
        (300, 31.0),
        (500, 31.0),
        (600, 30.0),
    ] {
        assert_close(setpoints[tick], expected_c);
    }
    assert_eq!(bench.state(), "armed");
}

#[test]
fn a_course_waits_for_a_landing_and_begins_when_the_force_rose() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (1.0, 40.0)]), "ok");
    bench.send_ok(&["play landing"]);
    assert!(
        bench
            .steps(100)
            .iter()
            .all(|setpoint_c| *setpoint_c == 30.0)
    );
    bench.touching = true;
    let before = u32::from(bench.step().tick as u16) - 1;
    let setpoints = bench.steps(50);
    let started = setpoints
        .iter()
        .position(|setpoint_c| *setpoint_c > 30.0)
        .expect("starts");
    let event = |kind: &str| {
        bench
            .events
            .iter()
            .find(|event| event.ends_with(kind))
            .expect("comes")
            .clone()
    };
    let tick_of = |event: String| {
        event
            .split(' ')
            .nth(1)
            .expect("a tick")
            .parse::<u32>()
            .expect("a number")
    };
    let landed = tick_of(event(" land"));
    assert_eq!(landed, tick_of(event(" start")));
    assert!(landed.abs_diff(before + 1) <= 1, "{landed} {before}");
    // The course has gone on since the landing, also before it was detected.
    let elapsed = before + 2 + started as u32 - landed;
    assert_close(setpoints[started], 30.0 + 0.01 * f64::from(elapsed));
}

#[test]
fn a_course_that_waits_for_the_trigger_begins_at_its_edge_and_marks_it() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0)]), "ok");
    bench.send_ok(&["trigger-out start", "play trigger"]);
    bench.touching = true;
    assert!(
        bench
            .steps(100)
            .iter()
            .all(|setpoint_c| *setpoint_c == 30.0)
    );
    let tick = bench.step().tick;
    bench.outputs.clear();
    bench.device.note_trigger_edge(TriggerEdge {
        us: 437,
        ticks_ago: 1,
    });
    let setpoints = bench.steps(30);
    assert_close(setpoints[20], 30.2);
    let expected = [
        format!("E {tick} 437 trigger"),
        format!("E {} 0 start", tick + 1),
    ];
    assert_eq!(bench.events[bench.events.len() - 2..], expected);
    let high: Vec<_> = bench
        .outputs
        .iter()
        .map(|outputs| outputs.trigger_output)
        .collect();
    assert_eq!(high, [[true; 10], [false; 10], [false; 10]].concat());
}

#[test]
fn a_relative_course_adds_the_skin_and_an_assumed_skin_replaces_the_sensor() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("relative", &[(0.0, -2.0), (0.1, 1.0)]), "ok");
    bench.send_ok(&["skin 33.5", "play now"]);
    let setpoints = bench.steps(200);
    assert_close(setpoints[0], 31.5);
    assert_close(setpoints[199], 34.5);
    bench.send_ok(&["skin 41.5"]);
    let refused = "err above this skin the course reaches 42.50 C; 15 to 42 C";
    assert_eq!(bench.send("play now"), refused);
    bench.send_ok(&["arm"]);
    assert_close(bench.steps(10)[9], 41.5);
    bench.send_ok(&["skin sensor", "play now"]);
}

#[test]
fn a_course_is_loaded_while_another_plays_and_a_broken_upload_leaves_the_old_one() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.2, 32.0)]), "ok");
    bench.send_ok(&["play now"]);
    bench.steps(100);
    assert_eq!(bench.upload("absolute", &[(0.0, 20.0), (0.2, 22.0)]), "ok");
    assert_close(bench.steps(100)[99], 31.99);
    // Half an upload.
    bench.send_ok(&["upload begin course 2 absolute", "upload row 0 0 25"]);
    let wrong = bench.send("upload commit 00000000");
    assert_eq!(wrong, "err 1 of 2 rows; nothing is changed, upload again");
    bench.send_ok(&["play now"]);
    assert_close(bench.steps(101)[100], 21.0);
}

#[test]
fn a_pulse_is_a_course_of_four_points_that_begins_at_once() {
    let mut bench = Bench::armed();
    bench.send_ok(&["pulse 30 31 10 0.05 5"]);
    let setpoints = bench.steps(400);
    for (tick, expected_c) in [
        (0, 30.0),
        (50, 30.5),
        (100, 31.0),
        (150, 31.0),
        (250, 30.5),
        (350, 30.0),
    ] {
        assert_close(setpoints[tick], expected_c);
    }
    bench.send_ok(&["play now"]);
    assert_close(bench.steps(101)[100], 31.0);
}

#[test]
fn every_wrong_course_is_refused_with_its_reason() {
    let mut bench = Bench::armed();
    let begin = "upload begin course 3 absolute";
    assert_eq!(
        bench.send("play now"),
        "err no course is loaded; upload begin course first"
    );
    for (lines, answer) in [
        (
            &["upload begin course 129 absolute"][..],
            "err number of points '129' out of range; 2 to 128 ",
        ),
        (
            &["upload begin course 3"],
            "err temperatures missing; known: absolute relative",
        ),
        (
            &[begin, "upload row 0 1 30", "upload row 1 0.5 30"],
            "err time goes back: the point before is at 1.000 s",
        ),
        (
            &[begin, "upload row 0 0 42.1"],
            "err temperature '42.1' out of range; 15 to 42 C",
        ),
        (
            &[begin, "upload row 0 0 14"],
            "err temperature '14' out of range; 15 to 42 C",
        ),
        (
            &["upload begin course 3 relative", "upload row 0 0 28"],
            "err temperature '28' out of range; -27 to 27 K",
        ),
        (
            &[begin, "upload row 0 0 30", "upload row 1 0.01 32"],
            "err too fast: 200 K/s from the point before; at most 100 K/s",
        ),
        (
            &[begin, "upload row 0 4000 30"],
            "err time '4000' out of range; 0 to 3600 s",
        ),
        (
            &[begin, "upload row 1 0 30"],
            "err not the next row, which is 0",
        ),
        (
            &["play soon"],
            "err unknown start of a course 'soon'; known: now trigger landing",
        ),
        (&["play now 0"], "err repeats '0' out of range; 1 to 1000 "),
        (
            &["play now 2 off"],
            "err unknown end of a course 'off'; known: hold neutral",
        ),
        (
            &["hold 30 0.001"],
            "err rate '0.001' out of range; 0.01 to 100 K/s",
        ),
        (
            &["hold 43"],
            "err temperature '43' out of range; 15 to 42 C",
        ),
        (&["skin"], "err skin missing; sensor or 15 to 42 C"),
        (&["skin cold"], "err skin 'cold': sensor or 15 to 42 C"),
        (
            &["pulse 30 42 1 600 1"],
            "err too hot for too long: CEM43 would be 2.51 min; below 0.50 min is allowed",
        ),
        (
            &["events maybe"],
            "err unknown events 'maybe'; known: on off",
        ),
        (
            &["trigger-out land,touch"],
            "err unknown event 'touch'; known: land lift start end none",
        ),
    ] {
        let (last, before) = lines.split_last().expect("a line");
        bench.send_ok(before);
        assert_eq!(bench.send(last), answer, "{lines:?}");
    }
    let hot = bench.upload("absolute", &[(0.0, 42.0), (160.0, 42.0)]);
    assert_eq!(
        hot,
        "err too hot for too long: CEM43 would be 0.67 min; below 0.50 min is allowed"
    );
    // Nothing was loaded.
    assert_eq!(
        bench.send("play now"),
        "err no course is loaded; upload begin course first"
    );
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
        assert_eq!(
            bench.send(line),
            format!("err {command} needs the state armed")
        );
    }
    // Loading needs no display.
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (1.0, 31.0)]), "ok");
    bench.device.trip_all(Fault::Stack);
    for line in [
        "hold 30",
        "play now",
        "upload begin course 2 absolute",
        "pulse 30 31 1 1 1",
    ] {
        assert_eq!(
            bench.send(line),
            "err tripped by stack; clear it first",
            "{line}"
        );
    }
    // The upload has not begun.
    assert!(
        bench
            .send("upload row 0 0 30")
            .starts_with("err no upload has begun")
    );
}

#[test]
fn what_the_finger_would_feel_is_refused_while_a_course_plays_and_allowed_while_it_is_held() {
    let mut bench = Bench::armed();
    bench.send_ok(&["pulse 30 31 10 0.05 5"]);
    let refused = "err not while an object or a course is presented: abort or arm first";
    assert_eq!(bench.send("set tile 2.7 0.03 0.2 0.1 0.01"), refused);
    bench.steps(400);
    assert!(!bench.send("calibrate display 24").contains("presented"));
}

#[test]
fn the_host_chooses_the_fields_of_telemetry() {
    let mut bench = Bench::armed();
    bench.send_ok(&["hold 24", "stream 1 display setpoint"]);
    let telemetry = bench.step();
    let line = UnaskedLine(crate::device::events::UnaskedReport::Telemetry(telemetry)).to_string();
    let words: Vec<_> = line.split(' ').collect();
    assert_eq!(words.len(), 6, "{line}");
    assert_eq!((words[0], words[2]), ("T", "stimulus"));
    bench.send_ok(&["stream 1"]);
    let telemetry = bench.step();
    let line = UnaskedLine(crate::device::events::UnaskedReport::Telemetry(telemetry)).to_string();
    assert_eq!(line.split(' ').count(), 13, "{line}");
    let unknown = "err unknown field 'heat'; known: setpoint display sink skin room force demand current evaluations";
    assert_eq!(bench.send("stream 1 heat"), unknown);
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
