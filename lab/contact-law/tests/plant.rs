//! Force ramps of simulated fingers: layered tissue by finite volumes, blood, the tile, and the heat-flux sensor.

mod deviations;

use contact_law_fit::{FORCES_N, Recording, Sample, TOTAL_S, fit, force_n};
use contact_model::material::{SKIN, find};
use contact_model::pressure::pressure_pa;
use contact_model::reference::conductance_at_hardness;
use documented_figures::assert_figure;
use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::finger::FingerParams;
use thermal_plant::object::ObjectConfig;
use thermal_plant::parameters::{draw, draw_contact, draw_finger};
use thermal_plant::sensors::FluxParams;
use thermal_plant::{Params, Plant, PlantConfig, STEP_S};

use deviations::{Deviations, Exact};

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
        duration_s: TOTAL_S,
        seed,
        params: params.clone(),
    };
    let mut plant = Plant::new(&config).expect("a plant");
    plant.connect_supply();
    let mut samples = Vec::new();
    let mut integral = 0.0;
    for step in 0..(TOTAL_S / STEP_S) as usize {
        let since_s = step as f64 * STEP_S;
        let force = force_n(since_s).expect("a ramp");
        plant.set_force(force);
        let above_k = plant.display_c() - HELD_C;
        integral += 0.5 * above_k * STEP_S;
        let drive = (0.25 * above_k + integral).clamp(-0.45, 0.45);
        plant.step(&BridgeOutputs { a: Leg::Duty(0.5 + drive), b: Leg::Duty(0.5), enabled: true });
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

/// Compares fits with their plants.
#[track_caller]
fn assert_fits(kind: &str, sensor: fn(FluxParams) -> FluxParams, has_gap: bool, fingers: u64) {
    let mut deviations = Deviations::default();
    for seed in 0..fingers {
        let params = params(seed, sensor, has_gap);
        let fit = fit(&record(&params, seed)).expect("a good recording");
        // The law that a device is told has the resistances that are reported.
        let at_hardness_w_m2k = conductance_at_hardness::<f64>(&SKIN.surface, &params.display);
        for (force_n, fitted) in FORCES_N.iter().zip(fit.resistances_m2k_w) {
            let told_w_m2k = (fit.law).conductance_w_m2k(at_hardness_w_m2k, pressure_pa(*force_n));
            assert!((fitted * told_w_m2k - 1.0).abs() < 1e-9);
        }
        deviations.add(&fit, &Exact::of(&params));
    }
    deviations.assert_figures(assert_figure, &format!("contact-fit.{kind}"), has_gap);
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
    assert_fits("no_gap", designed, false, 24);
    assert_fits("no_gap_hypothetical", hypothetical, false, 12);
}

#[test]
fn resistance_and_gap_of_fingers_with_one() {
    assert_fits("gap", designed, true, 24);
    assert_fits("gap_hypothetical", hypothetical, true, 12);
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
