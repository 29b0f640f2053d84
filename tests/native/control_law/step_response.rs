//! Responses to steps of the target and of the load.

use thermal_display::drive::Current;
use thermal_plant::tile::TileParams;

use super::bench::{Bench, settings, settled, ticks};

const LAGS_S: [f64; 3] = [0.02, 0.1, 0.5];

/// Allowed overshoot: a fraction of the step, plus a constant in K.
const OVERSHOOT: f64 = 0.01;
const OVERSHOOT_K: f64 = 0.005;

#[test]
fn a_step_of_the_target_is_followed_without_overshoot() {
    for lag_s in LAGS_S {
        for (from_c, to_c) in [
            (30.0, 29.9),
            (30.0, 28.0),
            (34.0, 24.0),
            (24.0, 24.1),
            (24.0, 40.0),
        ] {
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
            let allowed_k = OVERSHOOT_K + OVERSHOOT * (to_c - from_c).abs();
            assert!(
                beyond_k < allowed_k,
                "{lag_s} s, {from_c} to {to_c} C: {beyond_k} K"
            );
        }
    }
}

/// After five seconds at the current limit towards an unreachable target the controller recovers as fast as one that starts
/// afresh. On a tile with a parameter off by 10 % the disturbance observer has to adapt from cooling to heating: a quarter of
/// its integral time is allowed for that.
#[test]
fn the_current_limit_causes_no_windup() {
    let class = TileParams::CLASS;
    let weak = TileParams {
        vmax_v: 0.9 * class.vmax_v,
        ..class
    };
    let heavy = TileParams {
        ceramic_j_m3k: 1.1 * class.ceramic_j_m3k,
        ..class
    };
    let mut settings = settings(0.1);
    settings.module.current_limit_a = 0.3;
    for (name, params, more_s) in [
        ("class", class, 0.05),
        ("weak", weak, 0.25),
        ("heavy", heavy, 0.25),
    ] {
        for (from_c, target_c, step_k) in [(30.0, 15.0, 0.5), (20.0, 42.0, -0.5)] {
            let mut bench = Bench::new(&settings, params);
            bench.run(from_c, 60.0);
            let limited = bench.run(target_c, 5.0);
            let at_limit = limited
                .iter()
                .filter(|tick| tick.current_a.abs() > 0.2999)
                .count();
            assert!(
                at_limit > ticks(4.9),
                "{name}: {at_limit} ticks at the limit"
            );
            // The same controller without its past.
            let mut afresh = bench.clone();
            afresh.control.lose_sight();
            afresh.control.follow(Current::ZERO);
            let reachable_c = bench.display_c() + step_k;
            let [recovered, fresh] = [&mut bench, &mut afresh].map(|bench| {
                let answer = bench.run(reachable_c, 10.0);
                settled(&answer, reachable_c, 0.02).map(|tick| 1e-3 * tick as f64)
            });
            println!(
                "{name}, towards {target_c} C: recovers in {recovered:?} s, afresh {fresh:?} s"
            );
            let (recovered, fresh) = (recovered.expect("recovers"), fresh.expect("settles"));
            assert!(
                recovered <= fresh + more_s,
                "{name}, {target_c} C: {recovered} s, afresh {fresh} s"
            );
        }
    }
}

/// A finger's 1 W on the patch: the known load is compensated by feed-forward.
#[test]
fn a_known_load_disturbs_a_tenth_of_an_unknown_one() {
    let largest_k = |known_load_w: f64| {
        let mut bench = Bench::settled_at(0.1, 26.0);
        (bench.load_w, bench.known_load_w) = (1.0, known_load_w);
        let answer = bench.run(26.0, 3.0);
        let late = answer.iter().skip(50);
        late.map(|tick| (tick.display_c - 26.0).abs())
            .fold(0.0, f64::max)
    };
    let (known_k, unknown_k) = (largest_k(1.0), largest_k(0.0));
    println!(
        "1 W, 50 ms later: {:.1} mK, unknown {:.1} mK",
        1e3 * known_k,
        1e3 * unknown_k
    );
    assert!(known_k < 0.02, "{known_k} K");
    assert!(unknown_k > 10.0 * known_k, "{unknown_k} K");
}
