//! Force ramps of simulated fingers: layered tissue by finite volumes, blood, the tile, and the heat-flux sensor.

use contact_law_fit::{FORCES_N, Fit, RAMPS_S, Recording, Sample, fit, force_n};
use contact_model::material::{SKIN, find};
use contact_model::pressure::pressure_pa;
use contact_model::reference::mean_conductance;
use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::finger::FingerParams;
use thermal_plant::object::ObjectConfig;
use thermal_plant::parameters::{draw, draw_contact, draw_finger};
use thermal_plant::sensors::FluxParams;
use thermal_plant::{Params, Plant, PlantConfig, STEP_S};

/// Temperature at which the display is held, °C.
const HELD_C: f64 = 24.0;

/// A case: finger of `finger.draw`, contact of `contact.draw`, its sensor, and whether there is a gap.
fn params(seed: u64, sensor: fn(FluxParams) -> FluxParams, has_gap: bool) -> Params {
    let mut params = Params {
        finger: FingerParams::layered(),
        flux: Some(FluxParams::NOMINAL),
        ..Params::nominal()
    };
    let mut sensors = params.clone();
    draw(&mut sensors, seed);
    params.flux = sensors.flux.map(sensor);
    draw_contact(&mut params, seed);
    if !has_gap {
        params.contact.gap_w_m2k = 0.0;
    }
    draw_finger(&mut params.finger, seed, true);
    params
}

fn record(params: &Params, seed: u64) -> Recording {
    let config = PlantConfig {
        skin_c: 34.0,
        room_c: 24.0,
        object: ObjectConfig::half_space(*find("granite").expect("a material"), 24.0),
        start_s: 0.0,
        appears_s: 1000.0,
        duration_s: RAMPS_S,
        seed,
        params: params.clone(),
    };
    let mut plant = Plant::new(&config).expect("a plant");
    plant.connect_supply();
    let mut samples = Vec::new();
    let mut integral = 0.0;
    for step in 0..(RAMPS_S / STEP_S) as usize {
        let since_s = step as f64 * STEP_S;
        let force = force_n(since_s).expect("a ramp");
        plant.set_force(force);
        let above_k = plant.display_c() - HELD_C;
        integral += 0.5 * above_k * STEP_S;
        let drive = (0.25 * above_k + integral).clamp(-0.45, 0.45);
        plant.step(&BridgeOutputs {
            a: Leg::Duty(0.5 + drive),
            b: Leg::Duty(0.5),
            enabled: true,
        });
        if step % 10 == 9 {
            samples.push(Sample {
                since_s: since_s + STEP_S,
                flux_w_m2: FluxParams::read_w_m2(plant.flux_code().expect("a sensor")),
                surface_c: plant.display_c(),
                force_n: force,
            });
        }
    }
    Recording {
        // A thermistor in place is up to 30 mK off.
        skin_c: 34.0 + 0.03 * (12.9 * seed as f64).sin(),
        room_c: 24.0,
        display: params.display,
        layer_m2k_w: FluxParams::NOMINAL.resistance_m2k_w,
        samples,
    }
}

/// The plant's resistance of the finger on the display, m² K/W.
fn exact_m2k_w(params: &Params, force_n: f64) -> f64 {
    let contact = params
        .contact
        .at_force(force_n, &params.finger.surface, &params.display);
    params.finger.resistance_factor * contact.expect("a force").resistance_m2k_w
}

/// Median, 90 % and worst.
fn three(values: &[f64]) -> [f64; 3] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.5, 0.9, 1.0].map(|part| sorted[((sorted.len() - 1) as f64 * part).round() as usize])
}

/// Deviations of fits from the plants' own laws, without their signs.
#[derive(Default)]
struct Deviations {
    resistance_percent: [Vec<f64>; FORCES_N.len()],
    exponent: Vec<f64>,
    gap_w_m2k: Vec<f64>,
    /// Number of fits with a gap.
    gaps: usize,
    /// How many of the intervals of resistances, exponent and gap contain the plant's value.
    inside: [usize; FORCES_N.len() + 2],
}

fn deviations(sensor: fn(FluxParams) -> FluxParams, has_gap: bool, fingers: u64) -> Deviations {
    let mut found = Deviations::default();
    for seed in 0..fingers {
        let params = params(seed, sensor, has_gap);
        let fit = fit(&record(&params, seed)).expect("a good recording");
        let Fit { law, .. } = fit;
        let resistances_m2k_w = FORCES_N.map(|force_n| exact_m2k_w(&params, force_n));
        let fitted = fit.resistances_m2k_w.iter().zip(resistances_m2k_w);
        for (percent, (fitted, exact)) in found.resistance_percent.iter_mut().zip(fitted) {
            percent.push(100.0 * (fitted / exact - 1.0).abs());
        }
        // The law that a device is told has the resistances that are reported.
        let mean_w_m2k = mean_conductance::<f64>(&SKIN.surface, &params.display);
        for (force_n, fitted) in FORCES_N.iter().zip(fit.resistances_m2k_w) {
            let told_w_m2k = law.conductance_w_m2k(mean_w_m2k, pressure_pa(*force_n));
            assert!((fitted * told_w_m2k - 1.0).abs() < 1e-9);
        }
        // The factor is on the whole resistance.
        let gap = params.contact.gap_w_m2k / params.finger.resistance_factor;
        found
            .exponent
            .push((law.exponent - params.contact.exponent).abs());
        found.gap_w_m2k.push((law.gap_w_m2k - gap).abs());
        found.gaps += usize::from(law.gap_w_m2k > 0.0);
        let [a, b, c] = fit.resistance_intervals_m2k_w;
        let intervals = [a, b, c, fit.exponent_interval, fit.gap_interval_w_m2k];
        let [a, b, c] = resistances_m2k_w;
        let exact = [a, b, c, params.contact.exponent, gap];
        for (inside, (interval, exact)) in found.inside.iter_mut().zip(intervals.iter().zip(exact))
        {
            *inside += usize::from((interval.low..=interval.high).contains(&exact));
        }
    }
    let name = if has_gap {
        "with a gap"
    } else {
        "without a gap"
    };
    println!("{fingers} fingers {name}; median, 90 %, worst:");
    for (force_n, percent) in FORCES_N.iter().zip(&found.resistance_percent) {
        println!("  R at {force_n} N {:.1?} %", three(percent));
    }
    let (exponent, gap) = (three(&found.exponent), three(&found.gap_w_m2k));
    println!(
        "  exponent {exponent:.4?}, gap {gap:.0?} W/(m2 K), taken in {}",
        found.gaps
    );
    println!("  inside of the intervals: {:?}", found.inside);
    found
}

/// The resistance is to be within 10 %, and the exponent, where there is no gap, within 0.01.
#[track_caller]
fn assert_without_gap(sensor: fn(FluxParams) -> FluxParams, fingers: u64) {
    let found = deviations(sensor, false, fingers);
    assert_eq!(found.gaps, 0);
    for percent in &found.resistance_percent {
        assert!(three(percent)[2] < 6.0, "{percent:?} %");
    }
    let [median, most, worst] = three(&found.exponent);
    assert!(
        median < 0.007 && most < 0.0125 && worst < 0.0155,
        "{:?}",
        found.exponent
    );
    // Of 95 in a hundred.
    assert!(
        found.inside[..4]
            .iter()
            .all(|inside| *inside as f64 > 0.87 * fingers as f64)
    );
}

#[track_caller]
fn assert_with_gap(sensor: fn(FluxParams) -> FluxParams, fingers: u64) {
    let found = deviations(sensor, true, fingers);
    assert_eq!(found.gaps, fingers as usize);
    for percent in &found.resistance_percent {
        let [_, most, worst] = three(percent);
        assert!(most < 9.0 && worst < 12.0, "{percent:?} %");
    }
    assert!(three(&found.exponent)[2] < 0.065, "{:?}", found.exponent);
    let [median, _, worst] = three(&found.gap_w_m2k);
    assert!(
        median < 14.0 && worst < 75.0,
        "{:?} W/(m2 K)",
        found.gap_w_m2k
    );
    assert!(
        found
            .inside
            .iter()
            .all(|inside| *inside as f64 > 0.87 * fingers as f64)
    );
}

/// The sensor that was designed, within its tolerances.
fn designed(drawn: FluxParams) -> FluxParams {
    drawn
}

/// One of 1 %, 2.7 W/m² and 22 W/m² a conversion.
fn hypothetical(drawn: FluxParams) -> FluxParams {
    FluxParams {
        gain_error: drawn.gain_error / 1.5,
        zero_w_m2: drawn.zero_w_m2 * 2.7 / 3.5,
        noise_w_m2: 22.0,
        ..drawn
    }
}

#[test]
fn resistance_and_exponent_of_fingers_without_a_gap() {
    assert_without_gap(designed, 24);
    assert_without_gap(hypothetical, 12);
}

#[test]
fn resistance_and_gap_of_fingers_with_one() {
    assert_with_gap(designed, 24);
    assert_with_gap(hypothetical, 12);
}

#[test]
fn what_is_no_recording_of_the_ramps_is_refused() {
    let params = params(0, designed, false);
    let good = record(&params, 0);
    let refused = |change: &dyn Fn(&mut Recording)| {
        let mut recording = good.clone();
        change(&mut recording);
        fit(&recording).expect_err("refused").to_string()
    };
    assert_eq!(
        refused(&|recording| recording.samples.truncate(500)),
        "the recording has 5.00 s of contact; at least 9 s are needed"
    );
    assert_eq!(
        refused(&|recording| {
            recording.samples.remove(100);
        }),
        "the sample 1.020 s after landing follows the one before by 0.020 s; allowed is 0.01 s"
    );
    assert_eq!(
        refused(&|recording| recording.samples[9].flux_w_m2 = f64::NAN),
        "the flux, W/m2, is NaN at 0.100 s after landing; allowed is -1e5 to 1e5"
    );
    assert_eq!(
        refused(&|recording| recording.samples[9].force_n = 0.0),
        "the force, N, is 0 at 0.100 s after landing; allowed is 0.003 to 20, which is a contact"
    );
    assert_eq!(
        refused(&|recording| recording.skin_c = 134.0),
        "the skin, C, is 134 at 0.000 s after landing; allowed is -40 to 125"
    );
}
