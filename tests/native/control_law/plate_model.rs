//! The controller's plate model beside the simulated tile, tick by tick.
//!
//! The model runs in open loop: an unreachable target keeps the current at its limit, which the test chooses, and a thermistor
//! that reads what the model predicts leaves no innovation.

use documented_figures::{assert_figure, run_generator};
use thermal_plant::tile::{Tile, TileParams, ZERO_C_K};

use super::bench::{ControlLoop, ROOM_C, Sensor, advance, settings, ticks};

#[test]
fn the_models_constants_are_those_that_the_generator_prints() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/native/control_law/plate_relaxations.py");
    let source = include_str!("../../../src/device/src/estimate/plate_model.rs");
    for line in run_generator(script, &[]).unwrap_or_default().lines() {
        assert!(source.contains(line), "plate_model.rs lacks `{line}`");
    }
}

/// Times at which both are compared, s.
const TIMES_S: [f64; 9] = [0.02, 0.05, 0.1, 0.3, 1.0, 3.0, 10.0, 40.0, 100.0];

/// Responses of model and tile from rest to a constant current, A, and a load on the patch, W: time, s, and the temperature
/// change of each, K.
fn responses(current_a: f64, load_w: f64, seconds: f64) -> Vec<(f64, f64, f64)> {
    const LAG_S: f64 = 0.1;
    let mut settings = settings(LAG_S);
    settings.module.current_limit_a = current_a.abs();
    let mut control = ControlLoop::new(&settings);
    let mut tile = Tile::new(
        TileParams {
            // A sink that holds, as the model has it, and no air.
            sink_j_k: 1e9,
            film_w_m2k: 0.0,
            ..TileParams::NOMINAL
        },
        ROOM_C,
    );
    let mut predicted = Sensor::new(LAG_S, ROOM_C);
    let target_c = if current_a > 0.0 { 15.0 } else { 42.0 };
    let mut answer = Vec::new();
    // The first tick sets the initial state.
    let _none = control.step(ROOM_C, (ROOM_C, ROOM_C), 0.0);
    for tick in 1..=ticks(seconds) {
        let sensed_c = (predicted.reading_c, tile.sink_c());
        let given_a = control.step(target_c, sensed_c, load_w);
        advance(&mut tile, given_a, load_w);
        let legs =
            control.observer.leg_end_and_mean_temperatures().expect("after the first reading");
        let model_c: f64 = legs.cold.to_num();
        predicted.update(model_c);
        let tile_c = tile.patch_c() + load_w * tile.patch_half_k_w();
        let t_s = 1e-3 * tick as f64;
        if TIMES_S.iter().any(|at_s| (at_s - t_s).abs() < 1e-6) {
            assert!((given_a - current_a).abs() < 2e-3, "{given_a} A at {t_s} s");
            answer.push((t_s, model_c - ROOM_C, tile_c - ROOM_C));
        }
    }
    answer
}

/// Largest difference of model and tile beyond a constant, K, in % of the tile's response; prints both.
fn difference_percent(what: &str, answer: &[(f64, f64, f64)], beyond_k: f64) -> f64 {
    answer.iter().fold(0.0, |most, &(t_s, model_k, tile_k)| {
        let error_k = (model_k - tile_k).abs();
        println!(
            "{what}, {t_s} s: model {model_k:.4} K, tile {tile_k:.4} K, off by {error_k:.4} K"
        );
        f64::max(most, 100.0 * (error_k - beyond_k) / tile_k.abs())
    })
}

/// Beyond 3 mK per ampere, which a current causes within 20 ms.
#[test]
fn the_model_follows_the_tile_under_a_current() {
    let mut most = 0.0f64;
    for (current_a, seconds) in
        [(0.3, 40.0), (3.0, 0.3), (6.0, 0.3), (-0.3, 40.0), (-3.0, 0.3), (-6.0, 0.3)]
    {
        let answer = responses(current_a, 0.0, seconds);
        let (what, beyond_k) = (format!("{current_a} A"), 3e-3 * current_a.abs());
        most = most.max(difference_percent(&what, &answer, beyond_k));
    }
    assert_figure("plate.current_error", most);
}

/// Closer in the first 0.1 s, where the loop is slower than the plate, than later, while heat spreads over the plate.
#[test]
fn the_model_follows_the_tile_under_a_finger() {
    let (mut most_soon, mut most_late) = (0.0f64, 0.0f64);
    for load_w in [0.5, 2.0, -1.0] {
        let answer = responses(1e-3, load_w, 40.0);
        let (soon, late) = answer.split_at(3);
        let what = format!("{load_w} W");
        most_soon = most_soon.max(difference_percent(&what, soon, 0.0));
        most_late = most_late.max(difference_percent(&what, late, 0.0));
    }
    assert_figure("plate.finger_error_soon", most_soon);
    assert_figure("plate.finger_error_late", most_late);
}

/// The equation of a module without load, `a I Tc = I^2 R/2 + K (Th - Tc)`, with its hot side at the sink's temperature.
#[test]
fn the_models_steady_state_obeys_the_module_equation() {
    let class = TileParams::NOMINAL;
    for current_a in [0.1, -0.1] {
        let (_, model_k, _) = *responses(current_a, 0.0, 100.0).last().expect("the last time");
        let cold_k = ZERO_C_K + ROOM_C + model_k;
        let joule_w = class.resistance_ohm() * current_a * current_a;
        let pumped_w = class.seebeck_v_k() * current_a * cold_k - 0.5 * joule_w;
        let expected_k = -pumped_w / class.conductance_w_k();
        println!("{current_a} A: model {model_k:.4} K, module {expected_k:.4} K");
        assert!((model_k / expected_k - 1.0).abs() < 0.02, "{model_k} K, {expected_k} K");
    }
}
