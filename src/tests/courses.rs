//! Courses from their lines to the set-points of a finger.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use contact_model::fixed_point::Celsius;

use super::device::{arm, samples};
use super::objects::checksum;
use crate::device::TriggerEdge;
use crate::device::command::{Command, WithSourceFinger};
use crate::device::drive::BoardOutputs;
use crate::device::events::UnsolicitedReport;
use crate::device::safety::Fault;
use crate::device::sense::{SCANS_PER_TICK, Samples};
use crate::device::{Device, FingerIndex, Telemetry};
use crate::protocol::{CommandHandler, UnsolicitedLine};
use crate::tests::tuned_settings;

pub(super) const FIRST: FingerIndex<1> = FingerIndex::FIRST;

/// An armed device of one finger whose display stays at the temperature of its samples.
pub(super) struct Bench {
    pub(super) device: Device<1>,
    pub(super) handler: CommandHandler<1>,
    tick: u16,
    pub(super) touching: bool,
    current: u16,
    outputs: Vec<BoardOutputs>,
    events: Vec<String>,
}

impl Bench {
    pub(super) fn off() -> Self {
        Self {
            device: Device::new(&tuned_settings()),
            handler: CommandHandler::new(tuned_settings()),
            tick: 0,
            touching: false,
            current: 0,
            outputs: Vec::new(),
            events: Vec::new(),
        }
    }

    pub(super) fn armed() -> Self {
        let mut bench = Self::off();
        bench.arm();
        bench
    }

    pub(super) fn arm(&mut self) {
        arm(&mut self.device, FIRST);
        self.send_ok(&["stream 1", "events on"]);
        self.steps(5);
    }

    pub(super) fn send(&mut self, line: &str) -> String {
        let device = &mut self.device;
        let answer = (self.handler).answer(line, |finger, command| device.execute(finger, command));
        answer.map_or_else(|error| error.to_string(), |reply| reply.to_string())
    }

    pub(super) fn send_ok(&mut self, lines: &[&str]) {
        for line in lines {
            assert_eq!(self.send(line), "ok", "{line}");
        }
    }

    pub(super) fn upload(&mut self, kind: &str, points: &[(f64, f64)]) -> String {
        let (lines, commit) = upload_lines(kind, points);
        for line in &lines {
            let answer = self.send(line);
            if answer != "ok" {
                return answer;
            }
        }
        self.send(&commit)
    }

    /// The line of the next tick's telemetry.
    fn step_and_line(&mut self) -> String {
        let telemetry = UnsolicitedReport::Telemetry(self.step());
        self.unsolicited(WithSourceFinger::from_whole_device(telemetry))
    }

    /// The line of a report.
    fn unsolicited(&mut self, report: WithSourceFinger<UnsolicitedReport>) -> String {
        let device = &mut self.device;
        let line =
            UnsolicitedLine::of_report(report, |finger, command| device.execute(finger, command));
        line.to_string()
    }

    pub(super) fn step(&mut self) -> Telemetry {
        self.tick = self.tick.wrapping_add(1);
        self.device.note_host_activity();
        let untouched = samples(self.tick % 2);
        let force = if self.touching { 450 * SCANS_PER_TICK as u16 } else { 0 };
        let samples =
            Samples { force: untouched.force + force, current: self.current, ..untouched };
        self.outputs.push(self.device.step_finger(FIRST, &samples));
        while let Some(event) = self.device.take_finger_event(FIRST) {
            let line = self.unsolicited(event);
            self.events.push(line);
        }
        let telemetry = self.device.finger_telemetry_if_due(FIRST);
        let telemetry = telemetry.expect("streamed on every tick").content;
        assert_eq!(telemetry.state.fault(), None);
        self.current = (6400.0 * telemetry.demand.to_num::<f64>().abs()) as u16;
        telemetry
    }

    /// Set-points of the next ticks, °C.
    pub(super) fn steps(&mut self, ticks: usize) -> Vec<f64> {
        let setpoint = |bench: &mut Self| bench.step().setpoint.expect("driven").to_num();
        (0..ticks).map(|_| setpoint(self)).collect()
    }

    pub(super) fn state(&mut self) -> String {
        let answer = self.send("state");
        let word = answer.split_ascii_whitespace().nth(1).expect("a state");
        word.trim_start_matches("state=").into()
    }
}

/// Lines that upload a course, and the commit.
pub(super) fn upload_lines(kind: &str, points: &[(f64, f64)]) -> (Vec<String>, String) {
    let mut lines: Vec<_> = [format!("upload begin course {} {kind}", points.len())].into();
    let rows = points.iter().enumerate();
    lines.extend(rows.map(|(index, (t_s, celsius))| format!("upload row {index} {t_s} {celsius}")));
    let commit = format!("upload commit {:08x}", checksum(&lines));
    (lines, commit)
}

fn assert_close(actual_c: f64, expected_c: f64) {
    assert!((actual_c - expected_c).abs() < 1e-5, "{actual_c} °C, expected {expected_c} °C");
}

#[test]
fn a_course_is_followed_between_its_points_and_ends_on_the_last_one() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0), (0.15, 30.5)]), "ok");
    bench.send_ok(&["play now"]);
    let setpoints = bench.steps(400);
    for (tick, expected_c) in
        [(0, 30.0), (50, 30.5), (100, 31.0), (125, 30.75), (150, 30.5), (399, 30.5)]
    {
        assert_close(setpoints[tick], expected_c);
    }
    assert_eq!(bench.state(), "stimulus");
    assert_eq!(bench.events.len(), 2, "{:?}", bench.events);
    let tick_of =
        |event: &str| event.split(' ').nth(1).expect("a tick").parse::<u32>().expect("a number");
    assert_eq!(tick_of(&bench.events[1]) - tick_of(&bench.events[0]), 150);
    assert!(bench.events[0].ends_with(" 0 start") && bench.events[1].ends_with(" 0 end"));
}

#[test]
fn repeats_and_the_end_on_neutral() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 26.0), (0.1, 27.0), (0.2, 26.0)]), "ok");
    bench.send_ok(&["play now 3 neutral"]);
    let setpoints = bench.steps(601);
    for (tick, expected_c) in [(100, 27.0), (200, 26.0), (300, 27.0), (500, 27.0), (600, 26.0)] {
        assert_close(setpoints[tick], expected_c);
    }
    assert_eq!(bench.state(), "armed");
}

#[test]
fn a_course_waits_for_a_landing_and_begins_when_the_force_rose() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (1.0, 40.0)]), "ok");
    bench.send_ok(&["play landing"]);
    assert!(bench.steps(100).iter().all(|setpoint_c| *setpoint_c == 30.0));
    bench.touching = true;
    let before = u32::from(bench.step().tick as u16) - 1;
    let setpoints = bench.steps(50);
    let started = setpoints.iter().position(|setpoint_c| *setpoint_c > 30.0).expect("starts");
    let event = |kind: &str| {
        bench.events.iter().find(|event| event.ends_with(kind)).expect("comes").clone()
    };
    let tick_of =
        |event: String| event.split(' ').nth(1).expect("a tick").parse::<u32>().expect("a number");
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
    assert!(bench.steps(100).iter().all(|setpoint_c| *setpoint_c == 30.0));
    let tick = bench.step().tick;
    bench.outputs.clear();
    bench.device.note_trigger_edge(TriggerEdge { us: 437, ticks_ago: 1 });
    let setpoints = bench.steps(30);
    assert_close(setpoints[20], 30.2);
    let expected = [format!("E {tick} 437 trigger"), format!("E {} 0 start", tick + 1)];
    assert_eq!(bench.events[bench.events.len() - 2..], expected);
    let high: Vec<_> = bench.outputs.iter().map(|outputs| outputs.trigger_output).collect();
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
    let refused = "err with the present skin the course reaches 42.50 C; 15 to 42 C are allowed";
    assert_eq!(bench.send("play now"), refused);
    bench.send_ok(&["arm"]);
    assert_close(bench.steps(10)[9], 41.5);
    bench.send_ok(&["skin sensor", "play now"]);
}

#[test]
fn a_course_is_loaded_while_another_plays_and_a_broken_upload_leaves_the_old_one() {
    let mut bench = Bench::armed();
    // The second segment begins after the upload.
    let points = [(0.0, 26.0), (0.15, 27.5), (0.2, 28.0)];
    assert_eq!(bench.upload("absolute", &points), "ok");
    bench.send_ok(&["play now"]);
    bench.steps(100);
    assert_eq!(bench.upload("absolute", &[(0.0, 24.0), (0.2, 26.0)]), "ok");
    assert_close(bench.steps(100)[99], 27.99);
    // Half an upload.
    bench.send_ok(&["upload begin course 2 absolute", "upload row 0 0 25"]);
    let wrong = bench.send("upload commit 00000000");
    assert_eq!(wrong, "err 1 of 2 rows; nothing is changed, upload again");
    bench.send_ok(&["play now"]);
    assert_close(bench.steps(101)[100], 25.0);
}

#[test]
fn a_course_is_loaded_although_a_fault_trips_the_station_meanwhile() {
    let mut bench = Bench::armed();
    let points: Vec<_> =
        (0..100).map(|point| (0.1 * f64::from(point), 25.0 + 0.02 * f64::from(point))).collect();
    let (lines, commit) = upload_lines("absolute", &points);
    for line in &lines {
        bench.send_ok(&[line]);
    }
    let (device, mut parts) = (&mut bench.device, 0);
    let answer = bench.handler.answer(&commit, |finger, command| {
        parts += u8::from(matches!(command, Command::LoadCourse(Some(_))));
        if parts == 2 {
            device.trip_all(Fault::Stack);
        }
        device.execute(finger, command)
    });
    assert_eq!((answer.is_ok(), parts), (true, 4));
    assert_eq!(bench.state(), "tripped");
    bench.send_ok(&["clear"]);
    bench.arm();
    bench.send_ok(&["play now"]);
    let setpoints = bench.steps(9901);
    assert_close(setpoints[0], 25.0);
    assert_close(setpoints[9900], 26.98);
}

#[test]
fn a_pulse_and_a_course_for_all_fingers_are_executed_by_those_that_are_not_tripped() {
    let settings = tuned_settings();
    let mut device = Device::<2>::new(&settings);
    let mut handler = CommandHandler::<2>::new(settings);
    let second = FingerIndex::new(1).expect("a finger");
    device.trip_all(Fault::Stack);
    let mut send = |device: &mut Device<2>, line: &str| {
        let answer = handler.answer(line, |finger, command| device.execute(finger, command));
        answer.map_or_else(|error| error.to_string(), |reply| reply.to_string())
    };
    assert_eq!(send(&mut device, "@1 clear"), "@1 ok");
    arm(&mut device, second);
    let refused = "@0 err tripped by stack; clear it first";
    assert_eq!(send(&mut device, "pulse 30 31 10 0.05 5"), refused);
    assert!(send(&mut device, "@1 state").contains("state=stimulus"));
    let (lines, commit) = upload_lines("absolute", &[(0.0, 20.0), (1.0, 21.0)]);
    assert_eq!(send(&mut device, &lines[0]), refused);
    assert_eq!(send(&mut device, &lines[1]), "ok");
    assert_eq!(send(&mut device, &lines[2]), "ok");
    assert_eq!(send(&mut device, &commit), refused);
    assert_eq!(send(&mut device, "@1 play now"), "@1 ok");
    device.step_finger(second, &samples(0));
    assert!(send(&mut device, "@1 state").contains("setpoint_c=20.00"));
}

#[test]
fn a_pulse_leaves_the_upload_of_an_object_and_ends_that_of_a_course() {
    let mut bench = Bench::armed();
    let [begin, row] = ["upload begin object 1 0.5", "upload row 0 2 40"];
    let commit = format!("upload commit {:08x}", checksum(&[begin, row].map(String::from)));
    bench.send_ok(&["material copper", begin, "pulse 30 31 10 0.05 5", row]);
    bench.send_ok(&[&commit]);
    assert!(bench.send("state").contains("body=upload"));
    bench.send_ok(&["upload begin course 2 absolute", "pulse 30 31 10 0.05 5"]);
    assert!(bench.send("upload row 0 0 30").starts_with("err no upload has begun"));
}

/// The preset of foam is some kelvins above the display of the bench, which stays at room temperature.
#[test]
fn a_hold_right_after_another_stimulus_does_not_begin_at_the_set_point_of_the_object() {
    for stimulus in ["play landing", "hold 30"] {
        let mut bench = Bench::armed();
        bench.send_ok(&["material foam", "start"]);
        assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0)]), "ok");
        let presented = bench.step();
        let display = presented.display.expect("a reading");
        let preset = presented.setpoint.expect("a preset");
        assert!(preset.abs_diff(display) > Celsius::ONE && !presented.limited);
        bench.send_ok(&[stimulus, "hold 28 1"]);
        let setpoint = bench.step().setpoint.expect("driven");
        assert!(setpoint.abs_diff(display) < Celsius::lit("0.01"));
    }
}

#[test]
fn a_course_that_another_command_replaces_before_its_first_tick_has_not_started() {
    let mut bench = Bench::armed();
    assert_eq!(bench.upload("absolute", &[(0.0, 30.0), (0.1, 31.0)]), "ok");
    bench.send_ok(&["play now", "hold 24"]);
    bench.steps(3);
    assert_eq!(bench.events, [""; 0]);
    let tick = bench.step().tick;
    bench.send_ok(&["play now"]);
    bench.steps(1);
    assert_eq!(bench.events, [format!("E {} 0 start", tick + 1)]);
}

#[test]
fn a_pulse_is_a_course_of_four_points_that_begins_at_once() {
    let mut bench = Bench::armed();
    bench.send_ok(&["pulse 26 27 10 0.05 5"]);
    let setpoints = bench.steps(400);
    for (tick, expected_c) in
        [(0, 26.0), (50, 26.5), (100, 27.0), (150, 27.0), (250, 26.5), (350, 26.0)]
    {
        assert_close(setpoints[tick], expected_c);
    }
    bench.send_ok(&["play now"]);
    assert_close(bench.steps(101)[100], 27.0);
}

#[test]
fn the_host_chooses_the_fields_of_telemetry() {
    let mut bench = Bench::armed();
    bench.send_ok(&["hold 24", "stream 1 display setpoint"]);
    let line = bench.step_and_line();
    let words: Vec<_> = line.split(' ').collect();
    assert_eq!(words.len(), 6, "{line}");
    assert_eq!((words[0], words[2]), ("T", "stimulus"));
    bench.send_ok(&["stream 1"]);
    let line = bench.step_and_line();
    assert_eq!(line.split(' ').count(), 13, "{line}");
    let unknown = "err unknown field 'heat'; known: setpoint display sink skin room force demand current evaluations flux surface finger check";
    assert_eq!(bench.send("stream 1 heat"), unknown);
}
