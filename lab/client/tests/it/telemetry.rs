//! Telemetry beside answers, its losses, and the sign of life.

use std::time::Duration;

use thermal_client::client::{AvailableFields, Client, QueryIdentity, StationRequest, Telemetry};
use thermal_device::StateName;
use thermal_device::safety::Fault;
use thermal_wire::host::{COLUMNS, Need};

use crate::fake_device::{FakeDevice, answers, knows};

/// Time after which a streaming device trips because its host is silent, ms (docs/protocol.md).
const HOST_SILENT_MS: u128 = 2000;

fn line(tick: u32) -> String {
    format!("T {tick} armed 33.00000 33.0123 24.10 33.20 24.00 0.001 -1.250 1.240 17 -")
}

/// A device that streams, and was told at which interval.
fn streaming(interval_ms: u32) -> Client<FakeDevice> {
    let mut client = FakeDevice::client(|line| match line {
        "" => Vec::new(),
        _ => answers("ok"),
    });
    client.ask(&StationRequest::stream(interval_ms)).unwrap();
    client
}

#[test]
fn telemetry_between_lines_and_answers_is_kept_apart_and_in_order() {
    let mut client = FakeDevice::client(|_| {
        vec![(1, line(10)), (1, line(11)), (1, "ok law=pi".into()), (1, line(12))]
    });
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
    client.wait(Duration::from_millis(1)).unwrap();
    let mut ticks = Vec::new();
    while let Some(line) = client.next_telemetry(Duration::ZERO).unwrap() {
        ticks.push(line.telemetry.tick);
        let one = line.telemetry;
        assert_eq!(one.state, StateName::Armed);
        assert_eq!((one.setpoint_c, one.display_c), (Some(33.0), Some(33.0123)));
        assert_eq!((one.sink_c, one.skin_c), (Some(24.1), Some(33.2)));
        assert_eq!((one.room_c, one.force_n), (Some(24.0), Some(0.001)));
        assert_eq!((one.demand_a, one.current_a), (Some(-1.25), Some(1.24)));
        assert_eq!((one.evaluations, one.limited), (Some(17), false));
    }
    assert_eq!(ticks, [10, 11, 12]);
}

#[test]
fn a_finger_is_lifted_below_10_mn_and_nothing_is_said_of_an_unknown_force() {
    for (force, is_lifted) in
        [("0.009", Some(true)), ("0.010", Some(false)), ("2.000", Some(false)), ("-", None)]
    {
        let line = line(1).replace(" 0.001 ", &format!(" {force} "));
        let telemetry = Telemetry::parse(&line).unwrap();
        assert_eq!(telemetry.is_lifted(), is_lifted, "{force}");
    }
}

#[test]
fn what_the_device_does_not_know_and_why_it_tripped_is_read() {
    let mut client = streaming(1);
    client.link().sends(1, "@3 T 5 tripped - - 24.10 33.20 24.00 - 0.000 0.000 0 display-open");
    client
        .link()
        .sends(2, "T 6 preset 15.00000 15.2000 24.10 33.20 24.00 0.000 6.000 5.900 9 limited");
    client
        .link()
        .sends(3, "T 7 armed 33.20000 33.2000 24.10 33.20 24.00 0.000 0.100 0.100 9 untuned");
    let wait = Duration::from_millis(5);
    let tripped = client.next_telemetry(wait).unwrap().unwrap();
    assert_eq!(tripped.finger, Some(3));
    assert_eq!(tripped.telemetry.fault(), Some(Fault::DisplayOpen));
    assert_eq!((tripped.telemetry.display_c, tripped.telemetry.force_n), (None, None));
    let limited = client.next_telemetry(wait).unwrap().unwrap().telemetry;
    assert!(limited.limited && !limited.is_untuned);
    let untuned = client.next_telemetry(wait).unwrap().unwrap().telemetry;
    assert!(untuned.is_untuned && !untuned.limited && untuned.remark() == Some("untuned"));
}

#[test]
fn a_client_that_waits_gives_a_sign_of_life_while_the_device_streams_and_only_then() {
    let mut client = knows(&[("stream 50", "ok"), ("stream 0", "ok"), ("law", "ok law=pi")]);
    client.wait(Duration::from_secs(10)).unwrap();
    assert!(client.link().blank_ms().is_empty());
    client.ask(&StationRequest::stream(50)).unwrap();
    let from_ms = client.link().sent[0].0.as_millis();
    client.wait(Duration::from_secs(7)).unwrap();
    client.query("law").unwrap();
    assert!(client.next_telemetry(Duration::from_secs(8)).unwrap().is_none());
    let mut last_ms = from_ms;
    for (at, _) in &client.link().sent {
        assert!(at.as_millis() - last_ms.min(at.as_millis()) < HOST_SILENT_MS * 3 / 4);
        last_ms = at.as_millis();
    }
    assert!(last_ms > 24_000, "{last_ms}");
    client.ask(&StationRequest::stream(0)).unwrap();
    let before = client.link().blank_ms().len();
    client.wait(Duration::from_secs(10)).unwrap();
    assert_eq!(client.link().blank_ms().len(), before);
}

#[test]
fn lost_lines_are_counted_by_their_ticks_for_each_finger() {
    let mut client = streaming(5);
    for (after_ms, text) in [
        (1, line(100)),
        (6, line(105)),
        // Three lines are missing.
        (26, line(125)),
        (26, format!("@1 {}", line(100))),
        (31, format!("@1 {}", line(110))),
        // It has restarted.
        (400, line(5)),
        (405, line(10)),
    ] {
        client.link().sends(after_ms, &text);
    }
    client.wait(Duration::from_millis(500)).unwrap();
    let mut lost = Vec::new();
    while let Some(line) = client.next_telemetry(Duration::ZERO).unwrap() {
        lost.push(line.lost_before);
    }
    assert_eq!(lost, [0, 0, 3, 0, 1, 0, 0]);
    assert_eq!(client.counts().lost, 4);
}

#[test]
fn a_line_that_was_damaged_on_its_way_is_counted_and_not_taken() {
    let mut client = streaming(1);
    for text in [
        "T 1 armed 33.00000 33.0123 24.10 33.20 24.00 0.001 -1.250 1.240 17 -",
        "T 2 armed 33.00000 33.0123 24.1",
        "T 3 armed 33.00000 33.O123 24.10 33.20 24.00 0.001 -1.250 1.240 17 -",
        "T 4 armde 33.00000 33.0123 24.10 33.20 24.00 0.001 -1.250 1.240 17 -",
        "T 5 armed nan 33.0123 24.10 33.20 24.00 0.001 -1.250 1.240 17 -",
        "5 T armed",
        "T",
    ] {
        client.link().sends(1, text);
    }
    client.wait(Duration::from_millis(5)).unwrap();
    assert!(client.next_telemetry(Duration::ZERO).unwrap().is_some());
    assert!(client.next_telemetry(Duration::ZERO).unwrap().is_none());
    assert_eq!(client.counts().damaged, 6);
}

/// Fields whose lines have the same number of words.

#[test]
fn a_line_with_fields_that_were_not_chosen_is_not_taken() {
    let mut client = FakeDevice::client(|_| answers("ok"));
    client.ask(&StationRequest::stream_fields(5, &["setpoint"])).unwrap();
    client.link().sends(1, &line(5));
    client.link().sends(2, "T 10 armed 33.00000 33.0123 -");
    client.link().sends(3, "T 15 armed 33.00000 -");
    client.wait(Duration::from_millis(5)).unwrap();
    let taken = client.next_telemetry(Duration::ZERO).unwrap().unwrap();
    assert_eq!(taken.telemetry.tick, 15);
    assert!(client.next_telemetry(Duration::ZERO).unwrap().is_none());
    assert_eq!(client.counts().damaged, 2);
}

#[test]
fn a_line_that_waited_while_its_fields_were_changed_is_dropped() {
    let mut client = FakeDevice::client(|line| match line {
        "" => Vec::new(),
        _ => answers("ok"),
    });
    client.ask(&StationRequest::stream_fields(5, &["setpoint"])).unwrap();
    for tick in (100u32..200).step_by(5) {
        let after_ms = u64::from(tick) - 100;
        (client.link()).sends(after_ms, &format!("T {tick} armed 33.00000 -"));
    }
    client.wait(Duration::from_millis(101)).unwrap();
    while client.next_telemetry(Duration::ZERO).unwrap().is_some() {}
    client.ask(&StationRequest::stream_fields(5, &["display"])).unwrap();
    // Those of the old kind that the answer has overtaken, received late because nobody waited.
    for tick in [195, 200] {
        (client.link()).sends(50, &format!("T {tick} armed 33.00000 -"));
    }
    for tick in [230, 235] {
        (client.link()).sends(50, &format!("T {tick} armed 32.9000 -"));
    }
    client.wait(Duration::from_millis(60)).unwrap();
    let mut taken = Vec::new();
    while let Some(line) = client.next_telemetry(Duration::ZERO).unwrap() {
        let Telemetry { tick, setpoint_c, display_c, .. } = line.telemetry;
        taken.push((tick, setpoint_c, display_c));
    }
    assert_eq!(taken, [(230, None, Some(32.9)), (235, None, Some(32.9))]);
    let counts = client.counts();
    assert_eq!((counts.dropped, counts.damaged, counts.lost), (2, 0, 0));
}

#[test]
fn a_stream_that_was_ended_goes_on_with_the_same_fields_without_a_loss() {
    let mut client = FakeDevice::client(|_| answers("ok"));
    for tick in [5, 11] {
        client.ask(&StationRequest::stream_fields(5, &["setpoint"])).unwrap();
        client.link().sends(5, &format!("T {tick} armed 33.00000 -"));
        client.wait(Duration::from_millis(6)).unwrap();
        let taken = client.next_telemetry(Duration::ZERO).unwrap();
        assert_eq!(taken.map(|line| line.telemetry.tick), Some(tick));
        client.ask(&StationRequest::stream(0)).unwrap();
    }
    assert_eq!(client.counts().dropped, 0);
}

/// What a finger of a device has whose firmware has these capabilities.
fn available(capabilities: &str, has_flux_sensor: bool) -> AvailableFields {
    let id = format!(
        "ok thermal-display 0.2.0 fingers=1 tick_hz=1000 scan_hz=16000 protocol=1 capabilities={capabilities}"
    );
    let identity = FakeDevice::client(move |_| answers(&id)).ask(&QueryIdentity).unwrap();
    AvailableFields::of(&identity, has_flux_sensor)
}

/// The device answers with the fields that it knows only, and refuses a line with another one (docs/protocol.md).
#[test]
fn fields_of_a_capability_are_asked_for_of_firmware_that_has_it_only() {
    let older = "upload,checksum,flux";
    assert_eq!(available(older, false), AvailableFields::OF_EVERY_LINE);
    assert_eq!(available(older, false).stream(10).to_string(), "stream 10");
    let with_flux =
        "stream 10 setpoint display sink skin room force demand current flux surface finger";
    assert_eq!(available(older, true).stream(10).to_string(), with_flux);
    for column in COLUMNS {
        if let Need::Capability(word) = column.need {
            let names =
                |fields: AvailableFields| fields.further_columns().map(|column| column.name);
            let newer = available(&format!("{older},{word}"), false);
            assert!(names(newer).any(|name| name == column.name));
            let request = newer.stream(10).to_string();
            assert!(request.split(' ').any(|name| name == column.field), "{request}");
            assert_eq!(AvailableFields::of_table(names(newer)), newer);
        }
    }
}

/// At any interval, of a finger that is addressed, with a checksum (docs/protocol.md).
#[test]
fn a_stream_with_all_that_a_device_has_fits_into_a_line() {
    let capabilities: Vec<_> = (COLUMNS.iter())
        .filter_map(|column| match column.need {
            Need::Capability(word) => Some(word),
            _ => None,
        })
        .collect();
    for interval_ms in [1, 10, 100, 1000, 10_000, 60_000] {
        let stream = available(&capabilities.join(","), true).stream(interval_ms).to_string();
        assert!(format!("@4 {stream}*00").len() <= 96, "{stream}");
        assert!(stream.contains(" current flux surface finger"), "{stream}");
    }
}

#[test]
fn the_fields_of_a_heat_flux_sensor_are_read_into_their_columns() {
    let fields = available("flux", true);
    let mut client = FakeDevice::client(|line| match line {
        "" => Vec::new(),
        _ => answers("ok"),
    });
    client.ask(&fields.stream(10)).unwrap();
    let line = "T 100 contact 30.5 30.4 24.1 33.2 24 1.5 2.25 2.2 2103.5 30.125 trusted -";
    client.link().sends(100, line);
    let line = client.next_telemetry(Duration::from_millis(200)).unwrap().unwrap().telemetry;
    let cells = COLUMNS.iter().map(|column| (column.name, column.text(&line)));
    let cells: Vec<_> = cells.map(|(name, text)| (name, text.unwrap_or_default())).collect();
    let expected = [
        ("setpoint_c", "30.5"),
        ("display_c", "30.4"),
        ("sink_c", "24.1"),
        ("skin_c", "33.2"),
        ("room_c", "24"),
        ("force_n", "1.5"),
        ("demand_a", "2.25"),
        ("current_a", "2.2"),
        ("evaluations", ""),
        ("flux_w_m2", "2103.5"),
        ("surface_c", "30.125"),
        ("known", "trusted"),
        ("check_c", ""),
    ];
    assert_eq!(cells, expected.map(|(name, text)| (name, text.to_owned())));
    let numbers: Vec<_> = fields.further_columns().map(|column| column.number(&line)).collect();
    assert_eq!(numbers, [Some(2103.5), Some(30.125), Some(1.0)]);
}
