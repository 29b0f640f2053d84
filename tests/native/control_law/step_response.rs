//! Responses to steps of the target and of the load.

use documented_figures::assert_figure;
use thermal_display::device::drive::Current;
use thermal_plant::tile::TileParams;

use super::bench::{Bench, settings, settled, ticks};

const LAGS_S: [f64; 3] = [0.02, 0.1, 0.5];

#[test]
fn a_step_of_the_target_is_followed_with_little_overshoot() {
    let (mut most_k, mut small_k, mut most_part) = (0.0f64, 0.0f64, 0.0f64);
    for lag_s in LAGS_S {
        for (from_c, to_c) in [(30.0, 29.9), (30.0, 28.0), (34.0, 24.0), (24.0, 24.1), (24.0, 40.0)]
        {
            let mut bench = Bench::settled_at(lag_s, from_c);
            let answer = bench.run(to_c, 10.0);
            let sign = f64::signum(to_c - from_c);
            let beyond = answer.iter().map(|tick| sign * (tick.display_c - to_c));
            let beyond_k = beyond.fold(f64::NEG_INFINITY, f64::max);
            let settled_s = settled(&answer, to_c, 0.01).map(|tick| 1e-3 * tick as f64);
            println!(
                "lag {lag_s} s, {from_c} to {to_c} C: overshoot {:.2} mK, within 10 mK after {settled_s:?} s",
                1e3 * beyond_k
            );
            most_k = most_k.max(beyond_k);
            if f64::abs(to_c - from_c) < 1.0 {
                small_k = small_k.max(beyond_k);
            } else {
                most_part = most_part.max(beyond_k / f64::abs(to_c - from_c));
            }
        }
    }
    assert_figure("law.overshoot", 1e3 * most_k);
    assert_figure("law.overshoot_small", 1e3 * small_k);
    assert_figure("law.overshoot_part", 100.0 * most_part);
}

/// After five seconds at the current limit towards an unreachable target the controller recovers as fast as one that starts
/// afresh. On a tile with a parameter off by 10 % the disturbance observer has to adapt from cooling to heating, which takes a
/// little longer.
#[test]
fn the_current_limit_causes_no_windup() {
    let mut longest_s = 0.0f64;
    let class = TileParams::NOMINAL;
    let weak = TileParams { vmax_v: 0.9 * class.vmax_v, ..class };
    let heavy = TileParams { ceramic_j_m3k: 1.1 * class.ceramic_j_m3k, ..class };
    let mut settings = settings(0.1);
    settings.module.current_limit_a = 0.3;
    for (name, params) in [("class", class), ("weak", weak), ("heavy", heavy)] {
        for (from_c, target_c, step_k) in [(30.0, 15.0, 0.5), (20.0, 42.0, -0.5)] {
            let mut bench = Bench::new(&settings, params);
            bench.run(from_c, 60.0);
            let limited = bench.run(target_c, 5.0);
            let at_limit = limited.iter().filter(|tick| tick.current_a.abs() > 0.2999).count();
            assert!(at_limit > ticks(4.9), "{name}: {at_limit} ticks at the limit");
            // The same controller without its past.
            let mut afresh = bench.clone();
            afresh.control.observer.invalidate();
            afresh.control.controller.track_current(Current::ZERO);
            let reachable_c = bench.display_c() + step_k;
            let [recovered, fresh] = [&mut bench, &mut afresh].map(|bench| {
                let answer = bench.run(reachable_c, 10.0);
                settled(&answer, reachable_c, 0.02).map(|tick| 1e-3 * tick as f64)
            });
            println!(
                "{name}, towards {target_c} C: recovers in {recovered:?} s, afresh {fresh:?} s"
            );
            let (recovered, fresh) = (recovered.expect("recovers"), fresh.expect("settles"));
            longest_s = longest_s.max(recovered - fresh);
            assert!(
                name != "class" || recovered <= fresh,
                "{target_c} C: {recovered} s, afresh {fresh} s"
            );
        }
    }
    assert_figure("law.recovery", longest_s);
}

/// A finger's 1 W on the patch: the known load is compensated by feed-forward.
#[test]
fn a_known_load_disturbs_a_tenth_of_an_unknown_one() {
    let largest_k = |known_load_w: f64| {
        let mut bench = Bench::settled_at(0.1, 26.0);
        (bench.load_w, bench.known_load_w) = (1.0, known_load_w);
        let answer = bench.run(26.0, 3.0);
        let late = answer.iter().skip(50);
        late.map(|tick| (tick.display_c - 26.0).abs()).fold(0.0, f64::max)
    };
    let (known_k, unknown_k) = (largest_k(1.0), largest_k(0.0));
    assert_figure("law.known_load", 1e3 * known_k);
    assert_figure("law.unknown_load", 1e3 * unknown_k);
    assert!(unknown_k > 10.0 * known_k, "{unknown_k} K");
}
