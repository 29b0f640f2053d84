//! Commands to five fingers, each of which is controlled by its own samples.

use std::format;
use std::string::{String, ToString};

use crate::device::drive::{ComparatorTest, Drive};
use crate::device::sense::{SCANS_PER_TICK, Samples};
use crate::device::{Device, FingerIndex};
use crate::protocol::{CommandHandler, UnsolicitedLine};
use crate::tests::tuned_settings;

const FIVE: usize = 5;

fn host<const FINGERS: usize>(device: &mut Device<FINGERS>, line: &str) -> String {
    let mut handler = CommandHandler::<FINGERS>::new(tuned_settings());
    let done = handler.answer(line, |finger, command| device.execute(finger, command));
    done.map_or_else(|error| error.to_string(), |reply| reply.to_string())
}

/// The line of a finger's telemetry, if it is due.
pub fn telemetry_line<const FINGERS: usize>(
    device: &mut Device<FINGERS>,
    finger: FingerIndex<FINGERS>,
) -> Option<String> {
    let report = device.finger_telemetry_if_due(finger)?.into_report();
    let line =
        UnsolicitedLine::of_report(report, |finger, command| device.execute(finger, command));
    Some(line.to_string())
}

/// Samples of a device without a fault: 26 °C, the skin 34 °C, no force. `noise`, in counts, lets
/// them differ from tick to tick, as a sensor's samples do that is not frozen.
pub fn samples(noise: u16) -> Samples {
    let count = |counts: u16| counts * SCANS_PER_TICK as u16;
    Samples {
        display: count(2000) + noise,
        display_check: count(2000) + noise,
        sink: count(2000) + noise,
        skin: count(1650) + noise,
        room: count(2000) + noise,
        force: count(410) + noise,
        current: 0,
        // 12 V.
        supply: count(3464),
        bridge_fault: false,
        emergency_stop: false,
        comparator_side_differs: false,
        scattering_thermistors: 0,
    }
}

/// Arms a finger and simulates, during its self-test, a display that responds to the current and a
/// comparator that works.
pub fn arm<const FINGERS: usize>(device: &mut Device<FINGERS>, finger: FingerIndex<FINGERS>) {
    let number = finger.index_u8();
    host(device, &format!("@{number} arm"));
    // 46 counts per kelvin; 2.7 K/s per ampere.
    let (mut tick, mut cooler, mut current, mut test) = (0, 0.0, 0, ComparatorTest::None);
    while host(device, &format!("@{number} state")).contains("state=self-test") {
        tick += 1;
        let sound = samples(tick % 2);
        let moved = (cooler * 46.0 * 16.0) as i16;
        let outputs = device.step_finger(
            finger,
            &Samples {
                display: sound.display.wrapping_add_signed(moved),
                display_check: sound.display_check.wrapping_add_signed(moved),
                current,
                supply: if test == ComparatorTest::None { sound.supply } else { sound.supply / 3 },
                bridge_fault: test != ComparatorTest::None,
                ..sound
            },
        );
        let asked = match outputs.drive {
            Drive::On(duty) if duty.fraction() > 0.05 => 1,
            Drive::On(duty) if duty.fraction() < -0.05 => -1,
            _ => 0,
        };
        cooler += 2.7e-3 * f64::from(asked);
        current = 6400 * u16::from(asked != 0);
        test = outputs.comparator_test;
    }
}

fn finger(index: usize) -> FingerIndex<FIVE> {
    FingerIndex::new(index).expect("one of five fingers")
}

fn state_of(device: &mut Device<FIVE>, finger: usize) -> String {
    let answer = host(device, &format!("@{finger} state"));
    let words = answer.strip_prefix(&format!("@{finger} ok state=")).expect("an answer");
    words.split(' ').next().expect("a state").into()
}

#[test]
fn a_command_is_executed_by_the_addressed_finger_or_by_all() {
    let mut device = Device::<FIVE>::new(&tuned_settings());
    assert_eq!(host(&mut device, "@3 material abs"), "@3 ok");
    arm(&mut device, finger(3));
    assert_eq!(host(&mut device, "@3 start"), "@3 ok");
    for finger in 0..FIVE {
        let expected = if finger == 3 { "preset" } else { "off" };
        assert_eq!(state_of(&mut device, finger), expected, "{finger}");
    }
    // Finger 0 is the first to refuse: it is not armed. Finger 3 would refuse too, because it has
    // started already.
    assert_eq!(host(&mut device, "start"), "@0 err start needs arm first");
    arm(&mut device, finger(0));
    assert_eq!(host(&mut device, "start"), "@0 err start needs a material first");
    assert_eq!(state_of(&mut device, 3), "preset", "the other fingers have executed it");
    assert_eq!(host(&mut device, "abort"), "ok");
    for finger in 0..FIVE {
        let expected = if [0, 3].contains(&finger) { "ready" } else { "off" };
        assert_eq!(state_of(&mut device, finger), expected, "{finger}");
    }
}

/// A finger that is tripped neither trips the others nor keeps the host's `abort` from them.
#[test]
fn a_fault_at_one_finger_does_not_affect_the_others() {
    let mut device = Device::<FIVE>::new(&tuned_settings());
    FingerIndex::all().for_each(|finger| arm(&mut device, finger));
    for finger in FingerIndex::all() {
        let bridge_fault = finger.index() == 1;
        let drive = device.step_finger(finger, &Samples { bridge_fault, ..samples(0) });
        assert_eq!(drive.drive == Drive::Off, bridge_fault, "{finger:?}");
    }
    assert_eq!(state_of(&mut device, 1), "tripped");
    assert_eq!(host(&mut device, "arm"), "@1 err tripped by bridge; clear it first");
    assert_eq!(host(&mut device, "abort"), "ok");
    for finger in [0, 2, 3, 4].map(finger) {
        assert_eq!(device.step_finger(finger, &samples(1)).drive, Drive::Off, "{finger:?}");
    }
    device.step_finger(finger(1), &samples(1));
    assert_eq!(host(&mut device, "clear"), "ok");
    assert_eq!(state_of(&mut device, 1), "off");
    assert_eq!(host(&mut device, "clear"), "@0 err no fault to clear");
}

#[test]
fn answers_and_telemetry_have_the_address_of_their_finger() {
    let mut device = Device::<FIVE>::new(&tuned_settings());
    assert!(host(&mut device, "id").contains(" fingers=5 "));
    assert!(host(&mut device, "@4 id").starts_with("@4 ok thermal-display "));
    assert!(host(&mut device, "state").starts_with("@0 ok state=off"));
    assert_eq!(
        host(&mut device, "@2 frobnicate me").split(';').next(),
        Some("@2 err unknown command 'frobnicate'")
    );
    for (line, named) in
        [("@5 arm", "5"), ("@ arm", ""), ("@-1 arm", "-1"), ("@01 arm", "01"), ("@x", "x")]
    {
        let refused = format!("err unknown finger '{named}' after @; known: 0 to 4");
        assert_eq!(host(&mut device, line), refused);
    }
    assert_eq!(host(&mut device, "@2"), "@2 err command missing");
    assert_eq!(host(&mut device, "@2 stream 1"), "@2 ok");
    for finger in FingerIndex::all() {
        device.step_finger(finger, &samples(0));
        let line = telemetry_line(&mut device, finger);
        assert_eq!(line.is_some(), finger.index() == 2, "{finger:?}");
        assert!(line.is_none_or(|line| line.starts_with("@2 T 1 off ")));
    }
}

/// The host may still address it as finger 0.
#[test]
fn lines_of_a_single_finger_have_no_address() {
    let mut device = Device::<1>::new(&tuned_settings());
    assert_eq!(host(&mut device, "stream 1"), "ok");
    assert!(host(&mut device, "id").contains(" fingers=1 "));
    assert!(host(&mut device, "state").starts_with("ok state=off"));
    assert_eq!(host(&mut device, "@0 arm"), "@0 ok");
    arm(&mut device, FingerIndex::FIRST);
    assert_eq!(host(&mut device, "@1 arm"), "err unknown finger '1' after @; known: 0 to 0");
    device.step_finger(FingerIndex::FIRST, &samples(0));
    let line = telemetry_line(&mut device, FingerIndex::FIRST).expect("telemetry");
    assert!(line.contains(" armed "), "{line}");
}
