//! All channels together.

use super::*;

const NOMINAL_INPUTS: SensorInputs = SensorInputs {
    display_c: 24.0,
    sink_c: 30.0,
    skin_before_c: 34.0,
    skin_c: 34.0,
    room_c: 22.0,
    force_n: 0.0,
    mirror_a: 0.0,
    mirror_ripple: InductorRipple { half_a: 0.0, width: 0.0 },
    supply_counts: 0.0,
};

/// Parameters without noise, non-linearity, self-heating and lead error.
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

fn counts(params: SensorParams, state: &SensorInputs) -> [u16; CHANNELS] {
    let mut sensors = Sensors::new(params, state, 1);
    Channel::ALL.map(|channel| sensors.convert(channel))
}

#[test]
fn channels_come_in_scan_order() {
    let state = SensorInputs {
        display_c: 10.0,
        sink_c: 20.0,
        skin_before_c: 30.0,
        skin_c: 30.0,
        room_c: 40.0,
        force_n: 2.0,
        mirror_a: 3.0,
        mirror_ripple: InductorRipple { half_a: 0.0, width: 0.0 },
        supply_counts: 3464.0,
    };
    let [display, check, sink, skin, room, force, current, supply] = counts(ideal(), &state);
    assert!(display == check && display > sink && sink > skin && skin > room);
    assert_eq!((force, current, supply), (1010, 1200, 3464));
}

#[test]
fn counts_stay_within_twelve_bits() {
    let low = SensorInputs {
        display_c: -100.0,
        sink_c: 500.0,
        force_n: 13.0,
        mirror_a: 11.0,
        ..NOMINAL_INPUTS
    };
    let [display, _, sink, .., force, current, _] = counts(ideal(), &low);
    assert!(display > 4080 && sink < 8);
    assert_eq!((force, current), (4095, 4095));
    let mut noisy = ideal();
    noisy.converter.noise_counts = 50.0;
    let mut sensors = Sensors::new(noisy, &NOMINAL_INPUTS, 3);
    assert!(
        (0..1000).all(|_| sensors.convert(Channel::Current) < 300),
        "noise at zero does not wrap"
    );
}

#[test]
fn skin_thermistor_responds_weakly_to_the_contact() {
    // Thesis: a change of 0.05 deg C while the skin under the contact changed by 3 to 5 deg C.
    let touched = SensorInputs { skin_c: 30.0, ..NOMINAL_INPUTS };
    let sensors = Sensors::new(ideal(), &touched, 1);
    let slope = (ideal().thermistors[3].ratio(33.5) - ideal().thermistors[3].ratio(34.5)) * CODES;
    let fell_c = (sensors.counts[Channel::Skin as usize]
        - ideal().thermistors[3].ratio(34.0) * CODES)
        / slope;
    assert!((fell_c - 0.05).abs() < 1e-3, "{fell_c} K");
}

#[test]
fn each_thermistor_has_its_own_parameters() {
    let nominal = counts(ideal(), &NOMINAL_INPUTS);
    for changed in 0..THERMISTORS {
        let mut params = ideal();
        params.thermistors[changed].at_25c_ohm *= 1.01;
        let codes = counts(params, &NOMINAL_INPUTS);
        for (channel, (a, b)) in codes.iter().zip(nominal).enumerate() {
            assert_eq!(*a == b, channel != changed, "channel {channel}");
        }
    }
}

#[test]
fn reference_error_affects_force_and_current_only() {
    let state = SensorInputs { force_n: 5.0, mirror_a: 4.0, ..NOMINAL_INPUTS };
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
    let at = |mirror_a| {
        counts(params, &SensorInputs { mirror_a, ..NOMINAL_INPUTS })[Channel::Current as usize]
    };
    assert_eq!((at(0.0), at(0.05), at(2.0)), (0, 0, 800));
}

#[test]
fn force_sensor_has_a_first_order_lag() {
    let mut sensors = Sensors::new(ideal(), &NOMINAL_INPUTS, 1);
    let pressed = SensorInputs { force_n: 2.0, ..NOMINAL_INPUTS };
    for k in 1..=6 {
        sensors.step(0.5e-3, &pressed);
        let expected_n = 2.0 * (1.0 - (-0.5 * f64::from(k)).exp());
        assert!((sensors.force_n - expected_n).abs() < 1e-12);
    }
}

#[test]
fn same_seed_gives_the_same_codes() {
    let run = |seed| {
        let mut sensors = Sensors::new(SensorParams::NOMINAL, &NOMINAL_INPUTS, seed);
        (0..500).map(|k| sensors.convert(Channel::ALL[k % CHANNELS])).collect::<Vec<_>>()
    };
    assert_eq!(run(5), run(5));
    assert_ne!(run(5), run(6));
}

#[test]
fn conversions_of_a_tick_interpolate_linearly_over_the_step() {
    let mut params = SensorParams::NOMINAL;
    params.force.lag_s = 1e-9;
    params.converter.noise_counts = 0.0;
    params.converter.inl_counts = 0.0;
    let mut sensors = Sensors::new(params, &NOMINAL_INPUTS, 1);
    // 2 N are 600 counts above the zero of 410: 37.5 counts per conversion.
    sensors.step(1e-3, &SensorInputs { force_n: 2.0, ..NOMINAL_INPUTS });
    for k in 1..=16 {
        let code = sensors.convert(Channel::Force);
        let level = 410.0 + 37.5 * f64::from(k);
        assert!((f64::from(code) - level).abs() <= 0.5, "conversion {k}: {code}");
    }
    assert_eq!(sensors.convert(Channel::Force), 1010, "and stay there");
}

#[test]
fn a_scan_has_the_codes_of_its_channels_one_by_one() {
    let moved = SensorInputs {
        display_c: 20.0,
        force_n: 2.0,
        mirror_a: 1.5,
        mirror_ripple: InductorRipple { half_a: 0.4, width: 0.3 },
        supply_counts: 3464.0,
        ..NOMINAL_INPUTS
    };
    // A single conversion before the scans moves them across the batches of noise.
    for single in [0, 1] {
        let mut by_scan = Sensors::new(SensorParams::NOMINAL, &NOMINAL_INPUTS, 7);
        let mut by_channel = by_scan.clone();
        for sensors in [&mut by_scan, &mut by_channel] {
            for _ in 0..single {
                sensors.convert(Channel::Display);
            }
        }
        for _ in 0..3 {
            by_scan.step(1e-3, &moved);
            by_channel.step(1e-3, &moved);
            for scan in 0..SCANS_PER_STEP + 2 {
                let expected = Channel::ALL.map(|channel| by_channel.convert(channel));
                assert_eq!(by_scan.convert_scan(), expected, "scan {scan}, {single} before");
            }
        }
    }
}
