//! Faults switch off, at once and for good; limits hold.

use super::{Bench, State};
use crate::device::drive::Drive;
use crate::device::safety::Fault;

/// What goes wrong with a world, and the word for it.
type Trouble = (&'static str, fn(&mut Bench));

/// Thermistors at ±200 °C read as shorted and open.
const TROUBLES: [Trouble; 16] = [
    ("display-open", |bench| bench.display_c = -200.0),
    ("display-short", |bench| bench.display_c = 200.0),
    ("check-open", |bench| bench.check_c = -200.0),
    ("check-short", |bench| bench.check_c = 200.0),
    ("sink-open", |bench| bench.sink_c = -200.0),
    ("sink-short", |bench| bench.sink_c = 200.0),
    ("skin-open", |bench| bench.skin_c = -200.0),
    ("skin-short", |bench| bench.skin_c = 200.0),
    ("room-open", |bench| bench.room_c = -200.0),
    ("room-short", |bench| bench.room_c = 200.0),
    ("force-sensor", |bench| bench.force_n = -1.3),
    ("display-hot", |bench| bench.check_c = 43.1),
    ("display-cold", |bench| bench.display_c = 13.4),
    ("sink-hot", |bench| bench.sink_c = 42.1),
    ("over-current", |bench| bench.current_a = Some(9.1)),
    ("bridge", |bench| bench.bridge_fault = true),
];

/// A bench in each of the states but tripped and self-test.
fn everywhere() -> [Bench; 5] {
    let armed = {
        let mut bench = Bench::new();
        bench.obey(&["material copper", "arm"]);
        bench.step();
        bench
    };
    let preset = Bench::presenting("copper");
    let mut contact = preset.clone();
    contact.force_n = 2.0;
    contact.steps(10);
    let mut off = Bench::new();
    off.obey(&["material copper"]);
    let mut ready = armed.clone();
    ready.obey(&["abort"]);
    [off, ready, armed, preset, contact]
}

#[test]
fn every_fault_trips_in_its_tick_from_every_state_and_stays() {
    for sound in everywhere() {
        for (word, happen) in TROUBLES {
            // The comparator may have kept the line since the last self-test.
            if word == "bridge" && sound.state() == State::Off {
                continue;
            }
            let mut bench = sound.clone();
            happen(&mut bench);
            let (drive, telemetry) = bench.step();
            let fault = telemetry.state.fault().map(|fault| fault.name());
            assert_eq!(
                (drive, fault),
                (Drive::Off, Some(word)),
                "from {:?}",
                sound.state()
            );
            assert_eq!(telemetry.demand, 0);

            let tripped = ["err tripped by ", word, "; clear it first"].concat();
            let present = ["err fault ", word, " is still present"].concat();
            // The line may be the comparator's, which only the next self-test lets go.
            if word == "bridge" {
                continue;
            }
            assert_eq!(bench.host("clear"), present);

            // Gone again, but nobody has said so.
            bench = Bench {
                station: bench.station,
                ..sound.clone()
            };
            assert_eq!(bench.host("clear"), present);
            for _ in 0..100 {
                assert_eq!(bench.step().0, Drive::Off, "{word}");
            }
            for (line, answer) in [
                ("arm", tripped.as_str()),
                ("start", &tripped),
                ("abort", "ok"),
            ] {
                assert_eq!(bench.host(line), answer);
                assert_eq!(bench.step().0, Drive::Off, "{word} after {line}");
                assert_eq!(bench.state().name(), "tripped");
            }
            bench.obey(&["clear"]);
            assert_eq!((bench.step().0, bench.state().name()), (Drive::Off, "off"));
            bench.obey(&["arm", "start"]);
            assert!(matches!(bench.step().0, Drive::On(_)));
        }
    }
}

#[test]
fn the_first_fault_is_kept_and_a_later_one_keeps_clear_from_passing() {
    let mut bench = Bench::presenting("copper");
    bench.bridge_fault = true;
    bench.step();
    bench.bridge_fault = false;
    bench.sink_c = 50.0;
    bench.step();
    assert_eq!(bench.host("arm"), "err tripped by bridge; clear it first");
    assert_eq!(bench.host("clear"), "err fault sink-hot is still present");
    bench.sink_c = 25.0;
    bench.step();
    bench.obey(&["clear"]);
}

/// What no sample shows is not lost because something else came first.
#[test]
fn what_tripped_while_it_was_tripped_comes_to_light_with_clear() {
    let mut bench = Bench::presenting("copper");
    for fault in [Fault::SinkHot, Fault::SettingsCorrupt] {
        bench.station.trip(fault);
    }
    bench.steps(2);
    assert_eq!(bench.state().fault(), Some(Fault::SinkHot));
    assert_eq!(
        bench.host("clear"),
        "err fault settings-corrupt is still present"
    );
    assert_eq!(bench.state().fault(), Some(Fault::SettingsCorrupt));
    assert!(bench.host("cause").contains("settings-corrupt"));
    bench.obey(&["clear"]);
    assert_eq!(bench.state(), State::Off);
}

#[test]
fn what_stands_and_no_sample_shows_keeps_clear_from_being_obeyed() {
    let mut bench = Bench::new();
    for _ in 0..3 {
        bench.station.trip(Fault::Clock);
        bench.step();
        assert_eq!(bench.host("clear"), "err fault clock is still present");
    }
    bench.step();
    assert_eq!(bench.host("clear"), "ok");
}

/// 42.8 °C are three quarters of a minute's worth a minute; the force sensor fails meanwhile.
#[test]
fn the_dose_goes_on_while_something_else_is_wrong() {
    let mut bench = Bench::presenting("copper");
    bench.force_n = -1.3;
    bench.step();
    (bench.display_c, bench.check_c) = (42.8, 42.8);
    bench.steps(32_000);
    assert_eq!(
        bench.host("clear"),
        "err fault force-sensor is still present"
    );
    bench.force_n = 0.0;
    bench.steps(10_000);
    (bench.display_c, bench.check_c) = (39.5, 39.5);
    bench.steps(5);
    assert_eq!(bench.host("clear"), "err fault dose is still present");
}

/// 1.2 counts of noise are 1.1 mN, of which 3 mN come once in 800 ticks.
#[test]
fn a_force_sensor_that_is_noisy_delays_no_self_test() {
    let mut bench = Bench::new();
    assert_eq!(bench.host("arm"), "ok");
    for tick in 0..800 {
        bench.force_n = if tick % 100 == 50 { 0.004 } else { 0.0 };
        bench.step_tested();
    }
    assert_eq!(bench.state(), State::Armed);
}

/// A force that is hardly above its zero comes and goes with the noise; a slow landing passes there.
#[test]
fn a_force_that_comes_and_goes_delays_a_self_test_by_two_seconds_at_most() {
    let hovers = |tick: u32| if tick % 7 < 4 { 0.004 } else { 0.002 };
    let lands = |tick: u32| 1e-5 * f64::from(tick) + if tick % 7 < 4 { 1e-3 } else { 0.0 };
    for force in [&hovers as &dyn Fn(u32) -> f64, &lands] {
        let mut bench = Bench::new();
        assert_eq!(bench.host("arm"), "ok");
        for tick in 0..2750 {
            bench.force_n = force(tick);
            bench.step_tested();
        }
        assert_eq!(bench.state(), State::Armed);
    }
}

/// Landings without end.
#[test]
fn a_self_test_that_is_never_left_alone_trips_after_20_s() {
    let mut bench = Bench::new();
    assert_eq!(bench.host("arm"), "ok");
    let mut ticks = 0;
    while bench.state() == State::SelfTest {
        bench.force_n = if ticks / 500 % 2 == 0 { 1.0 } else { 0.0 };
        bench.step_tested();
        ticks += 1;
    }
    assert_eq!(bench.state().fault(), Some(Fault::NoResponse));
    assert!((20_000..20_100).contains(&ticks), "{ticks}");
}

/// A leg that cannot warm.
#[test]
fn a_self_test_without_current_one_way_round_trips() {
    let mut bench = Bench::new();
    assert_eq!(bench.host("arm"), "ok");
    while bench.state() == State::SelfTest {
        let (outputs, telemetry) = bench.step_all();
        let flows_a = telemetry.demand.to_num::<f64>().max(0.0);
        bench.current_a = Some(flows_a);
        bench.display_c -= 2.7e-3 * flows_a;
        bench.check_c = bench.display_c;
        bench.bridge_fault = outputs.comparator_test;
    }
    assert_eq!(bench.state().fault(), Some(Fault::CurrentLow));
}

#[test]
fn a_fault_ends_the_contact() {
    let mut bench = Bench::presenting("copper");
    bench.force_n = 2.0;
    bench.steps(5000);
    bench.bridge_fault = true;
    bench.step();
    bench.bridge_fault = false;
    bench.step();
    bench.obey(&["clear", "arm", "start"]);
    let expected_c = bench.contact("copper", 24.0).at(0.0).display_c;
    super::assert_close(bench.setpoint_c(), expected_c);
}

#[test]
fn the_current_asked_for_stays_within_its_limit_and_turns_at_once() {
    let mut bench = Bench::presenting("copper");
    for (line, demand_a) in [("object 60", -6), ("object -20", 6)] {
        bench.obey(&[line]);
        // No longer than a display that stands still is taken for one.
        for _ in 0..200 {
            let (_, telemetry) = bench.step();
            assert_eq!(telemetry.demand, demand_a);
        }
    }
}

/// Of a tile that has been at rest: 6 A through leads and legs of 12 V, the dead time, and what the module gives or takes.
#[test]
fn the_voltage_is_what_the_current_needs() {
    for (line, duty) in [("object 60", -0.5), ("object -20", 0.5)] {
        let mut bench = Bench::new();
        let display_c = bench.skin_c;
        (bench.display_c, bench.check_c) = (display_c, display_c);
        bench.obey(&["material copper", line, "arm"]);
        bench.steps(1000);
        bench.obey(&["start"]);
        let (drive, telemetry) = bench.step();
        assert_eq!(telemetry.demand, 12.0 * duty);
        let Drive::On(voltage) = drive else {
            panic!("{drive:?}")
        };
        let voltage = voltage.fraction().to_num::<f64>();
        let seebeck = 0.0273 * (25.0 - display_c) / 12.0;
        let legs_k = (25.0 + display_c) / 2.0 - 27.0;
        let ohm = 0.19 + 1.061 * (1.0 + 0.0049 * legs_k);
        let expected = duty * (ohm + 0.397 / 6.0) + seebeck;
        assert!(
            (voltage - expected).abs() < 1e-3,
            "{line}: {voltage}, {expected}"
        );
    }
}

/// The bench without its noise: a converter that repeats its last conversions.
#[test]
fn a_converter_that_stands_still_trips_within_50_ms() {
    let mut bench = Bench::presenting("copper");
    // To the tick in which the last noise has gone again.
    while bench.tick % 40 != 22 {
        bench.step();
    }
    bench.noise = 0;
    bench.steps(45);
    assert_eq!(bench.state(), State::Preset);
    let (drive, _) = bench.steps(1);
    assert_eq!(
        (bench.state().fault().map(Fault::name), drive),
        (Some("samples-frozen"), Drive::Off)
    );
}

#[test]
fn display_thermistors_that_stay_apart_trip() {
    let mut bench = Bench::presenting("copper");
    let drift = |bench: &mut Bench, to_k: f64| {
        while (bench.check_c - bench.display_c - to_k).abs() > 0.05 {
            bench.check_c += 0.1f64.copysign(bench.display_c + to_k - bench.check_c);
            bench.step();
        }
    };
    drift(&mut bench, 2.9);
    bench.steps(200);
    assert_eq!(bench.state(), State::Preset);
    drift(&mut bench, -2.9);
    bench.steps(4);
    bench.check_c = bench.display_c - 3.1;
    bench.steps(39);
    assert_eq!(bench.state(), State::Preset);
    let (drive, _) = bench.steps(1);
    assert_eq!(
        (bench.state().fault().map(Fault::name), drive),
        (Some("displays-apart"), Drive::Off)
    );
}

/// Against the current, by more than a display that goes the wrong way: in every phase of the detectors.
#[test]
fn a_reading_that_steps_is_a_jump_whatever_the_current_does() {
    for phase in 0..8 {
        let mut bench = Bench::presenting("copper");
        bench.current_a = None;
        bench.steps(300 + phase);
        let cooled = bench.display_c > bench.setpoint_c();
        bench.display_c += if cooled { 2.0 } else { -2.0 };
        bench.step();
        assert_eq!(bench.state().fault(), Some(Fault::DisplayJump), "{phase}");
    }
}

/// The comparator keeps the supply cut after the wire is mended; the self-test gives it back.
#[test]
fn a_comparator_that_has_cut_can_be_cleared() {
    let mut bench = Bench::presenting("copper");
    let check_c = bench.check_c;
    (bench.check_c, bench.bridge_fault) = (-200.0, true);
    bench.step();
    assert_eq!(bench.state().fault().map(Fault::name), Some("check-open"));
    bench.check_c = check_c;
    bench.step();
    bench.obey(&["clear"]);
    assert_eq!(bench.state(), State::Off);
    bench.obey(&["arm"]);
    assert_eq!(bench.state(), State::Armed);
}

#[test]
fn armed_after_a_fault_the_display_is_neutral_again() {
    let mut bench = Bench::new();
    bench.obey(&["arm", "hold 41.5"]);
    bench.step();
    bench.force_n = -1.3;
    bench.step();
    bench.force_n = 0.0;
    bench.step();
    bench.obey(&["clear", "arm"]);
    assert!((bench.setpoint_c() - bench.skin_c).abs() < 0.1);
}

/// A finger that lands in the self-test warms the display as it cools.
#[test]
fn a_finger_that_lands_in_the_self_test_is_waited_for() {
    let mut bench = Bench::new();
    assert_eq!(bench.host("arm"), "ok");
    for tick in 0..3000 {
        if bench.state() != State::SelfTest {
            break;
        }
        bench.force_n = if tick < 150 { 0.0 } else { 1.0 };
        bench.step_tested();
        bench.display_c += if (150..450).contains(&tick) {
            2e-3
        } else {
            0.0
        };
        bench.check_c = bench.display_c;
    }
    assert_eq!(bench.state(), State::Armed);
}
