//! The documented state diagram.

use super::Bench;
use crate::device::drive::Drive;
use crate::device::safety::State;

#[test]
fn a_station_is_off_until_it_is_armed() {
    let mut bench = Bench::new();
    bench.force_n = 2.0;
    for _ in 0..100 {
        let (drive, telemetry) = bench.step();
        assert_eq!(
            (drive, telemetry.state, telemetry.setpoint),
            (Drive::Off, State::Off, None)
        );
        assert_eq!(telemetry.demand, 0);
    }
    assert_eq!(bench.host("start"), "err start needs arm first");
    assert_eq!(bench.step().0, Drive::Off);
    bench.obey(&["arm"]);
    assert!(matches!(bench.step().0, Drive::On(_)));
}

#[test]
fn every_arrow_of_the_state_diagram() {
    let mut bench = Bench::new();
    bench.obey(&["material granite"]);
    let landed = |bench: &mut Bench| {
        bench.force_n = 1.0;
        bench.steps(2);
        assert_eq!(bench.state(), State::Contact);
    };
    let started = |bench: &mut Bench| {
        bench.force_n = 0.0;
        bench.obey(&["arm"]);
        bench.steps(2);
        bench.obey(&["start"]);
        bench.step();
        assert_eq!(bench.state(), State::Preset);
    };

    bench.obey(&["arm"]);
    assert_eq!(bench.state(), State::Armed);
    bench.obey(&["arm", "abort"]);
    assert_eq!(bench.state(), State::Ready);

    started(&mut bench);
    landed(&mut bench);
    bench.force_n = 0.0;
    bench.steps(2);
    assert_eq!(bench.state(), State::Preset);

    bench.obey(&["arm"]);
    assert_eq!(bench.state(), State::Armed);
    started(&mut bench);
    landed(&mut bench);
    bench.obey(&["arm"]);
    assert_eq!(bench.state(), State::Armed);

    for touched in [false, true] {
        started(&mut bench);
        if touched {
            landed(&mut bench);
        }
        bench.obey(&["abort"]);
        assert_eq!((bench.step().0, bench.state()), (Drive::Off, State::Ready));
    }
}

#[test]
fn a_start_out_of_turn_changes_nothing() {
    let mut bench = Bench::new();
    bench.obey(&["arm"]);
    assert_eq!(bench.host("start"), "err start needs a material first");
    assert_eq!(bench.state(), State::Armed);
    bench.obey(&["material copper", "start"]);
    bench.force_n = 2.0;
    bench.steps(500);
    let mut undisturbed = bench.clone();
    assert_eq!(
        bench.host("start"),
        "err already started; arm takes the object away"
    );
    assert_eq!(bench.host("clear"), "err no fault to clear");
    assert_eq!(bench.step(), undisturbed.step());
}

#[test]
fn the_host_is_told_what_the_device_does() {
    let mut bench = Bench::new();
    assert_eq!(
        bench.host("state"),
        "ok state=off fault=- material=- object_c=room mode=contact setpoint_c=-"
    );
    bench.obey(&[
        "material abs",
        "object 60",
        "mode semi-infinite",
        "law model",
        "arm",
    ]);
    bench.answers = true;
    bench.skin_c = 45.0;
    bench.steps(3000);
    assert_eq!(
        bench.host("state"),
        "ok state=armed fault=- material=abs object_c=60.00 mode=semi-infinite setpoint_c=42.00 limited"
    );
    assert_eq!(
        bench.host("id"),
        "ok thermal-display 0.1.0 fingers=1 tick_hz=1000 scan_hz=16000"
    );
}

#[test]
fn telemetry_comes_at_its_interval() {
    let mut bench = Bench::new();
    bench.obey(&["stream 7"]);
    let streamed = (1..=70)
        .filter(|tick| {
            let samples = bench.samples();
            bench.station.step(&samples);
            let telemetry = bench.station.telemetry();
            assert!(telemetry.is_none_or(|telemetry| telemetry.tick == *tick));
            telemetry.is_some()
        })
        .count();
    assert_eq!(streamed, 10);
    bench.obey(&["stream 0"]);
    let samples = bench.samples();
    for _ in 0..100 {
        bench.station.step(&samples);
        assert_eq!(bench.station.telemetry(), None);
    }
}

#[test]
fn a_display_that_is_held_sets_out_from_where_it_is() {
    let mut bench = Bench::new();
    bench.obey(&["arm", "hold 42"]);
    for gone_k in [1.0, 2.0] {
        bench.steps(999);
        super::assert_close(bench.setpoint_c(), bench.display_c + gone_k);
    }
    bench.obey(&["hold 20"]);
    bench.steps(999);
    super::assert_close(bench.setpoint_c(), bench.display_c - 1.0);
}

#[test]
fn a_display_that_was_tuned_is_held_no_longer() {
    let mut bench = Bench::new();
    bench.obey(&["arm", "hold 42", "tune"]);
    bench.step();
    // Ends the experiment.
    bench.force_n = 1.0;
    bench.steps(100);
    super::assert_close(bench.setpoint_c(), bench.skin_c);
}
