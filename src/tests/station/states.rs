//! The documented state diagram, and the commands that depend on the state.

use super::TestBench;
use crate::device::StateName;
use crate::device::drive::Drive;
use std::string::ToString as _;
use thermal_wire::telemetry::TelemetryLine;

#[test]
fn a_station_is_off_until_it_is_armed() {
    let mut bench = TestBench::new();
    bench.force_n = 2.0;
    for _ in 0..100 {
        let (drive, telemetry) = bench.step();
        assert_eq!(
            (drive, telemetry.state, telemetry.setpoint),
            (Drive::Off, StateName::Off, None)
        );
        assert_eq!(telemetry.demand, 0);
    }
    assert_eq!(bench.send("start"), "err start needs arm first");
    assert_eq!(bench.step().0, Drive::Off);
    bench.send_ok(&["arm"]);
    assert!(matches!(bench.step().0, Drive::On(_)));
}

#[test]
fn every_transition_of_the_state_diagram_is_taken() {
    let mut bench = TestBench::new();
    bench.send_ok(&["material granite"]);
    let land = |bench: &mut TestBench| {
        bench.force_n = 1.0;
        bench.steps(2);
        assert_eq!(bench.state(), StateName::Contact);
    };
    let start = |bench: &mut TestBench| {
        bench.force_n = 0.0;
        bench.send_ok(&["arm"]);
        bench.steps(6);
        bench.send_ok(&["start"]);
        bench.step();
        assert_eq!(bench.state(), StateName::Preset);
    };

    bench.send_ok(&["arm"]);
    assert_eq!(bench.state(), StateName::Armed);
    bench.send_ok(&["arm", "abort"]);
    assert_eq!(bench.state(), StateName::Ready);

    start(&mut bench);
    land(&mut bench);
    bench.force_n = 0.0;
    bench.steps(6);
    assert_eq!(bench.state(), StateName::Preset);

    bench.send_ok(&["arm"]);
    assert_eq!(bench.state(), StateName::Armed);
    start(&mut bench);
    land(&mut bench);
    bench.send_ok(&["arm"]);
    assert_eq!(bench.state(), StateName::Armed);

    for touched in [false, true] {
        start(&mut bench);
        if touched {
            land(&mut bench);
        }
        bench.send_ok(&["abort"]);
        assert_eq!((bench.step().0, bench.state()), (Drive::Off, StateName::Ready));
    }
}

#[test]
fn a_start_in_the_wrong_state_is_refused_and_changes_nothing() {
    let mut bench = TestBench::new();
    bench.plate_responds = true;
    bench.send_ok(&["arm"]);
    assert_eq!(bench.send("start"), "err start needs a material first");
    assert_eq!(bench.state(), StateName::Armed);
    bench.send_ok(&["material copper", "start"]);
    bench.force_n = 2.0;
    bench.steps(500);
    let mut undisturbed = bench.clone();
    assert_eq!(bench.send("start"), "err already started; arm takes the object away");
    assert_eq!(bench.send("clear"), "err no fault to clear");
    assert_eq!(bench.step(), undisturbed.step());
}

#[test]
fn state_and_id_report_the_station_and_the_device() {
    let mut bench = TestBench::new();
    assert_eq!(
        bench.send("state"),
        "ok state=off fault=- material=- object_c=room mode=contact setpoint_c=- body=half-space tile=tuned"
    );
    bench.send_ok(&["material abs", "object 60", "mode semi-infinite", "law model", "arm"]);
    bench.plate_responds = true;
    bench.skin_c = 45.0;
    bench.steps(3000);
    assert_eq!(
        bench.send("state"),
        "ok state=armed fault=- material=abs object_c=60.00 mode=semi-infinite setpoint_c=42.00 limited body=half-space tile=tuned"
    );
    assert_eq!(
        bench.send("id"),
        "ok thermal-display 0.2.0 fingers=1 tick_hz=1000 scan_hz=16000 protocol=1 capabilities=upload,checksum,board,self-test,raw,course,flux,contact,surface,person,untuned,check"
    );
}

#[test]
fn telemetry_is_streamed_at_its_interval() {
    let mut bench = TestBench::new();
    bench.send_ok(&["stream 7"]);
    let streamed = (1..=70)
        .filter(|tick| {
            let samples = bench.samples();
            bench.station.step(&samples);
            let telemetry = bench.station.telemetry_if_due();
            assert!(telemetry.is_none_or(|telemetry| telemetry.tick == *tick));
            telemetry.is_some()
        })
        .count();
    assert_eq!(streamed, 10);
    bench.send_ok(&["stream 0"]);
    let samples = bench.samples();
    for _ in 0..100 {
        bench.station.step(&samples);
        assert_eq!(bench.station.telemetry_if_due(), None);
    }
}

#[test]
fn telemetry_shows_by_how_much_the_second_thermistor_of_the_display_is_off() {
    let mut bench = TestBench::new();
    bench.send_ok(&["stream 1 display check"]);
    bench.check_c = 30.5;
    let (_, telemetry) = bench.step();
    assert_eq!(TelemetryLine { telemetry, flux: None }.to_string(), "T 1 off 30.0006 30.4994 -");
}

#[test]
fn a_hold_ramps_from_the_present_temperature() {
    let mut bench = TestBench::new();
    bench.plate_responds = true;
    bench.send_ok(&["law model", "arm", "hold 42"]);
    let start_c = bench.display_c;
    for ramp_k in [1.0, 2.0] {
        bench.steps(999);
        super::assert_close(bench.setpoint_c(), start_c + ramp_k);
    }
    bench.send_ok(&["hold 20"]);
    bench.steps(999);
    super::assert_close(bench.setpoint_c(), start_c + 1.0);
}

#[test]
fn tune_ends_a_hold() {
    let mut bench = TestBench::new();
    bench.send_ok(&["arm", "hold 42", "tune"]);
    bench.step();
    // A touch aborts the identification.
    bench.force_n = 1.0;
    bench.steps(100);
    bench.assert_reaches_setpoint(bench.skin_c);
}
