use super::*;

const TWO_PI: f64 = core::f64::consts::TAU;

/// A detector, and the number of its last tick.
struct Detector {
    contact: ContactDetector,
    tick: u32,
}

/// A detector whose force has been zero for long enough.
fn at_rest() -> Detector {
    let mut detector = Detector { contact: ContactDetector::default(), tick: 0 };
    (0..OSCILLATION_HOLD_TICKS).for_each(|_| _ = update(&mut detector, 0.0));
    detector
}

/// Feeds a signal, N relative to the zero, as the force sensor would show it.
fn update(detector: &mut Detector, signal_n: f64) -> bool {
    detector.tick += 1;
    let force = Force::from_num(signal_n.max(0.0));
    detector.contact.update_contact(detector.tick, force, signal_n < -0.008)
}

#[test]
fn one_noisy_tick_neither_begins_nor_ends_a_contact() {
    let mut detector = at_rest();
    for signal_n in [0.1, 0.0, 0.1, 0.0] {
        update(&mut detector, signal_n);
        assert!(!detector.contact.touching());
    }
    update(&mut detector, 0.1);
    update(&mut detector, 0.1);
    assert!(detector.contact.touching());
    for signal_n in [0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0] {
        update(&mut detector, signal_n);
        assert!(detector.contact.touching());
    }
    update(&mut detector, 0.0);
    assert!(!detector.contact.touching());
}

#[test]
fn a_landing_is_dated_back_to_when_the_force_left_its_zero() {
    for (rise, delay_ticks) in [
        (&[0.5, 0.9][..], 2),
        (&[0.001, 0.005, 0.02], 2),
        (&[0.005, 0.011, 0.016, 0.02], 4),
        (&[0.005, 0.001, 0.004, 0.03], 2),
    ] {
        let mut detector = at_rest();
        for (tick, force_n) in rise.iter().enumerate() {
            assert!(!detector.contact.touching(), "{rise:?}, tick {tick}");
            update(&mut detector, *force_n);
        }
        assert!(detector.contact.touching(), "{rise:?}");
        assert_eq!(detector.contact.detection_delay_ticks(), delay_ticks, "{rise:?}");
    }
}

/// A finger of 0.1 N on a cell that oscillates by 50 mN: found within the 18 ticks that no half period of 30 Hz or more lasts.
#[test]
fn an_oscillation_delays_a_landing_and_begins_none() {
    for hz in [30.0, 47.0, 200.0] {
        let mut detector = at_rest();
        let oscillation_n = |tick: i32| -0.05 * libm::sin(TWO_PI * hz * 1e-3 * f64::from(tick));
        for tick in 0..2000 {
            update(&mut detector, oscillation_n(tick));
            assert!(!detector.contact.touching(), "{hz} Hz, tick {tick}");
        }
        let landed = (2000..2100).find(|tick| {
            update(&mut detector, 0.1 + oscillation_n(*tick));
            detector.contact.touching()
        });
        let after = landed.expect("a landing") - 1999;
        assert!(after <= 18, "{hz} Hz: {after} ticks");
    }
}

/// A finger that held a sensor for 75 s while its zero drifted by 2 mN/s, and lifts: 0.15 N are left.
#[test]
fn a_drift_that_a_contact_hid_ends_with_the_contact() {
    let mut detector = at_rest();
    let drift_n = |tick: i32| (2e-6 * f64::from(tick)).min(0.15);
    for tick in 0..75_000 {
        assert!(!update(&mut detector, 1.0 + drift_n(tick)));
    }
    let found = (75_000..80_000).find(|tick| update(&mut detector, drift_n(*tick)));
    let after_ms = found.expect("a lift") - 75_000;
    assert!((512..=640).contains(&after_ms), "{after_ms} ms");
    assert!(!detector.contact.touching());
}

/// It never dropped, so it is a finger, however long it stays.
#[test]
fn a_light_contact_that_landed_at_once_stays_one() {
    let mut detector = at_rest();
    for tick in 0..600_000 {
        // A soft cell rings after the landing.
        let ring_n = 0.1 * libm::exp(-7.7e-3 * f64::from(tick));
        update(&mut detector, 0.1 - ring_n * libm::cos(TWO_PI * 0.041 * f64::from(tick)));
        assert_eq!(detector.contact.touching(), tick >= 3, "tick {tick}");
    }
}

#[test]
fn a_zero_that_has_fallen_during_a_contact_is_taken_anew() {
    let mut detector = at_rest();
    for _ in 0..1000 {
        update(&mut detector, 1.0);
    }
    let found = (0..100).find(|_| update(&mut detector, -0.12));
    assert_eq!(found, Some(29 + 32), "30 ticks to the lift, 32 below zero");
}
