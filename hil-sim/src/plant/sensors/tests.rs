//! Against the divider's published slopes, the definition of a first-order lag, and the statistics asked for.

use super::*;

const REST: Sensed = Sensed {
    display_c: 24.0,
    sink_c: 30.0,
    skin_before_c: 34.0,
    skin_c: 34.0,
    room_c: 22.0,
    force_n: 0.0,
    mirror_a: 0.0,
};

fn quiet() -> SensorParams {
    SensorParams {
        noise: 0.0,
        bow: 0.0,
        ..SensorParams::NOMINAL
    }
}

fn counts(params: SensorParams, state: &Sensed) -> [u16; CHANNELS] {
    let mut sensors = Sensors::new(params, state, 1);
    Channel::ALL.map(|channel| sensors.convert(channel))
}

#[test]
fn divider_has_the_slopes_of_its_class() {
    let ratio = |c: f64| SensorParams::NOMINAL.thermistor.ratio(c);
    assert!((ratio(25.0) - 0.5).abs() < 1e-15);
    for (at_c, counts_per_k) in [(24.0, 46.0), (34.0, 41.0), (45.0, 34.0)] {
        let slope = (ratio(at_c - 0.5) - ratio(at_c + 0.5)) * CODES;
        assert!((slope - counts_per_k).abs() < 0.5, "{slope} counts/K at {at_c}");
    }
}

#[test]
fn channels_come_in_scan_order() {
    let state = Sensed {
        display_c: 10.0,
        sink_c: 20.0,
        skin_before_c: 30.0,
        skin_c: 30.0,
        room_c: 40.0,
        force_n: 2.0,
        mirror_a: 3.0,
    };
    let [display, check, sink, skin, room, force, current] = counts(quiet(), &state);
    assert!(display == check && display > sink && sink > skin && skin > room);
    assert_eq!((force, current), (1010, 1200));
}

#[test]
fn counts_stay_within_twelve_bits() {
    let low = Sensed {
        display_c: -100.0,
        sink_c: 500.0,
        force_n: 13.0,
        mirror_a: 11.0,
        ..REST
    };
    let [display, _, sink, .., force, current] = counts(quiet(), &low);
    assert!(display > 4080 && sink < 8);
    assert_eq!((force, current), (4095, 4095));
    let noisy = SensorParams {
        noise: 50.0,
        ..quiet()
    };
    let mut sensors = Sensors::new(noisy, &REST, 3);
    assert!(
        (0..1000).all(|_| sensors.convert(Channel::Current) < 300),
        "noise at zero does not wrap"
    );
}

#[test]
fn skin_thermistor_hardly_sees_the_contact() {
    let touched = Sensed { skin_c: 24.0, ..REST };
    let seen = counts(quiet(), &touched)[Channel::Skin as usize];
    let half_a_kelvin_below = quiet().thermistor.ratio(33.5) * CODES;
    assert!((f64::from(seen) - half_a_kelvin_below).abs() <= 0.5);
}

#[test]
fn thermistor_trails_by_its_lag() {
    let lag_s = 0.1;
    let step_s = 0.5e-3;
    let mut sensors = Sensors::new(quiet(), &REST, 1);
    // A ramp of 10 K/s: after many lags the reading trails by lag times rate.
    for k in 1..=4000 {
        sensors.step(
            step_s,
            &Sensed {
                display_c: 24.0 + 10.0 * step_s * f64::from(k),
                ..REST
            },
        );
    }
    assert!((sensors.reached_c[0] - (44.0 - 10.0 * lag_s)).abs() < 1e-6);
    // Then at rest: the rest of it decays exponentially.
    let held = Sensed {
        display_c: 44.0,
        ..REST
    };
    for _ in 0..200 {
        sensors.step(step_s, &held);
    }
    let left_c = 44.0 - sensors.reached_c[0];
    assert!((left_c - 10.0 * lag_s * (-1.0f64).exp()).abs() < 1e-6, "{left_c}");
}

#[test]
fn noise_has_the_width_asked_for_and_no_bias() {
    let params = SensorParams {
        bow: 0.0,
        ..SensorParams::NOMINAL
    };
    let mut sensors = Sensors::new(params, &REST, 7);
    let n = 200_000;
    let draws: Vec<f64> = (0..n)
        .map(|_| f64::from(sensors.convert(Channel::Display)))
        .collect();
    let mean = draws.iter().sum::<f64>() / f64::from(n);
    let variance = draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / f64::from(n);
    // Quantisation adds 1/12; five standard errors.
    let expected = 0.7f64.powi(2) + 1.0 / 12.0;
    let exact = params.thermistor.ratio(24.0) * CODES;
    assert!(
        (mean - exact).abs() < 5.0 * (expected / f64::from(n)).sqrt(),
        "bias {}",
        mean - exact
    );
    assert!(
        (variance / expected - 1.0).abs() < 5.0 * (2.0 / f64::from(n)).sqrt(),
        "variance {variance}"
    );
}

#[test]
fn seed_fixes_every_draw() {
    let run = |seed| {
        let mut sensors = Sensors::new(SensorParams::NOMINAL, &REST, seed);
        (0..500)
            .map(|k| sensors.convert(Channel::ALL[k % CHANNELS]))
            .collect::<Vec<_>>()
    };
    assert_eq!(run(5), run(5));
    assert_ne!(run(5), run(6));
}

#[test]
fn bow_differs_between_converters_within_its_bound() {
    // At 25 deg C the divider is at mid-scale, where the bow is highest.
    let state = Sensed {
        display_c: 25.0,
        ..REST
    };
    let heights: Vec<f64> = (0..200)
        .map(|seed| Sensors::new(SensorParams::NOMINAL, &state, seed).counts[0] - CODES / 2.0)
        .collect();
    let (low, high) = heights
        .iter()
        .fold((0.0f64, 0.0f64), |(l, h), &x| (l.min(x), h.max(x)));
    assert!(
        (-1.5..-1.3).contains(&low) && (1.3..=1.5).contains(&high),
        "{low} to {high}"
    );
}
