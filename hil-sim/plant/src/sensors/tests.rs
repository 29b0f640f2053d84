//! All channels together, and what belongs to none of the parts alone.

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

/// Neither noise nor non-linearity, self-heating nor leads.
fn ideal() -> SensorParams {
    let mut params = SensorParams::NOMINAL;
    params.converter.noise_counts = 0.0;
    params.converter.inl_counts = 0.0;
    params.reference.excitation_duty = 0.0;
    for thermistor in &mut params.thermistors {
        thermistor.lead_share = 0.0;
    }
    params
}

fn counts(params: SensorParams, state: &Sensed) -> [u16; CHANNELS] {
    let mut sensors = Sensors::new(params, state, 1);
    Channel::ALL.map(|channel| sensors.convert(channel))
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
    let [display, check, sink, skin, room, force, current] = counts(ideal(), &state);
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
    let [display, _, sink, .., force, current] = counts(ideal(), &low);
    assert!(display > 4080 && sink < 8);
    assert_eq!((force, current), (4095, 4095));
    let mut noisy = ideal();
    noisy.converter.noise_counts = 50.0;
    let mut sensors = Sensors::new(noisy, &REST, 3);
    assert!(
        (0..1000).all(|_| sensors.convert(Channel::Current) < 300),
        "noise at zero does not wrap"
    );
}

#[test]
fn skin_thermistor_hardly_sees_the_contact() {
    // The thesis: 0.05 deg C where the skin in the contact changed by 3 to 5.
    let touched = Sensed {
        skin_c: 30.0,
        ..REST
    };
    let sensors = Sensors::new(ideal(), &touched, 1);
    let slope = (ideal().thermistors[3].ratio(33.5) - ideal().thermistors[3].ratio(34.5)) * CODES;
    let fell_c = (sensors.counts[Channel::Skin as usize]
        - ideal().thermistors[3].ratio(34.0) * CODES)
        / slope;
    assert!((fell_c - 0.05).abs() < 1e-3, "{fell_c} K");
}

#[test]
fn each_thermistor_has_its_own_parts() {
    let nominal = counts(ideal(), &REST);
    for changed in 0..THERMISTORS {
        let mut params = ideal();
        params.thermistors[changed].at_25c_ohm *= 1.01;
        let codes = counts(params, &REST);
        for (channel, (a, b)) in codes.iter().zip(nominal).enumerate() {
            assert_eq!(*a == b, channel != changed, "channel {channel}");
        }
    }
}

#[test]
fn reference_moves_only_what_has_a_scale_of_its_own() {
    let state = Sensed {
        force_n: 5.0,
        mirror_a: 4.0,
        ..REST
    };
    let mut params = ideal();
    params.reference.error = 0.01;
    let (nominal, moved) = (counts(ideal(), &state), counts(params, &state));
    assert_eq!(nominal[..THERMISTORS], moved[..THERMISTORS]);
    // 1910/1.01 and 1600/1.01.
    assert_eq!((moved[5], moved[6]), (1891, 1584));
}

#[test]
fn mirror_has_gain_error_and_offset_but_no_negative_current() {
    let mut params = ideal();
    params.mirror.gain_error = 0.05;
    params.mirror.offset_a = -0.1;
    let at = |mirror_a| counts(params, &Sensed { mirror_a, ..REST })[Channel::Current as usize];
    assert_eq!((at(0.0), at(0.05), at(2.0)), (0, 0, 800));
}

#[test]
fn force_sensor_follows_with_its_lag() {
    let mut sensors = Sensors::new(ideal(), &REST, 1);
    let pressed = Sensed {
        force_n: 2.0,
        ..REST
    };
    for k in 1..=6 {
        sensors.step(0.5e-3, &pressed);
        let wanted_n = 2.0 * (1.0 - (-0.5 * f64::from(k)).exp());
        assert!((sensors.force_n - wanted_n).abs() < 1e-12);
    }
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

/// A tick's conversions see the level on its way from the start of the step to its end.
#[test]
fn conversions_of_a_tick_move_evenly_to_the_end_of_the_step() {
    let mut params = SensorParams::NOMINAL;
    params.force.lag_s = 1e-9;
    params.converter.noise_counts = 0.0;
    params.converter.inl_counts = 0.0;
    let mut sensors = Sensors::new(params, &REST, 1);
    // 2 N are 600 counts above the zero of 410: 37.5 a conversion.
    sensors.step(
        1e-3,
        &Sensed {
            force_n: 2.0,
            ..REST
        },
    );
    for k in 1..=16 {
        let code = sensors.convert(Channel::Force);
        let level = 410.0 + 37.5 * f64::from(k);
        assert!(
            (f64::from(code) - level).abs() <= 0.5,
            "conversion {k}: {code}"
        );
    }
    assert_eq!(sensors.convert(Channel::Force), 1010, "and stay there");
}
