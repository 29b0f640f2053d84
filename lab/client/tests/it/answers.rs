//! What the client makes of answers, and of what comes in their place.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use thermal_client::client::{
    BoardReport, Client, ClientError, ClockSource, DeviceRequest, EnrolPerson, FluxReport,
    PersonData, PersonReport, PersonRequest, QueryBoard, QueryCause, QueryDisplaySurface,
    QueryFlux, QueryIdentity, QueryPerson, QueryPersons, QueryRaw, QuerySelfTest, QueryState,
    SessionRequest, StationRequest, Telemetry, Watchdogs, upload_course,
};
use thermal_client::link::{Interruptible, LineSplitter, Link, LinkError, ReceivedLine};
use thermal_device::StateName;
use thermal_device::events::DeviceEventKind;
use thermal_device::learning::{FingerKnowledge, FluxSensorTest};
use thermal_device::safety::{Fault, SelfTestResult, SideLine};
use thermal_device::stimulus::TemperatureKind;
use thermal_settings::{DisplaySurface, FluxSensor, Person, PersonCode};

use crate::fake_device::{FakeDevice, answers, knows};

#[test]
fn a_refusal_has_the_devices_text() {
    let mut client = knows(&[("start", "err start needs arm first")]);
    let error = client.ask(&StationRequest::Start).unwrap_err();
    assert_eq!(error.refusal(), Some("start needs arm first"));
    assert_eq!(error.to_string(), "the device answers 'start' with 'err start needs arm first'");
}

#[test]
fn a_device_that_does_not_answer_is_given_up_after_two_seconds() {
    let mut client = FakeDevice::client(|_| Vec::new());
    let error = client.ask(&StationRequest::Arm).unwrap_err();
    assert!(matches!(error, ClientError::TimedOut { .. }), "{error}");
    assert_eq!(error.to_string(), "the device does not answer 'arm' within 2 s");
}

/// Without this, every answer after a lost second would be taken for that of the line after it.
#[test]
fn a_late_answer_is_not_taken_for_that_of_the_next_line() {
    // A device answers in order.
    let mut client = FakeDevice::client(|line| match line {
        "law" => vec![(2500, "ok law=pi".into())],
        "finger" => vec![(200, "ok finger=mean".into())],
        other => vec![(200, format!("err unknown command '{other}'; known: id"))],
    });
    assert!(client.query("law").is_err());
    // The late answer comes half a second after the client has given it up.
    client.wait(Duration::from_millis(400)).unwrap();
    assert_eq!(client.query("finger").unwrap(), "ok finger=mean");
    assert_eq!(client.query("finger").unwrap(), "ok finger=mean");
}

/// A client of a device that may be running.
fn attached(script: impl FnMut(&str) -> Vec<(u64, String)> + 'static) -> Client<FakeDevice> {
    Client::attach(FakeDevice::client(script).into_link()).unwrap()
}

/// The device answers an earlier client's lines after the next one has come.
#[test]
fn answers_to_an_earlier_client_are_not_taken_for_its_own() {
    let unknown = |line: &str| format!("err unknown command '{line}'; known: id");
    let mut earlier = attached(move |line| answers(&unknown(line)));
    let (_, word) = earlier.link().sent.pop().unwrap();
    let mut client = attached(move |line| match line {
        "" => vec![(1, unknown(&word)), (1, "ok law=model".into())],
        "law" => answers("ok law=pi"),
        other => answers(&unknown(other)),
    });
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
}

/// The device has executed `checksum on`, and its answer was lost: without more the client would be refused from then on.
#[test]
fn a_lost_answer_to_checksum_on_does_not_leave_both_ends_apart() {
    let (mut is_on, mut is_lost) = (false, false);
    let mut client = FakeDevice::client(move |line| {
        let (content, has_sum) = match line.split_once('*') {
            Some((content, _)) => (content, true),
            None => (line, false),
        };
        let answer = match content {
            _ if is_on && !has_sum => "err checksum missing".to_owned(),
            "checksum on" | "checksum off" => {
                is_on = content == "checksum on";
                "ok".into()
            }
            "state" => "ok state=ready fault=-".into(),
            other => format!("err unknown command '{other}'; known: id"),
        };
        if content == "checksum on" && !std::mem::replace(&mut is_lost, true) {
            return Vec::new();
        }
        answers(&answer)
    });
    assert!(client.ask(&DeviceRequest::Checksum { switch: true.into() }).is_err());
    assert_eq!(client.query("state").unwrap(), "ok state=ready fault=-");
}

#[test]
fn something_that_always_answers_is_no_display_after_two_seconds() {
    for text in ["ok", "err x", "ok T:20"] {
        let mut device = FakeDevice::client(|_| Vec::new()).into_link();
        for half_seconds in 1..20 {
            device.sends(500 * half_seconds, text);
        }
        let error = Client::attach(device).map(|_| ()).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("this does not answer as a thermal display: '{text}'")
        );
    }
}

/// An error repeats 20 characters of a word, and the same time passes for each client of a simulated device.
#[test]
fn the_word_that_synchronizes_has_20_characters_and_is_another_each_time() {
    let mut words = Vec::new();
    for _ in 0..3 {
        let mut client = attached(|line| answers(&format!("err unknown command '{line}'")));
        let (_, word) = client.link().sent.pop().unwrap();
        assert_eq!(word.len(), 20, "{word}");
        assert!(!words.contains(&word), "{words:?}");
        words.push(word);
    }
}

#[test]
fn a_number_of_fingers_that_no_device_has_is_not_understood() {
    for fingers in ["0", "6", "255", "4000000000", "-1"] {
        let identity =
            format!("ok thermal-display 0.2.0 fingers={fingers} tick_hz=1000 scan_hz=16000");
        let mut client = FakeDevice::client(move |line| match line {
            "id" => answers(&identity),
            line => answers(&format!("err unknown command '{line}'")),
        });
        let error = client.ask(&QueryIdentity).unwrap_err();
        assert!(matches!(error, ClientError::NotUnderstood { .. }), "{fingers}: {error}");
    }
}

/// Every answer comes twice, also that to the word which synchronizes answers with lines.
#[test]
fn answers_that_come_twice_are_not_taken_for_those_of_later_questions() {
    let mut client = FakeDevice::client(|line| {
        let answer = match line {
            "abort" | "checksum off*42" => "ok".into(),
            "id" => "ok thermal-display 0.2.0 fingers=1 tick_hz=1000 scan_hz=16000".into(),
            "state" => "ok state=ready fault=- material=- object_c=room mode=contact setpoint_c=- body=half-space".into(),
            line => format!("err unknown command '{line}'"),
        };
        [answers(&answer), answers(&answer)].concat()
    });
    for _ in 0..3 {
        client.switch_off().unwrap();
    }
}

/// Each answer takes 1.9 s, which is in time for one.
#[test]
fn a_bridge_that_is_not_confirmed_to_be_off_in_six_seconds_is_said() {
    let mut client = FakeDevice::client(|line| match line {
        "abort" => vec![(1900, "ok".into())],
        "id" => {
            vec![(1900, "ok thermal-display 0.2.0 fingers=1 tick_hz=1000 scan_hz=16000".into())]
        }
        "state" => vec![(2500, "ok".into())],
        line => vec![(1900, format!("err unknown command '{line}'"))],
    });
    let error = client.switch_off().unwrap_err();
    assert!(matches!(error, ClientError::NotOff { .. }), "{error}");
    let passed_s = client.link().now().as_secs_f64();
    assert!((5.9..6.1).contains(&passed_s), "{passed_s}");
}

#[test]
fn what_is_no_answer_is_shown() {
    let garbage = |_: &str| answers("\u{fffd}\u{fffd}ok?\u{1}");
    let error = FakeDevice::client(garbage).ask(&StationRequest::Arm).unwrap_err();
    assert!(matches!(error, ClientError::NotUnderstood { .. }));
    assert!(error.to_string().contains("ok?"), "{error}");
    // An answer of another form.
    let mut client = knows(&[("state", "ok state=melted fault=-")]);
    assert_eq!(
        client.ask(&QueryState).unwrap_err().to_string(),
        "the answer to 'state' is not understood: 'ok state=melted fault=-'"
    );
    let mut client = knows(&[("arm", "ok 7")]);
    assert!(matches!(
        client.ask(&StationRequest::Arm).unwrap_err(),
        ClientError::NotUnderstood { .. }
    ));
}

/// A terminal that prints these would change its title, ring, or write from right to left.
#[test]
fn control_characters_of_a_device_are_shown_by_their_numbers() {
    const HOSTILE: &str = "err \u{1b}]0;title\u{7} \u{9b}2J \u{202e}off\u{7f}";
    let shown = r"err \u{1b}]0;title\u{7} \u{9b}2J \u{202e}off\u{7f}";
    let mut client = knows(&[("arm", HOSTILE)]);
    let error = client.ask(&StationRequest::Arm).unwrap_err();
    assert_eq!(error.to_string(), format!("the device answers 'arm' with '{shown}'"));
    assert_eq!(client.query("arm").unwrap(), shown);
    let garbage = |_: &str| answers("\u{1b}c");
    let error = FakeDevice::client(garbage).ask(&StationRequest::Arm).unwrap_err();
    assert_eq!(error.to_string(), r"the answer to 'arm' is not understood: '\u{1b}c'");
}

#[test]
fn garbage_before_an_answer_is_counted_and_skipped() {
    let mut client = FakeDevice::client(|_| {
        ["", "rtfm", "T 12 armed 3", "k", "ok"].map(|line| (1, line.to_owned())).into()
    });
    client.ask(&StationRequest::Arm).unwrap();
    assert_eq!(client.counts().damaged, 3);
}

#[test]
fn the_answer_of_another_finger_is_not_taken() {
    let mut client = knows(&[
        ("@2 arm", "@2 ok"),
        ("@3 arm", "@2 ok"),
        ("@1 law", "@1 err tripped by dose; clear it first"),
        ("abort", "@3 err busy"),
    ]);
    client.ask_finger(Some(2), &StationRequest::Arm).unwrap();
    assert!(client.ask_finger(Some(3), &StationRequest::Arm).is_err());
    assert_eq!(client.ask(&StationRequest::Abort).unwrap_err().refusal(), Some("busy"));
}

#[test]
fn lines_that_no_device_takes_are_not_sent() {
    let mut client = knows(&[]);
    for line in ["", " ", "a\nb", "h\u{e4}", &"x".repeat(97)] {
        let error = client.query(line).unwrap_err();
        assert!(matches!(error, ClientError::Unsendable { .. }), "{line}");
    }
    assert!(client.link().sent.is_empty());
    assert!(client.query(&"x".repeat(96)).is_ok());
}

#[test]
fn a_link_that_vanishes_is_an_error_at_once_and_the_reason_is_given() {
    let mut client = FakeDevice::client(|_| Vec::new());
    client.link().vanishes_at = Some(Duration::from_millis(300));
    let gone = ClientError::Link(LinkError::Gone("unplugged".into()));
    assert_eq!(client.ask(&StationRequest::Arm).unwrap_err(), gone);
    assert!(client.wait(Duration::from_secs(1)).is_err());
    assert!(client.next_telemetry(Duration::from_secs(1)).is_err());
}

#[test]
fn a_client_that_attaches_ends_the_line_of_its_predecessor_and_skips_its_answers() {
    let mut fake = FakeDevice::client(|line| match line {
        "" => Vec::new(),
        "half a line" => answers("err unknown command 'half'; known: id"),
        "law" => answers("ok law=pi"),
        other => answers(&format!("err unknown command '{other}'; known: id")),
    });
    use thermal_client::link::Link;
    fake.link().send(b"half a line").unwrap();
    fake.link().sends(0, "17 armed - - - - - - 0 0 0 -");
    fake.link().sends(0, "ok finger=mean");
    let requested = Arc::new(AtomicBool::new(false));
    let link = Interruptible::new(fake.into_link(), Arc::clone(&requested));
    let mut client = Client::attach(link).unwrap();
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
    // An interruption ends one wait, and the device can be told to stop.
    requested.store(true, Ordering::Relaxed);
    assert_eq!(client.wait(Duration::from_secs(5)), Err(LinkError::Interrupted));
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
}

#[test]
fn lines_arrive_in_parts_and_endless_ones_do_not_fill_the_memory() {
    let mut splitter = LineSplitter::default();
    splitter.received().extend(b"ok sta");
    assert!(splitter.complete().is_empty());
    splitter.received().extend(b"te=off\r\nT 1\n\nhal");
    assert_eq!(splitter.complete(), ["ok state=off", "T 1", ""]);
    splitter.received().extend(b"f\n\xff\xfe\n");
    assert_eq!(splitter.complete(), ["half", "\u{fffd}\u{fffd}"]);
    for _ in 0..10_000 {
        splitter.received().extend([b'x'; 100]);
        splitter.complete();
        assert!(splitter.received().len() < 2000);
    }
}

#[test]
fn with_checksums_damaged_answers_are_not_taken() {
    // Checksums by hand: the exclusive or of all bytes, as in NMEA 0183.
    let sum = |text: &str| format!("{text}*{:02X}", text.bytes().fold(0, |sum, byte| sum ^ byte));
    assert_eq!(sum("ok"), "ok*04");
    let mut client = FakeDevice::client(move |line| match line {
        "checksum on" => answers("ok*04"),
        "law*7A" => {
            vec![(1, "ok law=pi*00".into()), (2, "ok law=pi".into()), (3, sum("ok law=model"))]
        }
        "checksum off*42" => answers("ok"),
        "law" => answers("ok law=pi"),
        other => answers(&format!("err unknown command '{other}'")),
    });
    client.ask(&DeviceRequest::Checksum { switch: true.into() }).unwrap();
    assert_eq!(client.query("law").unwrap(), "ok law=model");
    assert_eq!(client.counts().damaged, 2);
    client.ask(&DeviceRequest::Checksum { switch: false.into() }).unwrap();
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
}

#[test]
fn abort_is_sent_to_a_device_whose_answers_do_not_come_through() {
    let mut client = FakeDevice::client(|_| Vec::new());
    client.ask(&StationRequest::hold(41.0, None)).unwrap_err();
    client.ask(&StationRequest::Abort).unwrap_err();
    client.ask_finger(Some(2), &StationRequest::Abort).unwrap_err();
    let sent = &client.link().sent;
    for abort in ["abort", "@2 abort"] {
        assert!(sent.iter().any(|(_, line)| line == abort), "{sent:?}");
    }
}

/// A restarted device sends no checksums, until it is told to again.
#[test]
fn a_device_that_restarts_while_checksums_are_on_is_reached_again() {
    let (mut on, mut answered) = (false, 0);
    let mut client = FakeDevice::client(move |line| {
        let (line, _) = line.split_once('*').unwrap_or((line, ""));
        answered += 1;
        on = answered != 3 && (on || line == "checksum on");
        let answer = match line {
            "checksum on" => "ok".into(),
            "law" => "ok law=pi".into(),
            other => format!("err unknown command '{other}'; known: id"),
        };
        let sum = answer.bytes().fold(0, |sum, byte| sum ^ byte);
        answers(&if on { format!("{answer}*{sum:02X}") } else { answer })
    });
    client.ask(&DeviceRequest::Checksum { switch: true.into() }).unwrap();
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
    // Restarts before this line.
    assert!(client.query("law model").is_err());
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
}

/// A `save` that is sent again could be executed twice, a question and a row of an upload cannot do harm.
#[test]
fn only_questions_and_numbered_lines_are_sent_again_after_a_damaged_line() {
    let sent_as_often = |line: &'static str| {
        let mut damaged = false;
        let mut client = FakeDevice::client(move |received| {
            let (content, _) = received.split_once('*').unwrap_or((received, ""));
            let answer = match content {
                _ if content == line && !damaged => {
                    damaged = true;
                    "err checksum 00 is wrong, the line has 01; send the line again".into()
                }
                _ if content.starts_with("sync") => format!("err unknown command '{content}'"),
                _ => String::from("ok"),
            };
            let sum = answer.bytes().fold(0, |sum, byte| sum ^ byte);
            answers(&format!("{answer}*{sum:02X}"))
        });
        client.ask(&DeviceRequest::Checksum { switch: true.into() }).unwrap();
        let accepted = client.query(line).unwrap() == "ok";
        let sent = &client.link().sent;
        let times = sent.iter().filter(|(_, sent)| sent.starts_with(line)).count();
        (times, accepted)
    };
    for line in [
        "state",
        "@2 cause",
        "settings 3",
        "upload row 5 1.000 30.000000",
        "contact",
        "flux",
        "surface",
        "person",
        "@1 person",
        "persons",
    ] {
        assert_eq!(sent_as_often(line), (2, true), "{line}");
    }
    for line in [
        "save",
        "arm",
        "play now",
        "law pi",
        "calibrate display 30",
        "tune result",
        "contact nominal",
        "flux zero",
        "person enrol P07",
        "person none",
    ] {
        assert_eq!(sent_as_often(line), (1, false), "{line}");
    }
}

#[test]
fn events_and_telemetry_of_chosen_fields_are_read() {
    let mut client = knows(&[("stream 5 setpoint demand", "ok"), ("events on", "ok")]);
    client.ask(&StationRequest::stream_fields(5, &["demand", "setpoint"])).unwrap();
    client.ask(&StationRequest::events(true)).unwrap();
    client.link().sends(1, "E 1000 437 trigger");
    client.link().sends(2, "T 1005 stimulus 30.50000 -1.250 limited");
    let received = client.next_telemetry(Duration::from_millis(10)).unwrap().unwrap();
    let telemetry = received.telemetry;
    assert_eq!((telemetry.setpoint_c, telemetry.display_c), (Some(30.5), None));
    assert!(telemetry.limited && telemetry.state == StateName::Stimulus);
    assert_eq!((telemetry.demand_a, telemetry.current_a), (Some(-1.25), None));
    assert_eq!(telemetry.evaluations, None);
    assert_eq!((telemetry.flux_w_m2, telemetry.surface_c, telemetry.known), (None, None, None));
    let event = client.take_event().unwrap().event;
    assert_eq!((event.tick, event.microseconds, event.kind), (1000, 437, DeviceEventKind::Trigger));
    assert_eq!(client.take_event(), None);
    assert_eq!(client.counts().damaged, 0);
}

#[test]
fn a_course_is_uploaded_as_the_device_reads_it() {
    let points = [(0.0, 33.0), (2.0, 25.0), (12.0, 25.0)];
    let lines: Vec<_> =
        upload_course(TemperatureKind::Absolute, &points).iter().map(ToString::to_string).collect();
    // The checksum is that of Python's `zlib.crc32`.
    assert_eq!(
        lines,
        [
            "upload begin course 3 absolute",
            "upload row 0 0.000 33.000000",
            "upload row 1 2.000 25.000000",
            "upload row 2 12.000 25.000000",
            "upload commit d60e5903",
        ]
    );
}

#[test]
fn the_answers_for_diagnosis_are_read() {
    let mut client = knows(&[
        (
            "id",
            "ok thermal-display 0.2.0 fingers=1 tick_hz=1000 scan_hz=16000 protocol=1 capabilities=upload,checksum,raw",
        ),
        (
            "self-test",
            "ok hot_cut_ms=1 hot_supply_v=0.42 hot_release_ms=2 cold_cut_ms=- cold_supply_v=- cold_release_ms=- supply_v=11.9 cool_a=- warm_a=- display_k=- check_k=- result=comparator",
        ),
        (
            "raw",
            "ok display=2048.25 check=2047.5 sink=1900 skin=1500 room=2000 force=410.06 current=0 supply=2730 stop=0 fault_line=1",
        ),
        (
            "board",
            "ok bor=3 watchdogs=running clock=hse pwm_lock=1 reset=power rx_overruns=0 rx_framing=1 rx_noise=2 tx_dropped=3 uid=00230041513250132032364E program=0123abcd",
        ),
        (
            "cause",
            "ok cause=display-hot tick=1234 display_c=43.10 check_c=42.90 sink_c=- current_a=5.990 asked_a=-6.000",
        ),
    ]);
    let identity = client.ask(&QueryIdentity).unwrap();
    assert_eq!((identity.fingers, identity.protocol, identity.scan_hz), (1, Some(1), 16_000));
    assert!(identity.can("raw") && !identity.can("ra") && !identity.can("board"));
    let test = client.ask(&QuerySelfTest).unwrap();
    assert_eq!(test.result, SelfTestResult::Failed(Fault::Comparator));
    assert_eq!((test.hot_supply_v, test.cold_cut_ms), (Some(0.42), None));
    assert_eq!(test.side, None, "firmware that does not report it");
    let mut newer = knows(&[(
        "self-test",
        "ok hot_cut_ms=1 hot_supply_v=0.42 hot_release_ms=2 cold_cut_ms=- cold_supply_v=- cold_release_ms=- side=low supply_v=11.9 cool_a=- warm_a=- display_k=- check_k=- result=comparator",
    )]);
    let test = newer.ask(&QuerySelfTest).unwrap();
    assert_eq!(test.side, Some(SideLine::StuckLow));
    assert_eq!(test.flux, None, "a device without the sensor");
    let mut fitted = knows(&[(
        "self-test",
        "ok hot_cut_ms=1 hot_supply_v=4.1 hot_release_ms=1 cold_cut_ms=1 cold_supply_v=4.1 cold_release_ms=1 side=ok supply_v=12.0 cool_a=1.00 warm_a=1.00 display_k=0.54 check_k=0.54 result=passed flux=zero",
    )]);
    let test = fitted.ask(&QuerySelfTest).unwrap();
    assert_eq!(test.flux, Some(FluxSensorTest::Zero));
    let raw = client.ask(&QueryRaw).unwrap();
    assert_eq!((raw.display, raw.supply), (2048.25, 2730.0));
    assert!(raw.fault_line && !raw.stop);
    let board = BoardReport {
        bor: 3,
        watchdogs: Watchdogs::Running,
        clock: ClockSource::External,
        pwm_lock: 1,
        reset: "power".into(),
        rx_overruns: 0,
        rx_framing: 1,
        rx_noise: 2,
        tx_dropped: 3,
        uid: Some("00230041513250132032364E".into()),
        program: Some("0123abcd".into()),
    };
    assert_eq!(client.ask(&QueryBoard).unwrap(), board);
    let flux = |text: String| FakeDevice::client(move |_| answers(&text)).ask(&QueryFlux);
    assert_eq!(flux("ok flux=none".into()).unwrap(), None);
    let fitted = |flux: &str, finger: &str| {
        let values =
            "counts_per_w_m2=0.119200 zero_counts=2051.250 lag_ms=5.000 resistance_mm2k_w=30.000";
        format!("ok flux=fitted {values} w_m2={flux} finger={finger}")
    };
    for finger in FingerKnowledge::ALL {
        let word = finger.name();
        let report = FluxReport {
            sensor: FluxSensor { zero_counts: 2051.25, ..FluxSensor::DESIGNED },
            w_m2: Some(-3.2),
            finger,
        };
        assert_eq!(flux(fitted("-3.2", word)).unwrap(), Some(report));
        let unknown = flux(fitted("-", word)).unwrap().unwrap();
        assert_eq!(unknown.w_m2, None);
    }
    assert!(flux(fitted("-3.2", "warm")).is_err());
    let mut rough = FakeDevice::client(|_| {
        answers("ok conductivity_w_mk=30.000 roughness_um=1.2500 slope_rad=0.11000")
    });
    let surface = DisplaySurface::from_array_rounded([30.0, 1.25, 0.11]);
    assert_eq!(rough.ask(&QueryDisplaySurface).unwrap().surface, surface);
    let lines = [surface, DisplaySurface::NOMINAL].map(SessionRequest::display_surface);
    let lines = lines.map(|line| line.to_string());
    assert_eq!(lines, ["surface set 30 1.25 0.11", "surface nominal"]);
    let cause = client.ask(&QueryCause).unwrap().unwrap();
    assert_eq!((cause.fault, cause.tick), (Fault::DisplayHot, 1234));
    assert_eq!((cause.sink_c, cause.asked_a), (None, -6.0));
    let mut untripped = knows(&[("cause", "ok cause=-")]);
    assert_eq!(untripped.ask(&QueryCause).unwrap(), None);
}

#[test]
fn every_fault_of_the_device_is_known_in_its_state() {
    for fault in Fault::ALL {
        let word = fault.name();
        let mut client = FakeDevice::client(move |_| {
            answers(&format!(
                "ok state=tripped fault={word} material=copper object_c=24.00 mode=contact setpoint_c=- limited body=slab"
            ))
        });
        let status = client.ask(&QueryState).unwrap();
        assert_eq!(status.state, StateName::Tripped(*fault));
        assert_eq!((status.object_c, status.limited), (Some(24.0), true));
        assert_eq!(status.is_tuned, None, "firmware without the capability `untuned`");
    }
}

#[test]
fn whether_the_tile_was_tuned_is_read() {
    for (word, is_tuned) in [("tuned", true), ("untuned", false)] {
        let mut client = FakeDevice::client(move |_| {
            answers(&format!(
                "ok state=armed fault=- material=- object_c=room mode=contact setpoint_c=34.00 body=half-space tile={word}"
            ))
        });
        assert_eq!(client.ask(&QueryState).unwrap().is_tuned, Some(is_tuned));
    }
}

#[test]
fn persons_are_read_and_written() {
    const DATA: &str = "00080000000400012020202040C0000000000200";
    let code = PersonCode::new("P07").unwrap();
    let person = Person { code, finger: Person::read_finger(DATA).unwrap() };
    assert_eq!(person.finger[..4], [0, 8, 0, 0]);
    assert_eq!(PersonData(person.finger).to_string(), DATA);
    for wrong in [&DATA[1..], &DATA[2..], "", &DATA.replace('4', "g")] {
        assert_eq!(Person::read_finger(wrong), None, "{wrong}");
    }
    let mut client = knows(&[
        (
            "person enrol P07",
            "ok person=P07 contacts=2 data=00080000000400012020202040C0000000000200",
        ),
        ("person", "ok person=none contacts=1"),
        ("persons", "ok persons=P07,X"),
        ("person P07 00080000000400012020202040C0000000000200", "ok"),
        ("person none", "ok"),
        ("forget person P07", "ok"),
    ]);
    let enrolled =
        PersonReport { code: Some(code), contacts: 2, data: Some(PersonData(person.finger)) };
    assert_eq!(client.ask(&EnrolPerson { code }).unwrap(), enrolled);
    let unknown = PersonReport { code: None, contacts: 1, data: None };
    assert_eq!(client.ask(&QueryPerson).unwrap(), unknown);
    let codes = client.ask(&QueryPersons).unwrap().codes;
    assert_eq!(codes, [code, PersonCode::new("X").unwrap()]);
    for command in
        [PersonRequest::store(&person), PersonRequest::ChooseNobody, PersonRequest::Forget { code }]
    {
        client.ask(&command).unwrap();
    }
    let wrong =
        FakeDevice::client(|_| answers("ok person=P07 contacts=2 data=00")).ask(&QueryPerson);
    assert!(wrong.is_err());
}

#[test]
fn fields_of_the_flux_sensor_are_read() {
    let mut client = knows(&[("stream 10 force flux surface finger", "ok")]);
    let fields = ["force", "flux", "surface", "finger"];
    client.ask(&StationRequest::stream_fields(10, &fields)).unwrap();
    client.link().sends(1, "T 10 stimulus 0.512 -1234.5 24.0125 wet -");
    client.link().sends(2, "T 20 stimulus 0.512 - - - -");
    client.link().sends(3, "T 30 stimulus 0.512 1 24 damp -");
    client.wait(Duration::from_millis(10)).unwrap();
    let mut next = || Some(client.next_telemetry(Duration::ZERO).unwrap()?.telemetry);
    let values = |line: Telemetry| (line.force_n, line.flux_w_m2, line.surface_c, line.known);
    let mut all = FingerKnowledge::ALL.into_iter();
    let known = all.find(|known| known.name() == "wet").unwrap();
    assert_eq!(next().map(values), Some((Some(0.512), Some(-1234.5), Some(24.0125), Some(known))));
    assert_eq!(next().map(values), Some((Some(0.512), None, None, None)));
    assert_eq!(next(), None);
}

/// A line on which telemetry and the answer have come while the program did not run for 5 s.
struct AfterFreeze {
    lines: VecDeque<&'static str>,
    now: Duration,
}

impl Link for AfterFreeze {
    fn send(&mut self, _bytes: &[u8]) -> Result<(), LinkError> {
        Ok(())
    }

    fn receive(&mut self, _timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        self.now = Duration::from_secs(5);
        let line = self.lines.pop_front();
        Ok(line.map(|line| ReceivedLine { text: line.into(), at: self.now }))
    }

    fn now(&self) -> Duration {
        self.now
    }
}

#[test]
fn an_answer_that_has_come_behind_telemetry_while_the_program_did_not_run_is_found() {
    const TELEMETRY: &str = "T 10 armed - - - - - - 0 0 0 -";
    let lines = [TELEMETRY, TELEMETRY, "ok law=pi"].into();
    let mut client = Client::new(AfterFreeze { lines, now: Duration::ZERO });
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
}
