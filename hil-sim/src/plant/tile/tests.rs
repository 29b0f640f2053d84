//! Against the closed form of a module at rest, and the response that a study of this class of module found.

use super::*;

const STEP_S: f64 = 0.5e-3;
/// Long enough for rest in one step: the scheme is L-stable.
const REST_S: f64 = 1e12;

/// A tile alone at 34 deg C.
fn warm() -> (Tile, Chain) {
    let params = TileParams::CLASS;
    let chain = Chain::new(
        params.capacities_j_k().to_vec(),
        &params.links(),
        vec![34.0; NODES],
    );
    (Tile::new(params, 0), chain)
}

fn mean(mean_a: f64) -> Current {
    Current {
        mean_a,
        ..Current::default()
    }
}

#[test]
fn at_rest_obeys_the_module_equations() {
    let TileParams {
        seebeck_v_k: a,
        resistance_ohm: r,
        conductance_w_k: k,
        ..
    } = TileParams::CLASS;
    for current_a in [-3.0, -0.5, 0.0, 1.0, 4.0, 6.0] {
        for load_w in [0.0, 1.0, 5.0] {
            let (mut tile, mut chain) = warm();
            // Ripple is heat, and neither pumps nor counts as a mean.
            let rippled = Current {
                ripple_a2: 0.5,
                ..mean(current_a)
            };
            tile.drive(&mut chain, &rippled, 24.0);
            chain.set_source(0, load_w, 0.0);
            for _ in 0..4 {
                chain.step(REST_S);
            }
            let cold_k = chain.temperature_c(COLD_TAB) + ZERO_C_K;
            let hot_k = chain.temperature_c(HOT_TAB) + ZERO_C_K;
            let joule_w = (current_a * current_a + 0.5) * r;
            let taken_w = a * current_a * cold_k - joule_w / 2.0 - k * (hot_k - cold_k);
            let given_w = a * current_a * hot_k + joule_w / 2.0 - k * (hot_k - cold_k);
            let volts = a * (hot_k - cold_k) + current_a * r;
            let to_room_w = (tile.sink_c(&chain) - 24.0) / TileParams::CLASS.sink_k_w;
            let load = tile.load(&chain);
            let driven_a = (volts - load.seebeck_v) / load.resistance_ohm;
            assert!(
                (driven_a - current_a).abs() < 1e-9,
                "{volts} V drives {driven_a} A"
            );
            let scale_w = 1.0 + joule_w + load_w;
            for (what, got_w, want_w) in [
                ("load", load_w, taken_w),
                ("sink", to_room_w, given_w),
                (
                    "electrical",
                    tile.electrical_w(&chain),
                    current_a * volts + 0.5 * r,
                ),
            ] {
                assert!(
                    (got_w - want_w).abs() < 1e-6 * scale_w,
                    "{what} at {current_a} A, {load_w} W: {got_w} is not {want_w}"
                );
            }
        }
    }
}

/// Temperature of the face every step after a current is switched on at 34 deg C in a room of 24.
fn response_c(current_a: f64, steps: usize) -> Vec<f64> {
    let (mut tile, mut chain) = warm();
    (0..steps)
        .map(|_| {
            tile.drive(&mut chain, &mean(current_a), 24.0);
            chain.step(STEP_S);
            chain.temperature_c(0)
        })
        .collect()
}

#[test]
fn responds_like_its_class() {
    // 2.7 K/s per A, 34 to 24 deg C in 0.85 s at 6 A, both within 15 %.
    for current_a in [1.0, 3.0, 6.0] {
        let face_c = response_c(current_a, 400);
        let fastest_c = face_c.windows(2).map(|w| w[0] - w[1]).fold(0.0, f64::max);
        let slope = fastest_c / STEP_S / current_a;
        assert!(
            (slope / 2.7 - 1.0).abs() < 0.15,
            "{slope} K/s per A at {current_a} A"
        );
    }
    let face_c = response_c(6.0, 4000);
    let reached_s = face_c.iter().position(|&c| c < 24.0).map(|k| k as f64 * STEP_S);
    assert!(
        reached_s.is_some_and(|t| (t / 0.85 - 1.0).abs() < 0.15),
        "{reached_s:?}"
    );
}
