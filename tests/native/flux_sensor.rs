//! The heat-flux sensor: the plant's parameters, the circuit's bench, the page with the error budget, and what else could
//! measure the flux.

use std::path::Path;

use contact_model::pressure::contact_area_m2;
use documented_figures::assert_figure;
use hardware_benches::netlist::Netlists;
use hardware_benches::ngspice;
use thermal_plant::parameters::{self, Parameter};
use thermal_plant::sensors::FluxParams;
use thermal_plant::{Params, tile::TileParams};
use thermal_settings::FluxSensor;
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::metrics::figures;
use thermal_sim::run::run;
use thermal_sim::scene::Scene;

use super::electrical_parameters::Simulated;

fn plant(key: &str) -> Parameter {
    let params = Params { flux: Some(FluxParams::NOMINAL), ..Params::nominal() };
    let all = parameters::all(&params);
    let found = all.into_iter().find(|parameter| parameter.key == key);
    found.unwrap_or_else(|| panic!("the plant has no {key}"))
}

#[track_caller]
fn assert_near(key: &str, plant: f64, circuit: f64, share: f64) {
    let off = circuit / plant - 1.0;
    assert!(off.abs() <= share, "{key}: {plant}, the circuit has {circuit}");
}

#[test]
fn the_plants_sensor_is_that_of_circuit_and_budget() {
    let netlists = Netlists::load().expect("the netlists of the repository");
    let part = |name: &str| netlists.param(name).expect("a parameter");
    let layer_m2k_w = part("flux_layer_m") / part("flux_layer_w_mk");
    let resistance = plant("flux.resistance_m2k_w");
    assert_near("resistance", resistance.value, layer_m2k_w, 0.01);
    assert_figure("flux-sensor.resistance", 1e6 * layer_m2k_w);
    let sensitivity_v = part("flux_pairs") * part("flux_seebeck") * layer_m2k_w;
    assert_figure("flux-sensor.sensitivity", 1e9 * sensitivity_v);
    if !ngspice::is_installed() {
        println!("skipped: ngspice is not installed, which `cargo xtask hardware` provides");
        return;
    }
    let bench = Simulated::by_bench("flux", &netlists);
    let gain = 1e-3 * bench.of("gain");
    assert_near("gain", plant("flux.counts_per_w_m2").value, gain, 2e-3);
    assert_figure("flux-sensor.count", gain.recip());
    assert_figure("flux-sensor.range", 2.048 / gain);
    let reached_s = 1e-3 * bench.of("step of the flux to 63 %");
    assert_near("lag", plant("flux.lag_s").value, reached_s, 0.05);
    assert_figure("flux-sensor.lag", 1e3 * reached_s);
    let noise_w_m2 = bench.of("noise, all");
    assert_near("noise", plant("flux.noise_w_m2").value, noise_w_m2, 0.03);
    assert_figure("flux-sensor.noise", bench.of("noise, with quantisation"));
    // The limits of the draws are two standard deviations away.
    let zero_w_m2 = bench.of("zero, all");
    assert_near("zero", 0.5 * plant("flux.zero_w_m2").high, zero_w_m2, 0.02);
    assert_figure("flux-sensor.zero", zero_w_m2);
    assert_figure("flux-sensor.zero_uncorrected", bench.of("zero, all, with a converter"));
    let gain_percent = bench.of("gain, all");
    let drawn_percent = 50.0 * plant("flux.gain_error").high;
    assert_near("error of the gain", drawn_percent, gain_percent, 0.08);
    assert!(gain_percent <= drawn_percent, "{gain_percent} %");
    assert_figure("flux-sensor.gain", gain_percent);

    let page = include_str!("../../docs/flux.md");
    let mut lines = 0;
    for quantity in bench.quantities() {
        let is_of_budget =
            ["zero, ", "noise, ", "gain, "].iter().any(|begin| quantity.name.starts_with(begin));
        if is_of_budget {
            let row = format!("| {} | {:.2} ", quantity.name, quantity.value);
            assert!(page.contains(&row), "docs/flux.md has no {row:?}");
            lines += 1;
        }
    }
    assert_eq!(lines, 20, "lines of the budget");
}

/// What a perfect model of the plate still makes of an error of the tile's current, and of its conductance, in the flux of a
/// contact at 2 N: the heat at the display's face is `(Seebeck) T I - R I^2 / 2 - K (T_sink - T_display)`.
#[test]
fn an_exact_current_is_no_flux_sensor() {
    let tile = TileParams::NOMINAL;
    let area_m2 = contact_area_m2(2.0);
    // Display at 25 deg C.
    let pumped_w_a = tile.seebeck_v_k() * 298.15;
    let of_current_w_m2 = |ampere: f64| pumped_w_a * ampere / area_m2;
    // 10 uV across 10 mohm; and two amplifiers of 25 uV across 5 mohm, as fitted.
    assert_figure("flux-current.zero", of_current_w_m2(10e-6 / 10e-3));
    assert_figure("flux-current.fitted", of_current_w_m2(25e-6 / 5e-3));
    // 0.2 % of 1 A, and 1 % of the conductance at 10 K across the tile.
    assert_figure("flux-current.scale", of_current_w_m2(2e-3));
    assert_figure("flux-current.conductance", 0.01 * tile.conductance_w_k() * 10.0 / area_m2);
}

#[test]
fn the_sensor_that_the_device_is_told_of_is_the_plants() {
    let (device, plant) = (FluxSensor::DESIGNED, FluxParams::NOMINAL);
    assert_eq!(device.counts_per_w_m2, plant.counts_per_w_m2);
    assert_eq!(device.lag_ms, 1e3 * plant.lag_s);
    assert_eq!(device.resistance_mm2k_w, 1e6 * plant.resistance_m2k_w);
    assert_eq!(FluxParams::read_w_m2(device.zero_counts as u16), 0.0);
    assert_eq!((plant.gain_error, plant.zero_w_m2), (0.0, 0.0));
}

/// Largest error of the skin after 50 ms on granite at 2 N, mK.
fn skin_error_mk(device: &str) -> f64 {
    let text = format!(
        "duration_s = 6\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"granite\"\n{device}\
         [[force]]\nt_s = 1\nforce_n = 2\n"
    );
    let scene = Scene::parse(&text, Path::new("a scene")).expect("a scene");
    let mut engine = NativeEngine::new(World::new(&scene).expect("a plant"));
    let outcome = run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
    let error = figures(&scene, &outcome).skin_error_mk.expect("a contact");
    error.max_after_50ms.expect("a contact of more than 50 ms")
}

#[test]
fn a_device_that_does_not_know_the_layer_is_off_by_it() {
    assert_figure("flux-layer.without", skin_error_mk(""));
    let untold_mk = skin_error_mk("[device]\nflux_sensor = true\n");
    assert_figure("flux-layer.untold", untold_mk);
}
