//! Force ramps of simulated fingers: layered tissue by finite volumes, blood, the tile, and the heat-flux sensor.

use contact_law_fit::{FORCES_N, Fit, RAMPS_S, Recording, Sample, fit, force_n};
use contact_model::material::find;
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

fn percentile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * part).round() as usize]
}

/// Median, 90 % and worst.
fn three(mut values: Vec<f64>) -> [f64; 3] {
    [0.5, 0.9, 1.0].map(|part| percentile(&mut values, part))
}

#[derive(Default)]
struct Errors {
    resistance_percent: [Vec<f64>; FORCES_N.len()],
    exponent: Vec<f64>,
    gap_w_m2k: Vec<f64>,
    gaps_taken: usize,
    inside: [usize; 5],
}

fn errors(sensor: fn(FluxParams) -> FluxParams, has_gap: bool, fingers: u64) -> Errors {
    let mut errors = Errors::default();
    for seed in 0..fingers {
        let params = params(seed, sensor, has_gap);
        let Fit {
            law,
            resistances_m2k_w,
            resistance_intervals_m2k_w,
            exponent_interval,
            gap_interval_w_m2k,
            fall_by_gap,
            residual_k,
        } = fit(&record(&params, seed)).expect("a good recording");
        for (of, force_n) in FORCES_N.into_iter().enumerate() {
            let exact = exact_m2k_w(&params, force_n);
            errors.resistance_percent[of].push(100.0 * (resistances_m2k_w[of] / exact - 1.0).abs());
            let both = resistance_intervals_m2k_w[of];
            errors.inside[of] += usize::from((both.low..both.high).contains(&exact));
        }
        let gap = params.contact.gap_w_m2k / params.finger.resistance_factor;
        errors
            .exponent
            .push((law.exponent - params.contact.exponent).abs());
        errors.gap_w_m2k.push((law.gap_w_m2k - gap).abs());
        errors.gaps_taken += usize::from(law.gap_w_m2k > 0.0);
        errors.inside[3] += usize::from(
            (exponent_interval.low..exponent_interval.high).contains(&params.contact.exponent),
        );
        errors.inside[4] +=
            usize::from((gap_interval_w_m2k.low..gap_interval_w_m2k.high).contains(&gap));
        println!(
            "  {seed}: R {:?} %, exponent {:.4} of {:.4}, gap {:.0} of {gap:.0}, fall {fall_by_gap:.1}, left {:.1} mK",
            errors
                .resistance_percent
                .each_ref()
                .map(|all| (10.0 * all[all.len() - 1]).round() / 10.0),
            law.exponent,
            params.contact.exponent,
            law.gap_w_m2k,
            1e3 * residual_k
        );
    }
    errors
}

fn designed(drawn: FluxParams) -> FluxParams {
    drawn
}

/// 1 %, 2.7 W/m² and 22 W/m² a tick.
fn hypothetical(drawn: FluxParams) -> FluxParams {
    FluxParams {
        gain_error: drawn.gain_error / 1.5,
        zero_w_m2: drawn.zero_w_m2 * 2.7 / 3.5,
        noise_w_m2: 22.0,
        ..drawn
    }
}

#[test]
fn figures() {
    let fingers = std::env::var("FINGERS").map_or(12, |text| text.parse().expect("a number"));
    for (name, sensor) in [
        ("designed", designed as fn(FluxParams) -> FluxParams),
        ("1 %", hypothetical),
    ] {
        for has_gap in [false, true] {
            println!("{name}, gap {has_gap}");
            let found = errors(sensor, has_gap, fingers);
            for (force_n, percent) in FORCES_N.iter().zip(found.resistance_percent) {
                println!("R at {force_n} N: {:.1?} %", three(percent));
            }
            println!(
                "exponent {:.4?}, gap {:.0?}, taken {}, inside {:?}",
                three(found.exponent),
                three(found.gap_w_m2k),
                found.gaps_taken,
                found.inside
            );
        }
    }
}
