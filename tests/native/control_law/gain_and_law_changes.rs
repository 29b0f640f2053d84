//! Bumpless transfer: gains and controllers that change while a finger is on the display.

use documented_figures::assert_figure;
use thermal_display::device::control::Law;
use thermal_display::settings::Tile;

use super::bench::{Bench, IDENTIFIED, settings_of};

const TARGET_C: f64 = 26.0;

/// At steady state under a load of 1 W, half of it known to the controller.
fn loaded() -> Bench {
    let mut bench = Bench::settled_at(0.1, TARGET_C);
    (bench.load_w, bench.known_load_w) = (1.0, 0.5);
    bench.run(TARGET_C, 60.0);
    bench
}

/// The largest of what several changes have done to current and display.
#[derive(Default)]
struct Largest {
    step_a: f64,
    error_k: f64,
}

impl Largest {
    /// Runs three seconds after a change: takes the step of the current in the first tick, and the largest error of the
    /// display, into account, and prints them.
    fn observe(&mut self, change: &str, bench: &mut Bench) {
        let before_a = bench.current_a;
        let after = bench.run(TARGET_C, 3.0);
        let step_a = (after[0].current_a - before_a).abs();
        let errors = after.iter().map(|tick| (tick.display_c - TARGET_C).abs());
        let error_k = errors.fold(0.0, f64::max);
        println!(
            "{change}: from {before_a:.3} A by {:.3} mA, {:.3} mK",
            1e3 * step_a,
            1e3 * error_k
        );
        self.step_a = self.step_a.max(step_a);
        self.error_k = self.error_k.max(error_k);
    }
}

fn retune(bench: &mut Bench, tile: Tile) {
    bench.control.set_parameters(&settings_of(tile));
}

/// A new identification of the tile changes the model's gain by up to 25 %: the display stays within what people can feel.
#[test]
fn the_model_based_controller_changes_gains_without_a_bump() {
    let mut largest = Largest::default();
    for factor in [0.8, 0.9, 1.1, 1.25] {
        let mut bench = loaded();
        let tile = Tile { gain_k_s_a: factor * IDENTIFIED.gain_k_s_a, ..IDENTIFIED };
        retune(&mut bench, tile);
        largest.observe(&format!("gain x {factor}"), &mut bench);
    }
    assert_figure("law.regain_current", largest.step_a);
    assert_figure("law.regain_error", 1e3 * largest.error_k);
}

/// The PI controllers keep their integral, and so their current.
#[test]
fn the_pi_controllers_change_gains_without_a_bump() {
    let mut largest = Largest::default();
    for law in [Law::Pi, Law::Pi10Hz] {
        for factor in [0.5, 2.0] {
            let mut bench = loaded();
            bench.control.controller.select_law(law);
            bench.run(TARGET_C, 60.0);
            let tile = Tile { gain_k_s_a: factor * IDENTIFIED.gain_k_s_a, ..IDENTIFIED };
            retune(&mut bench, tile);
            largest.observe(&format!("{}, gain x {factor}", law.name()), &mut bench);
        }
    }
    assert_figure("law.plain_regain_current", 1e3 * largest.step_a);
    assert_figure("law.plain_regain_error", 1e3 * largest.error_k);
}

/// The prediction keeps its state when its lag changes.
#[test]
fn the_sensor_lag_changes_without_a_bump() {
    let mut largest = Largest::default();
    for sensor_lag_s in [0.02, 0.05, 0.2, 0.5] {
        let mut bench = loaded();
        retune(&mut bench, Tile { sensor_lag_s, ..IDENTIFIED });
        largest.observe(&format!("lag {sensor_lag_s} s"), &mut bench);
    }
    assert_figure("law.relag_current", 1e3 * largest.step_a);
    assert_figure("law.relag_error", 1e3 * largest.error_k);
}

/// A change of controller keeps the present current; the disturbance is below what people can feel.
#[test]
fn the_controller_changes_without_a_bump() {
    let (mut largest, mut most_left_k) = (Largest::default(), 0.0f64);
    for (from, to) in [
        (Law::Model, Law::Pi),
        (Law::Model, Law::Pi10Hz),
        (Law::Pi, Law::Model),
        (Law::Pi10Hz, Law::Model),
    ] {
        let mut bench = Bench::settled_at(0.1, TARGET_C);
        (bench.load_w, bench.known_load_w) = (1.0, 1.0);
        bench.control.controller.select_law(from);
        bench.run(TARGET_C, 60.0);
        bench.control.controller.select_law(to);
        largest.observe(&format!("{} to {}", from.name(), to.name()), &mut bench);
        bench.run(TARGET_C, 20.0);
        let left_k = (bench.display_c() - TARGET_C).abs();
        most_left_k = most_left_k.max(left_k);
    }
    assert_figure("law.change_current", 1e3 * largest.step_a);
    assert_figure("law.change_error", 1e3 * largest.error_k);
    assert_figure("law.change_left", 1e3 * most_left_k);
}
