//! Faults trip at once and stay latched; current and voltage stay within their limits.

use super::TestBench;
use super::rendering::assert_follows_contact;
use crate::device::StateName;
use crate::device::drive::Drive;
use crate::device::safety::Fault;
use crate::device::sense::Samples;

/// The name of a fault, and the change of the bench that causes it.
type FaultCase = (&'static str, fn(&mut TestBench));

/// A thermistor at 200 °C reads as shorted, at -200 °C as open.
const FAULT_CASES: [FaultCase; 16] = [
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
    ("display-hot", |bench| bench.check_c = 43.1),
    ("display-cold", |bench| bench.display_c = 13.4),
    ("sink-hot", |bench| bench.sink_c = 42.1),
    ("over-current", |bench| bench.measured_a = Some(9.1)),
    ("bridge", |bench| bench.bridge_fault = true),
    ("emergency-stop", |bench| bench.emergency_stop = true),
];

/// One bench in each state other than tripped and self-test.
pub(super) fn bench_in_each_state() -> [TestBench; 5] {
    let armed = {
        let mut bench = TestBench::new();
        bench.send_ok(&["material copper", "arm"]);
        bench.step();
        bench
    };
    let preset = TestBench::presenting("copper");
    let mut contact = preset.clone();
    contact.force_n = 2.0;
    contact.steps(10);
    let mut off = TestBench::new();
    off.send_ok(&["material copper"]);
    let mut ready = armed.clone();
    ready.send_ok(&["abort"]);
    [off, ready, armed, preset, contact]
}

#[test]
fn every_fault_trips_in_its_tick_from_every_state_and_stays_latched() {
    for healthy in bench_in_each_state() {
        for (word, cause) in FAULT_CASES {
            // While off, the station ignores the fault line, which the comparator may have latched since the last
            // self-test.
            if word == "bridge" && healthy.state() == StateName::Off {
                continue;
            }
            let mut bench = healthy.clone();
            cause(&mut bench);
            let (drive, telemetry) = bench.step();
            let fault = telemetry.state.fault().map(|fault| fault.name());
            assert_eq!((drive, fault), (Drive::Off, Some(word)), "from {:?}", healthy.state());
            assert_eq!(telemetry.demand, 0);

            let tripped = ["err tripped by ", word, "; clear it first"].concat();
            let present = ["err fault ", word, " is still present"].concat();
            // The fault line may be latched by the comparator, which only the next self-test releases.
            if word == "bridge" {
                continue;
            }
            assert_eq!(bench.send("clear"), present);

            // The cause is gone, but no tick has sampled that yet.
            bench = TestBench { station: bench.station, ..healthy.clone() };
            assert_eq!(bench.send("clear"), present);
            for _ in 0..100 {
                assert_eq!(bench.step().0, Drive::Off, "{word}");
            }
            for (line, answer) in [("arm", tripped.as_str()), ("start", &tripped), ("abort", "ok")]
            {
                assert_eq!(bench.send(line), answer);
                assert_eq!(bench.step().0, Drive::Off, "{word} after {line}");
                assert_eq!(bench.state().name(), "tripped");
            }
            bench.send_ok(&["clear"]);
            assert_eq!((bench.step().0, bench.state().name()), (Drive::Off, "off"));
            bench.send_ok(&["arm", "start"]);
            assert!(matches!(bench.step().0, Drive::On(_)));
        }
    }
}

#[test]
fn the_first_fault_stays_latched_and_clear_is_refused_while_a_later_one_is_present() {
    let mut bench = TestBench::presenting("copper");
    bench.bridge_fault = true;
    bench.step();
    bench.bridge_fault = false;
    bench.sink_c = 50.0;
    bench.step();
    assert_eq!(bench.send("arm"), "err tripped by bridge; clear it first");
    assert_eq!(bench.send("clear"), "err fault sink-hot is still present");
    bench.sink_c = 25.0;
    bench.step();
    bench.send_ok(&["clear"]);
}

/// A fault that no sample shows is not lost when another one is already latched.
#[test]
fn clear_reports_an_external_fault_that_was_raised_while_tripped() {
    let mut bench = TestBench::presenting("copper");
    for fault in [Fault::SinkHot, Fault::SettingsCorrupt] {
        bench.station.trip_or_store_external_fault(fault);
    }
    bench.steps(2);
    assert_eq!(bench.state().fault(), Some(Fault::SinkHot));
    assert_eq!(bench.send("clear"), "err fault settings-corrupt is still present");
    assert_eq!(bench.state().fault(), Some(Fault::SettingsCorrupt));
    assert!(bench.send("cause").contains("settings-corrupt"));
    bench.send_ok(&["clear"]);
    assert_eq!(bench.state(), StateName::Off);
}

#[test]
fn clear_is_refused_until_a_tick_passes_without_the_external_fault() {
    let mut bench = TestBench::new();
    for _ in 0..3 {
        bench.station.trip_or_store_external_fault(Fault::Clock);
        bench.step();
        assert_eq!(bench.send("clear"), "err fault clock is still present");
    }
    bench.step();
    assert_eq!(bench.send("clear"), "ok");
}

/// At 42.8 °C the thermal dose rises by three quarters of its rate at 43 °C; the force sensor has failed before.
#[test]
fn the_dose_accumulates_while_another_fault_is_latched() {
    let mut bench = TestBench::presenting("copper");
    bench.force_n = -1.3;
    bench.step();
    (bench.display_c, bench.check_c) = (42.8, 42.8);
    bench.steps(32_000);
    assert_eq!(bench.send("clear"), "err fault force-sensor is still present");
    bench.force_n = 0.0;
    bench.steps(10_000);
    (bench.display_c, bench.check_c) = (39.5, 39.5);
    bench.steps(5);
    assert_eq!(bench.send("clear"), "err fault dose is still present");
}

/// Noise of 1.2 counts is 1.1 mN RMS, and exceeds 3 mN once in 800 ticks.
#[test]
fn force_sensor_noise_does_not_delay_the_self_test() {
    let mut bench = TestBench::new();
    assert_eq!(bench.send("arm"), "ok");
    // 744 ticks, which begin after up to 63.
    for tick in 0..808 {
        bench.force_n = if tick % 100 == 50 { 0.004 } else { 0.0 };
        bench.step_self_test();
    }
    assert_eq!(bench.state(), StateName::Armed);
}

/// With noise, a force near the detection threshold, or one that rises slowly through it, is detected intermittently.
#[test]
fn an_intermittently_detected_force_delays_the_self_test_by_at_most_two_seconds() {
    let near_threshold = |tick: u32| if tick % 7 < 4 { 0.004 } else { 0.002 };
    let slow_landing = |tick: u32| 1e-5 * f64::from(tick) + if tick % 7 < 4 { 1e-3 } else { 0.0 };
    for force in [&near_threshold as &dyn Fn(u32) -> f64, &slow_landing] {
        let mut bench = TestBench::new();
        assert_eq!(bench.send("arm"), "ok");
        for tick in 0..2750 {
            bench.force_n = force(tick);
            bench.step_self_test();
        }
        assert_eq!(bench.state(), StateName::Armed);
    }
}

#[test]
fn a_self_test_that_is_touched_again_and_again_trips_after_20_s() {
    let mut bench = TestBench::new();
    assert_eq!(bench.send("arm"), "ok");
    let mut ticks = 0;
    while bench.state() == StateName::SelfTest {
        bench.force_n = if ticks / 500 % 2 == 0 { 1.0 } else { 0.0 };
        bench.step_self_test();
        ticks += 1;
    }
    assert_eq!(bench.state().fault(), Some(Fault::NoResponse));
    assert!((20_080..20_150).contains(&ticks), "{ticks}");
}

/// One half of the bridge is defective, so that the display cannot be warmed.
#[test]
fn a_self_test_without_current_in_one_direction_trips() {
    let mut bench = TestBench::new();
    assert_eq!(bench.send("arm"), "ok");
    while bench.state() == StateName::SelfTest {
        let (outputs, telemetry) = bench.step_with_outputs();
        let flowing_a = telemetry.demand.to_num::<f64>().max(0.0);
        bench.measured_a = Some(flowing_a);
        bench.display_c -= 2.7e-3 * flowing_a;
        bench.check_c = bench.display_c;
        bench.apply_comparator_test(outputs.comparator_test);
    }
    assert_eq!(bench.state().fault(), Some(Fault::CurrentLow));
}

#[test]
fn a_fault_ends_the_simulated_contact() {
    let mut bench = TestBench::presenting_with_plate("copper");
    bench.force_n = 2.0;
    bench.steps(5000);
    bench.bridge_fault = true;
    bench.step();
    bench.bridge_fault = false;
    bench.step();
    bench.send_ok(&["clear", "arm", "start"]);
    let contact = bench.contact("copper", 24.0);
    assert_follows_contact(&mut bench, &contact, 0.0, 1000);
}

#[test]
fn the_demanded_current_saturates_at_its_limit_and_reverses_at_once() {
    let mut bench = TestBench::presenting("copper");
    bench.send_ok(&["law model"]);
    for (line, demand_a) in [("object 60", -6), ("object -20", 6)] {
        bench.send_ok(&[line]);
        // Shorter than the time after which a display that does not respond trips.
        for _ in 0..50 {
            let (_, telemetry) = bench.step();
            assert_eq!(telemetry.demand, demand_a);
        }
    }
}

/// From a steady state: the voltage drop of 6 A in leads and legs, the loss of the dead times and the Seebeck voltage,
/// as fractions of 12 V.
#[test]
fn the_bridge_voltage_is_the_feed_forward_of_the_demanded_current() {
    for (line, duty) in [("object 60", -0.5), ("object -20", 0.5)] {
        let mut bench = TestBench::new();
        let display_c = bench.skin_c;
        (bench.display_c, bench.check_c) = (display_c, display_c);
        bench.send_ok(&["law model", "material copper", line, "arm"]);
        bench.steps(1000);
        bench.send_ok(&["start"]);
        let (drive, telemetry) = bench.step();
        assert_eq!(telemetry.demand, 12.0 * duty);
        let Drive::On(voltage) = drive else { panic!("{drive:?}") };
        let voltage = voltage.fraction().to_num::<f64>();
        let seebeck_fraction = 0.0273 * (25.0 - display_c) / 12.0;
        let legs_above_27_c_k = (25.0 + display_c) / 2.0 - 27.0;
        let ohm = 0.05 + 1.061 * (1.0 + 0.0049 * legs_above_27_c_k);
        let expected = duty * (ohm + 0.21 / 6.0) + seebeck_fraction;
        assert!((voltage - expected).abs() < 1e-3, "{line}: {voltage}, {expected}");
    }
}

/// Advances by ticks with the same sums, but for `noise` in every second one.
fn repeat_samples(bench: &mut TestBench, samples: &Samples, ticks: u16, noise: u16) -> Drive {
    let mut drive = Drive::Off;
    for tick in 0..ticks {
        let mut noisy = *samples;
        for sum in [
            &mut noisy.display,
            &mut noisy.display_check,
            &mut noisy.sink,
            &mut noisy.skin,
            &mut noisy.room,
            &mut noisy.force,
        ] {
            *sum += tick % 2 * noise;
        }
        bench.station.note_host_activity();
        drive = bench.station.step(&noisy).drive;
    }
    drive
}

#[test]
fn samples_that_stop_to_change_trip_within_50_ms() {
    let mut bench = TestBench::presenting("copper");
    let samples = bench.samples();
    repeat_samples(&mut bench, &samples, 20, 3);
    repeat_samples(&mut bench, &samples, 46, 0);
    assert_eq!(bench.state(), StateName::Preset);
    let drive = repeat_samples(&mut bench, &samples, 1, 0);
    assert_eq!(
        (bench.state().fault().map(Fault::name), drive),
        (Some("samples-frozen"), Drive::Off)
    );
}

#[test]
fn a_broken_force_sensor_trips_after_30_ms() {
    for mut bench in bench_in_each_state() {
        let touching = bench.state();
        bench.force_n = -1.3;
        bench.steps(29);
        assert_eq!(bench.state(), touching, "the contact is kept");
        assert_eq!(bench.step().0, Drive::Off);
        assert_eq!(bench.state().fault(), Some(Fault::ForceSensor), "from {touching:?}");
    }
}

#[test]
fn samples_without_noise_trip_nothing() {
    let mut bench = TestBench::presenting_with_plate("copper");
    bench.noise = 0;
    bench.steps(1000);
    assert_eq!(bench.state(), StateName::Preset);
}

#[test]
fn display_thermistors_that_differ_by_more_than_3_k_trip_after_40_ms() {
    let mut bench = TestBench::presenting("copper");
    // Nearly the temperature at which this display, which does not respond, stands: no current that it would have to follow.
    bench.send_ok(&["object 30"]);
    let drift = |bench: &mut TestBench, difference_k: f64| {
        while (bench.check_c - bench.display_c - difference_k).abs() > 0.05 {
            bench.check_c += 0.1f64.copysign(bench.display_c + difference_k - bench.check_c);
            bench.step();
        }
    };
    drift(&mut bench, 2.9);
    bench.steps(200);
    assert_eq!(bench.state(), StateName::Preset);
    drift(&mut bench, -2.9);
    bench.steps(4);
    bench.check_c = bench.display_c - 3.1;
    // The detector needs 20 looks, at every second tick. The first may be in this tick or the next, so the last is in
    // the 39th tick or the 40th.
    bench.steps(38);
    assert_eq!(bench.state(), StateName::Preset);
    let (drive, _) = bench.steps(2);
    assert_eq!(
        (bench.state().fault().map(Fault::name), drive),
        (Some("displays-apart"), Drive::Off)
    );
}

/// The step is against the direction of the current, which could be mistaken for a wrong response; it comes in every
/// phase of the detectors' period.
#[test]
fn a_step_of_the_reading_trips_as_a_jump_in_every_phase() {
    for phase in 0..8 {
        let mut bench = TestBench::presenting("copper");
        bench.measured_a = None;
        bench.steps(300 + phase);
        let cooling = bench.display_c > bench.setpoint_c();
        bench.display_c += if cooling { 2.0 } else { -2.0 };
        bench.step();
        assert_eq!(bench.state().fault(), Some(Fault::DisplayJump), "{phase}");
    }
}

/// The comparator keeps the supply off after the sensor's wire is repaired, until the self-test resets it.
#[test]
fn a_latched_comparator_can_be_cleared() {
    let mut bench = TestBench::presenting("copper");
    let check_c = bench.check_c;
    (bench.check_c, bench.bridge_fault) = (-200.0, true);
    bench.step();
    assert_eq!(bench.state().fault().map(Fault::name), Some("check-open"));
    bench.check_c = check_c;
    bench.step();
    bench.send_ok(&["clear"]);
    assert_eq!(bench.state(), StateName::Off);
    bench.send_ok(&["arm"]);
    assert_eq!(bench.state(), StateName::Armed);
}

#[test]
fn a_fault_ends_a_hold() {
    let mut bench = TestBench::new();
    bench.send_ok(&["arm", "hold 41.5"]);
    bench.step();
    bench.emergency_stop = true;
    bench.step();
    bench.emergency_stop = false;
    bench.step();
    bench.send_ok(&["clear", "arm"]);
    bench.assert_reaches_setpoint(bench.skin_c);
}

/// A finger that lands during the self-test warms the display while the test cools it.
#[test]
fn the_self_test_passes_after_a_finger_has_landed_during_it() {
    let mut bench = TestBench::new();
    assert_eq!(bench.send("arm"), "ok");
    for tick in 0..3000 {
        if bench.state() != StateName::SelfTest {
            break;
        }
        bench.force_n = if tick < 150 { 0.0 } else { 1.0 };
        bench.step_self_test();
        bench.display_c += if (150..450).contains(&tick) { 2e-3 } else { 0.0 };
        bench.check_c = bench.display_c;
    }
    assert_eq!(bench.state(), StateName::Armed);
}
