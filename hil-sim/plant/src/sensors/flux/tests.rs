use super::*;
use crate::STEP_S;

/// Without errors and noise, at a gain of one count per W/m2.
const IDEAL: FluxParams =
    FluxParams { noise_w_m2: 0.0, counts_per_w_m2: 1.0, ..FluxParams::NOMINAL };

/// Code after many lags under a constant flux, W/m2.
fn settled(params: FluxParams, defect: FluxDefect, flux_w_m2: f64) -> u16 {
    let mut sensor = FluxSensor::new(params, 0.0, 1);
    sensor.set_defect(defect);
    for _ in 0..200 {
        sensor.step(STEP_S, flux_w_m2);
    }
    sensor.code()
}

#[test]
fn step_response_is_the_exponential_of_the_lag() {
    for lag_s in [1e-3, 5e-3, 50e-3] {
        let mut sensor = FluxSensor::new(FluxParams { lag_s, ..IDEAL }, 0.0, 1);
        for step in 1..=300 {
            sensor.step(STEP_S, 2000.0);
            let exact = 2000.0 * (1.0 - (-f64::from(step) * STEP_S / lag_s).exp());
            let off = f64::from(sensor.code()) - 2048.0 - exact;
            // Half a count of quantisation.
            assert!(off.abs() <= 0.5 + 1e-9, "{lag_s} s, step {step}: {off}");
        }
    }
}

/// Mid-scale, 48 nV per W/m2 times 2000, 4096 codes of 3.3 V: 8.4 W/m2 a count, and +-17 kW/m2 in all.
#[test]
fn codes_have_the_designed_scale_and_end_at_the_rails() {
    let quiet = FluxParams { noise_w_m2: 0.0, ..FluxParams::NOMINAL };
    let code = |flux_w_m2| settled(quiet, FluxDefect::default(), flux_w_m2);
    assert_eq!(code(0.0), 2048);
    assert_eq!(code(8.4 * 100.0), 2148);
    assert_eq!(code(-8.4 * 100.0), 1948);
    assert_eq!(code(20e3), 4095);
    assert_eq!(code(-20e3), 0);
    for (code, flux_w_m2) in [(2048, 0.0), (2148, 838.9), (0, -17_181.0)] {
        let read_w_m2 = FluxParams::read_w_m2(code);
        assert!((read_w_m2 - flux_w_m2).abs() < 0.5, "{code}: {read_w_m2}");
    }
}

#[test]
fn gain_error_and_zero_are_those_of_the_parameters() {
    let params = FluxParams { gain_error: 0.1, zero_w_m2: -30.0, ..IDEAL };
    let code = |flux_w_m2| settled(params, FluxDefect::default(), flux_w_m2);
    assert_eq!(code(0.0), 2048 - 30);
    assert_eq!(code(1000.0), 2048 + 1100 - 30);
}

#[test]
fn noise_has_its_deviation_with_that_of_quantisation_and_no_mean() {
    const READINGS: u32 = 100_000;
    let params = FluxParams { zero_w_m2: 3.0, ..FluxParams::NOMINAL };
    let mut sensor = FluxSensor::new(params, 0.0, 7);
    let readings: Vec<f64> = (0..READINGS)
        .map(|_| {
            sensor.step(STEP_S, 0.0);
            FluxParams::read_w_m2(sensor.code())
        })
        .collect();
    let count = f64::from(READINGS);
    let mean = readings.iter().sum::<f64>() / count;
    let variance = (readings.iter().map(|w_m2| (w_m2 - mean).powi(2))).sum::<f64>() / count;
    // Quantisation: a twelfth of a count squared. 0.77 counts of noise linearise it.
    let exact = params.noise_w_m2.powi(2) + params.counts_per_w_m2.powi(-2) / 12.0;
    let five = 5.0 * (exact / count).sqrt();
    assert!((mean - 3.0).abs() < five, "{mean}");
    let off = variance / exact - 1.0;
    assert!(off.abs() < 5.0 * (2.0 / count).sqrt(), "{off}");
    // Neighbours in time are independent.
    let pairs = readings.windows(2).map(|w| (w[0] - mean) * (w[1] - mean));
    let correlation = pairs.sum::<f64>() / (count * variance);
    assert!(correlation.abs() < 5.0 / count.sqrt(), "{correlation}");
}

#[test]
fn noise_depends_on_the_seed_alone() {
    let codes = |seed| {
        let mut sensor = FluxSensor::new(FluxParams::NOMINAL, 0.0, seed);
        let codes: [u16; 100] = std::array::from_fn(|_| {
            sensor.step(STEP_S, 0.0);
            sensor.code()
        });
        codes
    };
    assert_eq!(codes(1), codes(1));
    assert_ne!(codes(1), codes(2));
}

#[test]
fn each_defect_shows_in_the_code() {
    let code = |defect: FluxDefect| settled(IDEAL, defect, 1000.0);
    let wired = |circuit| code(FluxDefect { circuit, ..FluxDefect::default() });
    assert_eq!(wired(FluxCircuit::Closed), 3048);
    assert_eq!(wired(FluxCircuit::Open), 4095);
    assert_eq!(wired(FluxCircuit::Short), 2048);
    assert_eq!(wired(FluxCircuit::Reversed), 1048);
    let weak = FluxDefect { gain: 0.5, ..FluxDefect::default() };
    assert_eq!(code(weak), 2548);
    let shifted = FluxDefect { zero_w_m2: 50.0, ..FluxDefect::default() };
    assert_eq!(code(shifted), 3098);

    let noisy = FluxParams { noise_w_m2: 1.0, ..IDEAL };
    let spread = |noise| {
        let mut sensor = FluxSensor::new(noisy, 0.0, 1);
        sensor.set_defect(FluxDefect { noise, ..FluxDefect::default() });
        let squares = (0..1000).map(|_| {
            sensor.step(STEP_S, 0.0);
            (f64::from(sensor.code()) - 2048.0).powi(2)
        });
        (squares.sum::<f64>() / 1000.0).sqrt()
    };
    let ratio = spread(50.0) / spread(1.0);
    assert!((44.0..53.0).contains(&ratio), "{ratio}");

    let mut sensor = FluxSensor::new(FluxParams::NOMINAL, 0.0, 1);
    sensor.set_defect(FluxDefect { stuck: true, ..FluxDefect::default() });
    let before = sensor.code();
    for _ in 0..100 {
        sensor.step(STEP_S, 5000.0);
        assert_eq!(sensor.code(), before);
    }
}
