//! Ticks against the host's time, with arrivals as a USB adapter delays them.

use std::time::Duration;

use thermal_client::client::DeviceClock;

/// Deterministic noise from 0 to 1.
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    (*seed >> 40) as f64 / (1u64 << 24) as f64
}

/// The estimate after telemetry every 10 ms for some seconds, of a device whose clock is off by so many parts in a million and
/// whose tick 0 was at `zero_s`. Lines arrive up to 4 ms late, and one in a hundred up to 60 ms.
fn observed(clock: &mut DeviceClock, zero_s: f64, ppm: f64, from: u32, seconds: u32) {
    let mut seed = 7;
    for i in 0..100 * seconds {
        let tick = from.wrapping_add(10 * i);
        let late = noise(&mut seed);
        let late_s = match i % 100 {
            0 => 0.06 * late,
            _ => 4e-3 * late,
        };
        let at_s = zero_s + f64::from(10 * i) * 1e-3 * (1.0 + 1e-6 * ppm) + late_s;
        clock.observe(tick, Duration::from_secs_f64(at_s));
    }
}

#[test]
fn offset_and_drift_are_found_within_the_stated_error() {
    for (ppm, seconds) in [(0.0, 10), (30.0, 60), (-50.0, 600), (20.0, 7200)] {
        let mut clock = DeviceClock::default();
        observed(&mut clock, 5.0, ppm, 0, seconds);
        for tick in [0, 1000 * seconds / 2, 1000 * (seconds - 1)] {
            let time = clock.time_of(tick).unwrap();
            let true_s = 5.0 + f64::from(tick) * 1e-3 * (1.0 + 1e-6 * ppm);
            let error_s = time.at_s - true_s;
            // The common delay, the least of 4 ms, is not seen.
            assert!(
                error_s.abs() <= time.error_s + 0.2e-3,
                "{ppm} ppm, {seconds} s, tick {tick}: {error_s}, {time:?}"
            );
            assert!(time.error_s < 1e-3, "{time:?}");
        }
        if seconds >= 600 {
            let drift_ppm = clock.time_of(0).unwrap().drift_ppm;
            assert!((drift_ppm - ppm).abs() < 2.0, "{drift_ppm}, {ppm}");
        }
    }
}

/// A computer that sleeps for 4 s reads what came meanwhile all at once when it wakes: no tick happens after its line has arrived, and
/// each within the stated error.
#[test]
fn lines_that_wait_while_the_computer_sleeps_do_not_move_the_estimate() {
    for sleeps_from_s in [0.0, 0.3, 1.5, 3.0, 20.0] {
        let mut clock = DeviceClock::default();
        let mut seed = 3;
        for i in 0..3000 {
            let true_s = 5.0 + 0.01 * f64::from(i);
            let asleep = (sleeps_from_s..sleeps_from_s + 4.0).contains(&(true_s - 5.0));
            let wakes_s = 5.0 + sleeps_from_s + 4.0;
            let at_s = if asleep { wakes_s } else { true_s } + 4e-3 * noise(&mut seed);
            let at = Duration::from_secs_f64(at_s);
            clock.observe(10 * i, at);
            let time = clock.time_of_arrived(10 * i, at).unwrap();
            assert!(time.at_s <= at.as_secs_f64(), "{time:?}");
            // Before it has slept and woken again, nothing but late lines may have come.
            if sleeps_from_s > 1.0 {
                assert!((time.at_s - true_s).abs() <= time.error_s + 4e-3, "{true_s} s: {time:?}");
                assert!(time.error_s < 0.02, "{true_s} s: {time:?}");
            }
        }
        let time = clock.time_of(15_000).unwrap();
        assert!(
            (time.at_s - 20.0).abs() <= time.error_s + 4e-3 && time.error_s < 0.02,
            "{sleeps_from_s} s: {time:?}"
        );
    }
}

#[test]
fn a_restart_begins_a_new_estimate() {
    let mut clock = DeviceClock::default();
    assert_eq!(clock.time_of(0), None);
    observed(&mut clock, 1.0, 10.0, 0, 20);
    assert_eq!(clock.restarts(), 0);
    observed(&mut clock, 40.0, 10.0, 0, 20);
    assert_eq!(clock.restarts(), 1);
    let time = clock.time_of(1000).unwrap();
    assert!((time.at_s - 41.0).abs() < 1e-3, "{time:?}");
}

/// Without checksums a damaged digit passes for a tick.
#[test]
fn damaged_ticks_neither_restart_the_estimate_nor_move_it() {
    for damaged in [&[200_017][..], &[17], &[30_517], &[17, 90_517, 4_000_000_000]] {
        let mut clock = DeviceClock::default();
        observed(&mut clock, 1.0, 10.0, 0, 30);
        let before = clock.time_of(30_000);
        for (i, tick) in damaged.iter().enumerate() {
            clock.observe(*tick, Duration::from_secs_f64(31.0 + 0.01 * i as f64));
        }
        assert_eq!(clock.time_of(30_000), before, "{damaged:?}");
        for i in 0..100 {
            let tick = 30_100 + 10 * i;
            clock.observe(tick, Duration::from_secs_f64(1.0 + 1.000_01e-3 * f64::from(tick)));
        }
        assert_eq!(clock.restarts(), 0, "{damaged:?}");
        let error_s = clock.time_of(31_000).unwrap().at_s - 32.000_31;
        assert!(error_s.abs() < 1e-3, "{damaged:?}: {error_s}");
    }
}

/// After a pause of the stream the ticks go on with the time that has passed, to the tolerance of an oscillator.
#[test]
fn a_stream_that_paused_for_an_hour_is_no_restart() {
    let mut clock = DeviceClock::default();
    observed(&mut clock, 1.0, 0.0, 0, 10);
    let tick = 3_600_000 + 36_000;
    clock.observe(tick, Duration::from_secs(3601));
    assert_eq!(clock.restarts(), 0);
    let time = clock.time_of(tick).unwrap();
    assert!((time.at_s - 3601.0).abs() < 40.0, "{time:?}");
}

/// After 49 days.
#[test]
fn a_tick_that_wraps_is_no_restart() {
    let mut clock = DeviceClock::default();
    observed(&mut clock, 1.0, 0.0, u32::MAX - 4999, 10);
    assert_eq!(clock.restarts(), 0);
    for (tick, true_s) in [(u32::MAX - 999, 5.0), (0, 6.0), (4000, 10.0)] {
        let time = clock.time_of(tick).unwrap();
        assert!((time.at_s - true_s).abs() < 1.2e-3, "{tick}: {time:?}");
    }
}

/// The fingers of one device are sampled within one tick; their lines overtake each other.
#[test]
fn lines_of_several_fingers_in_any_order_are_no_restart() {
    let mut clock = DeviceClock::default();
    for i in 0..1000u32 {
        let at = Duration::from_millis(u64::from(5 * i));
        for back in [0, 1, 5, 3] {
            clock.observe((1000 + 5 * i) - back, at);
        }
    }
    assert_eq!(clock.restarts(), 0);
}
