//! Tiles whose parameters differ from the controller's model.

use documented_figures::assert_figure;
use thermal_plant::tile::TileParams;

use super::bench::{Bench, peak_to_peak, settings};

/// A parameter of the nominal tile, and how it is scaled.
type Change = (&'static str, fn(&mut TileParams, f64));

const CHANGES: [Change; 5] = [
    ("Seebeck coefficient", |tile, factor| tile.vmax_v *= factor),
    ("resistance", |tile, factor| tile.imax_a /= factor),
    ("conductance", |tile, factor| tile.dtmax_k /= factor),
    ("plates", |tile, factor| tile.ceramic_j_m3k *= factor),
    ("spreading", |tile, factor| tile.ceramic_w_mk *= factor),
];

/// An unknown load of 1 W on a tile with one parameter off by 10 %: the disturbance observer removes the error.
#[test]
fn a_parameter_off_by_10_percent_leaves_no_steady_state_error() {
    let mut most_left_k = 0.0f64;
    for (name, change) in CHANGES {
        for factor in [0.9, 1.1] {
            let mut params = TileParams::NOMINAL;
            change(&mut params, factor);
            let mut bench = Bench::new(&settings(0.1), params);
            bench.run(28.0, 30.0);
            bench.load_w = 1.0;
            let first = bench.run(28.0, 60.0);
            let steady = bench.run(28.0, 10.0);
            let largest = |ticks: &[super::bench::Tick]| {
                let errors = ticks.iter().map(|tick| (tick.display_c - 28.0).abs());
                errors.fold(0.0, f64::max)
            };
            let (disturbed_k, left_k) = (largest(&first), largest(&steady));
            let current_a = peak_to_peak(steady.iter().map(|tick| tick.current_a));
            println!(
                "{name} x {factor}: {:.1} mK at first, {:.3} mK in the end",
                1e3 * disturbed_k,
                1e3 * left_k
            );
            assert!(disturbed_k > 0.02, "{name}: the load disturbs by {disturbed_k} K");
            most_left_k = most_left_k.max(left_k);
            assert!(current_a < 0.02, "{name} x {factor}: {current_a} A");
        }
    }
    assert_figure("law.mismatch_left", 1e3 * most_left_k);
}
