//! Objects that are no half-space, by the lines that describe them: what a finger on the display then gets.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::device::{arm, samples};
use crate::device::command::AssumedFinger;
use crate::device::sense::{SCANS_PER_TICK, Samples};
use crate::device::{Device, FingerIndex};
use crate::protocol::CommandHandler;
use crate::tests::tuned_settings;

const FIVE: usize = 5;

/// An object of one relaxation that warms as fast as foam, and its checksum by Python's `zlib.crc32`.
const UPLOAD: [&str; 3] =
    ["upload begin object 1 0.5", "upload row 0 2 40000", "upload commit 185a2d42"];

/// CRC-32 (ISO-HDLC) of lines with a line feed after each, bit by bit.
pub fn checksum(lines: &[String]) -> u32 {
    let bytes = (lines.iter()).flat_map(|line| line.bytes().chain([b'\n']));
    !bytes.fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg())
        })
    })
}

/// A device, and the handler that keeps an upload from line to line.
#[derive(Clone)]
struct Bench {
    device: Device<FIVE>,
    handler: CommandHandler<FIVE>,
    tick: u16,
    /// Sum of the current mirror at the current that each finger demanded in the last tick.
    currents: [u16; 2],
}

impl Bench {
    /// Fingers 1 and 2 rest on the same object, copper.
    fn presenting() -> Self {
        let mut device = Device::new(&tuned_settings());
        let fingers = [finger(1), finger(2)];
        fingers.into_iter().for_each(|one| arm(&mut device, one));
        let handler = CommandHandler::new(tuned_settings());
        let mut bench = Self { device, handler, tick: 0, currents: [0; 2] };
        bench.send_ok(&["material copper", "@1 start", "@2 start", "stream 1"]);
        bench.run(5);
        assert!(bench.send("@1 state").contains("state=contact"));
        bench
    }

    fn send(&mut self, line: &str) -> String {
        let device = &mut self.device;
        let answer = (self.handler).answer(line, |finger, command| device.execute(finger, command));
        answer.map_or_else(|error| error.to_string(), |reply| reply.to_string())
    }

    fn send_ok(&mut self, lines: &[&str]) {
        for line in lines {
            let answer = self.send(line);
            assert!(answer.ends_with("ok"), "{line}: {answer}");
        }
    }

    /// Set-points of fingers 1 and 2 after these ticks of a contact under 1.5 N, °C.
    fn run(&mut self, ticks: u16) -> [f64; 2] {
        let mut setpoints = [0.0; 2];
        for _ in 0..ticks {
            self.tick += 1;
            self.device.note_host_activity();
            for (slot, setpoint_c) in setpoints.iter_mut().enumerate() {
                let finger = finger(slot + 1);
                let untouched = samples(self.tick % 2);
                let touched = Samples {
                    force: untouched.force + 450 * SCANS_PER_TICK as u16,
                    current: self.currents[slot],
                    ..untouched
                };
                self.device.step_finger(finger, &touched);
                let telemetry = self.device.finger_telemetry_if_due(finger);
                let telemetry = telemetry.expect("streamed on every tick").content;
                assert_eq!(telemetry.state.fault(), None);
                self.currents[slot] = (6400.0 * telemetry.demand.to_num::<f64>().abs()) as u16;
                *setpoint_c = telemetry.setpoint.expect("driven").to_num();
            }
        }
        setpoints
    }
}

fn finger(index: usize) -> FingerIndex<FIVE> {
    FingerIndex::new(index).expect("one of five fingers")
}

/// Set-points after 100 ticks in which the device was first sent these lines.
fn after(bench: &Bench, lines: &[&str]) -> [f64; 2] {
    let mut bench = bench.clone();
    bench.send_ok(lines);
    bench.run(100)
}

#[test]
fn a_slab_is_refused_before_a_material_is_chosen() {
    let mut bench = Bench {
        device: Device::new(&tuned_settings()),
        handler: CommandHandler::new(tuned_settings()),
        tick: 0,
        currents: [0; 2],
    };
    let line = "object slab 3mm insulated";
    assert_eq!(bench.send(line), "err a slab needs a material first");
    bench.send_ok(&["@1 material copper"]);
    let refused = "@2 err a slab needs a material first";
    assert_eq!(bench.send(&format!("@2 {line}")), refused);
    assert_eq!(bench.send(&format!("@1 {line}")), "@1 ok");
    bench.send_ok(&["material copper"]);
    assert_eq!(bench.send(line), "ok");
    bench.send_ok(&["@2 material foam"]);
    assert_eq!(bench.send(line), "err finger (as @0) missing");
}

#[test]
fn an_addressed_object_is_that_of_its_finger_only() {
    let bench = Bench::presenting();
    let half_space = after(&bench, &["object half-space"]);
    assert_eq!(half_space[0], half_space[1]);
    let slab = after(&bench, &["@1 object slab 0.1mm insulated", "@2 object half-space"]);
    assert_eq!(slab[1], half_space[1]);
    assert!(slab[0] > half_space[0] + 0.1, "a foil soon is as warm as the finger: {slab:?}");
    let [begin, row, commit] = UPLOAD.map(|line| format!("@1 {line}"));
    let uploaded = after(&bench, &[&begin, &row, &commit, "@2 object half-space"]);
    assert_eq!(uploaded[1], half_space[1]);
    assert!(uploaded[0] > half_space[0] + 0.1, "{uploaded:?}");
    let both = after(&bench, &UPLOAD);
    assert_eq!(both, [uploaded[0]; 2]);
}

#[test]
fn a_material_and_half_space_end_a_slab_or_an_upload() {
    let bench = Bench::presenting();
    let half_space = after(&bench, &["object half-space"]);
    for last in ["material copper", "object half-space"] {
        let slab = after(&bench, &["object slab 0.1mm insulated", last]);
        assert_eq!(slab, half_space);
        let lines: Vec<_> = UPLOAD.into_iter().chain([last]).collect();
        assert_eq!(after(&bench, &lines), half_space);
    }
    // A temperature is no shape.
    let slab = after(&bench, &["object slab 0.1mm insulated"]);
    assert_eq!(after(&bench, &["object slab 0.1mm insulated", "object room"]), slab);
}

#[test]
fn the_state_has_the_body_of_the_object() {
    let mut bench = Bench::presenting();
    for (lines, body) in [
        (&["object room"][..], "half-space"),
        (&["object slab 3mm held", "object room"], "slab"),
        // So thick that it is none.
        (&["material granite", "object slab 1000mm held"], "half-space"),
        (&UPLOAD[..2], "half-space"),
        (&UPLOAD, "upload"),
        (&["object slab 3mm held"], "slab"),
        (&["material copper"], "half-space"),
        (&["@2 object slab 3mm held"], "half-space"),
    ] {
        for line in lines {
            bench.send(line);
        }
        let state = bench.send("@1 state");
        assert!(state.ends_with(&format!(" body={body} tile=tuned")), "{lines:?}: {state}");
    }
}

#[test]
fn an_upload_that_is_not_committed_changes_nothing_that_a_finger_feels() {
    let [begin, row, commit] = UPLOAD;
    let bench = Bench::presenting();
    let undisturbed = bench.clone().run(100);
    for lines in [
        &[begin][..],
        &[begin, row],
        &[begin, commit],
        &[begin, row, row, "upload commit 185a2d43"],
        &[begin, "upload row 0 2 40001", commit],
        &[row, commit],
        &[begin, row, "upload commit", "@7 upload commit 185a2d42"],
        // Foam's gain times a thousand.
        &[begin, "upload row 0 2 1000000000", "upload commit cb3d4a3b"],
    ] {
        let mut bench = bench.clone();
        let answers: Vec<_> = lines.iter().map(|line| bench.send(line)).collect();
        let refused = answers.iter().any(|answer| answer.starts_with("err "));
        assert!(refused || lines.last() != Some(&commit), "{lines:?}: {answers:?}");
        assert_eq!(bench.run(100), undisturbed, "{lines:?}");
    }
}

/// The temperatures are the ends of what a line may set; both are far beyond the set-point's.
#[test]
fn an_object_that_no_display_can_be_is_limited_and_trips_nothing() {
    let bench = Bench::presenting();
    for (celsius, limit_c) in [("-20", 15.0), ("60", 42.0)] {
        // It keeps its temperature: no heat of a finger moves it.
        let begin = String::from("upload begin object 0 0");
        let commit = format!("upload commit {:08x}", checksum(core::slice::from_ref(&begin)));
        let mut bench = bench.clone();
        bench.send_ok(&[&format!("object {celsius}"), &begin, &commit]);
        assert_eq!(bench.run(20), [limit_c; 2], "{celsius} C");
        let state = bench.send("@1 state");
        assert!(state.ends_with(" limited body=upload tile=tuned"), "{celsius} C: {state}");
    }
}

#[test]
fn the_checksum_is_that_of_zip_files() {
    let [begin, row, commit] = UPLOAD.map(String::from);
    assert_eq!(format!("upload commit {:08x}", checksum(&[begin, row])), commit);
}

#[test]
fn another_assumed_finger_is_another_set_point() {
    let bench = Bench::presenting();
    let mean = after(&bench, &["finger mean"]);
    let thesis = after(&bench, &["@1 finger thesis", "@2 finger mean"]);
    assert_eq!(thesis[1], mean[1]);
    assert!((thesis[0] - mean[0]).abs() > 0.01, "{thesis:?}");
    // The same one again is no new contact.
    assert_eq!(mean, bench.clone().run(100));
    let mut bench = bench;
    assert_eq!(bench.send("@1 finger"), "@1 ok finger=mean");
    bench.send_ok(&["@1 finger thesis"]);
    assert_eq!(bench.send("@1 finger"), "@1 ok finger=thesis");
    assert_eq!(bench.send("finger"), "@0 ok finger=mean");
}

#[test]
fn another_contact_law_is_another_set_point() {
    let bench = Bench::presenting();
    let nominal = after(&bench, &["contact nominal"]);
    let harder = after(&bench, &["@1 contact 0.95 245000 0", "@2 contact nominal"]);
    assert_eq!(harder[1], nominal[1]);
    assert!((harder[0] - nominal[0]).abs() > 0.01, "{harder:?}");
    let with_gap = after(&bench, &["@1 contact 0.95 122500 1000"]);
    assert!((with_gap[0] - nominal[0]).abs() > 0.01, "{with_gap:?}");
    let again = after(&bench, &["contact 0.9 245000 500", "contact nominal"]);
    assert_eq!(again, nominal);

    let mut bench = bench;
    let told = "ok exponent=0.9000 hardness_pa=245000 gap_w_m2k=500.5";
    bench.send_ok(&["@1 contact 0.9 245000 500.5"]);
    assert_eq!(bench.send("@1 contact"), format!("@1 {told}"));
    // A law belongs to a finger, and Eq. 6-12 to Eq. 6-8.
    bench.send_ok(&["finger thesis"]);
    assert_eq!(
        bench.send("@1 contact 0.9 245000 500"),
        "@1 err contact needs another finger than the thesis's; finger mean first"
    );
    bench.send_ok(&["finger mean"]);
    let nominal = "@1 ok exponent=0.9500 hardness_pa=122500 gap_w_m2k=0.0";
    assert_eq!(bench.send("@1 contact"), nominal);
}

#[test]
fn fingers_have_the_same_tissue_if_both_or_neither_have_layers() {
    let fingers = AssumedFinger::ALL;
    for (a, b) in fingers.iter().flat_map(|a| fingers.iter().map(move |b| (a, b))) {
        let equal = a.body().tissue == b.body().tissue;
        assert_eq!(equal, a.is_layered() == b.is_layered(), "{a:?} {b:?}");
    }
}
