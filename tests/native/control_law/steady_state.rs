//! No limit cycle at steady state.

use documented_figures::assert_figure;

use super::bench::{Bench, peak_to_peak};

/// Thermistor lags of 0.02 to 0.5 s, with and without the heat of a finger.
#[test]
fn there_is_no_limit_cycle_and_no_steady_state_error() {
    let (mut moves_k, mut moves_a, mut off_k) = (0.0f64, 0.0f64, 0.0f64);
    for lag_s in [0.02, 0.1, 0.5] {
        for (target_c, load_w) in [(24.0, 0.0), (34.0, 0.0), (20.0, 1.0), (41.0, -0.5)] {
            let mut bench = Bench::settled_at(lag_s, target_c);
            (bench.load_w, bench.known_load_w) = (load_w, load_w);
            bench.run(target_c, 120.0);
            let steady = bench.run(target_c, 10.0);
            let display_k = peak_to_peak(steady.iter().map(|tick| tick.display_c));
            let current_a = peak_to_peak(steady.iter().map(|tick| tick.current_a));
            let (first, last) = (steady[0].display_c, bench.display_c());
            println!(
                "lag {lag_s} s at {target_c} C, {load_w} W: display {:.4} mK, current {:.3} mA, off by {:.4} mK",
                1e3 * display_k,
                1e3 * current_a,
                1e3 * (last - target_c)
            );
            (moves_k, moves_a) = (moves_k.max(display_k), moves_a.max(current_a));
            for t_c in [first, last] {
                off_k = off_k.max((t_c - target_c).abs());
            }
        }
    }
    assert_figure("law.rest_display", 1e3 * moves_k);
    assert_figure("law.rest_current", 1e3 * moves_a);
    assert_figure("law.rest_error", 1e3 * off_k);
}
