//! Tests of a device with several fingers: addressing, and independence of the fingers.

use std::format;
use std::string::{String, ToString};

use crate::device::Device;
use crate::device::drive::Drive;
use crate::device::sense::SCANS_PER_TICK;
use crate::device::sense::Samples;
use crate::protocol::{CommandHandler, telemetry_line};
use crate::settings::Settings;

const FIVE: usize = 5;

/// Sends a line to a device with factory defaults, and returns the answer.
fn send<const FINGERS: usize>(device: &mut Device<FINGERS>, line: &str) -> String {
    let mut handler = CommandHandler::<FINGERS>::new(Settings::default());
    let answer = handler.answer(line, |request| device.execute(request));
    answer.map_or_else(|error| error.to_string(), |reply| reply.to_string())
}

/// Samples without a fault: skin at 34 °C, all else at 26 °C, no force. `noise` is added to each, so that they can differ from
/// tick to tick.
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
        bridge_fault: false,
    }
}

/// Arms a finger whose display responds to the current and whose comparator works.
pub fn arm<const FINGERS: usize>(device: &mut Device<FINGERS>, finger: usize) {
    send(device, &format!("@{finger} arm"));
    // 46 counts/K, 2.7 K/s per ampere.
    let (mut tick, mut cooled_k, mut current, mut bridge_fault) = (0, 0.0, 0, false);
    while send(device, &format!("@{finger} state")).contains("state=self-test") {
        tick += 1;
        let healthy = samples(tick % 2);
        let cooled_counts = (cooled_k * 46.0 * 16.0) as i16;
        let outputs = device.step(
            finger,
            &Samples {
                display: healthy.display.wrapping_add_signed(cooled_counts),
                display_check: healthy.display_check.wrapping_add_signed(cooled_counts),
                current,
                bridge_fault,
                ..healthy
            },
        );
        let direction = match outputs.drive {
            Drive::On(duty) if duty.fraction() > 0.05 => 1,
            Drive::On(duty) if duty.fraction() < -0.05 => -1,
            _ => 0,
        };
        cooled_k += 2.7e-3 * f64::from(direction);
        current = 6400 * u16::from(direction != 0);
        bridge_fault = outputs.comparator_test;
    }
}

fn state_of(device: &mut Device<FIVE>, finger: usize) -> String {
    let answer = send(device, &format!("@{finger} state"));
    let words = answer
        .strip_prefix(&format!("@{finger} ok state="))
        .expect("an answer");
    words.split(' ').next().expect("a state").into()
}

#[test]
fn a_line_is_executed_by_the_addressed_finger_or_by_all() {
    let mut device = Device::<FIVE>::new(&Settings::default());
    assert_eq!(send(&mut device, "@3 material abs"), "@3 ok");
    arm(&mut device, 3);
    assert_eq!(send(&mut device, "@3 start"), "@3 ok");
    for finger in 0..FIVE {
        let expected = if finger == 3 { "preset" } else { "off" };
        assert_eq!(state_of(&mut device, finger), expected, "{finger}");
    }
    // All refuse: four are not armed, finger 3 has already started. The error is that of the first.
    assert_eq!(send(&mut device, "start"), "@0 err start needs arm first");
    arm(&mut device, 0);
    assert_eq!(
        send(&mut device, "start"),
        "@0 err start needs a material first"
    );
    assert_eq!(
        state_of(&mut device, 3),
        "preset",
        "the others have executed it"
    );
    assert_eq!(send(&mut device, "abort"), "ok");
    for finger in 0..FIVE {
        let expected = if [0, 3].contains(&finger) {
            "ready"
        } else {
            "off"
        };
        assert_eq!(state_of(&mut device, finger), expected, "{finger}");
    }
}

/// `abort` reaches the fingers after the one that is tripped.
#[test]
fn a_fault_trips_only_its_own_finger() {
    let mut device = Device::<FIVE>::new(&Settings::default());
    (0..FIVE).for_each(|finger| arm(&mut device, finger));
    for finger in 0..FIVE {
        let bridge_fault = finger == 1;
        let drive = device.step(
            finger,
            &Samples {
                bridge_fault,
                ..samples(0)
            },
        );
        assert_eq!(drive.drive == Drive::Off, finger == 1, "{finger}");
    }
    assert_eq!(state_of(&mut device, 1), "tripped");
    assert_eq!(
        send(&mut device, "arm"),
        "@1 err tripped by bridge; clear it first"
    );
    assert_eq!(send(&mut device, "abort"), "ok");
    for finger in [0, 2, 3, 4] {
        assert_eq!(
            device.step(finger, &samples(1)).drive,
            Drive::Off,
            "{finger}"
        );
    }
    device.step(1, &samples(1));
    assert_eq!(send(&mut device, "clear"), "ok");
    assert_eq!(state_of(&mut device, 1), "off");
    assert_eq!(send(&mut device, "clear"), "@0 err no fault to clear");
}

#[test]
fn answers_and_telemetry_carry_the_address_of_their_finger() {
    let mut device = Device::<FIVE>::new(&Settings::default());
    assert!(send(&mut device, "id").contains(" fingers=5 "));
    assert!(send(&mut device, "@4 id").starts_with("@4 ok thermal-display "));
    assert!(send(&mut device, "state").starts_with("@0 ok state=off"));
    assert_eq!(
        send(&mut device, "@2 frobnicate me").split(';').next(),
        Some("@2 err unknown command 'frobnicate'")
    );
    for (line, named) in [
        ("@5 arm", "5"),
        ("@ arm", ""),
        ("@-1 arm", "-1"),
        ("@01 arm", "01"),
        ("@x", "x"),
    ] {
        let refused = format!("err unknown finger '{named}' after @; known: 0 to 4");
        assert_eq!(send(&mut device, line), refused);
    }
    assert_eq!(send(&mut device, "@2"), "@2 err command missing");
    assert_eq!(send(&mut device, "@2 stream 1"), "@2 ok");
    for finger in 0..FIVE {
        device.step(finger, &samples(0));
        let line = device
            .telemetry(finger)
            .map(|telemetry| telemetry_line(telemetry).to_string());
        assert_eq!(line.is_some(), finger == 2, "{finger}");
        assert!(line.is_none_or(|line| line.starts_with("@2 T 1 off ")));
    }
}

/// It may still be addressed as finger 0.
#[test]
fn a_single_finger_answers_without_an_address() {
    let mut device = Device::<1>::new(&Settings::default());
    assert_eq!(send(&mut device, "stream 1"), "ok");
    assert!(send(&mut device, "id").contains(" fingers=1 "));
    assert!(send(&mut device, "state").starts_with("ok state=off"));
    assert_eq!(send(&mut device, "@0 arm"), "@0 ok");
    arm(&mut device, 0);
    assert_eq!(
        send(&mut device, "@1 arm"),
        "err unknown finger '1' after @; known: 0 to 0"
    );
    device.step(0, &samples(0));
    let line = telemetry_line(device.telemetry(0).expect("telemetry")).to_string();
    assert!(line.contains(" armed "), "{line}");
}
