//! Second law: heat flows to the colder body, and entropy never decreases.

use contact_model::material::find;

use super::*;
use crate::tile::ZERO_C_K;

/// Temperatures of all bodies, deg C.
fn extremes_c(bench: &Bench) -> (f64, f64) {
    let mut all: Vec<f64> = Vec::new();
    for (index, slab) in [(0, &bench.finger), (1, &bench.finger), (2, &bench.object)] {
        all.extend((0..slab.cells()).map(|node| bench.heat.slabs.node_c(index, node)));
    }
    all.extend(bench.heat.tile.nodes().map(|(_, t)| t));
    let fold = |f: fn(f64, f64) -> f64, start| all.iter().copied().fold(start, f);
    (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY))
}

#[test]
fn without_current_temperatures_stay_within_their_initial_range() {
    for name in ["copper", "abs", "foam"] {
        let material = find(name).expect("known");
        let mut bench = Bench::plain(material);
        let mut last = (ROOM_C - 1e-12, SKIN_C + 1e-12);
        for k in 0..30_000 {
            if k % 6000 == 0 {
                let (on_display, on_object) = touch(material, [2.0, 0.0, 0.1, 0.0, 1.0][k / 6000]);
                bench.touch(on_display, on_object);
            }
            bench.step(None);
            let (coldest_c, warmest_c) = extremes_c(&bench);
            // Apart from rounding, the range of temperatures only narrows.
            assert!(
                coldest_c >= last.0 - 1e-10 && warmest_c <= last.1 + 1e-10,
                "{name}, step {k}: {coldest_c} to {warmest_c} after {last:?}"
            );
            last = (coldest_c, warmest_c);
            for finger in [Finger::OnDisplay, Finger::OnObject] {
                let under_c = match finger {
                    Finger::OnDisplay => bench.heat.display_c(),
                    Finger::OnObject => bench.heat.object_c(),
                };
                let fall_c = bench.heat.skin_c(finger) - under_c;
                let flux_w_m2 = bench.heat.flux_w_m2(finger);
                assert!(flux_w_m2 * fall_c >= 0.0, "{name}, step {k}: {flux_w_m2} over {fall_c}");
            }
        }
    }
}

/// Entropy of finger and tile relative to 0 deg C, J/K. The finger counts with its contact area.
fn entropy_j_k(bench: &Bench, area_m2: f64) -> f64 {
    let of = |capacity: f64, t_c: f64| capacity * (t_c / ZERO_C_K).ln_1p();
    let finger: f64 = (bench.finger.capacity_j_m2k.iter().enumerate())
        .map(|(node, capacity)| of(capacity * area_m2, bench.heat.slabs.node_c(0, node)))
        .sum();
    finger + bench.heat.tile.nodes().map(|(capacity, t)| of(capacity, t)).sum::<f64>()
}

/// Entropy production of finger, tile and room in each step. The flows of a step are those of its mean temperatures, so
/// that the discretisation error could decrease the entropy.
#[test]
fn entropy_never_decreases() {
    let material = find("copper").expect("known");
    let mut bench = Bench::plain(material);
    let (on_display, on_object) = touch(material, 1.0);
    let area_m2 = on_display.expect("pressed").area_m2;
    let room_k = ROOM_C + ZERO_C_K;
    let (mut before_j_k, mut to_room_j) = (entropy_j_k(&bench, area_m2), 0.0);
    let (mut least_j_k, mut made_j_k) = (f64::INFINITY, 0.0);
    for k in 0..60_000usize {
        if k % 10_000 == 2000 {
            let touching = k / 10_000 % 2 == 0;
            bench.touch(on_display.filter(|_| touching), on_object.filter(|_| touching));
        }
        // With and without contact, cooling, off and heating.
        bench.step([Some(4.0), None, Some(-2.0)][k / 5000 % 3]);
        let now_j_k = entropy_j_k(&bench, area_m2);
        let given_j = bench.heat.energy().to_room_j;
        let gain_j_k = now_j_k - before_j_k + (given_j - to_room_j) / room_k;
        least_j_k = least_j_k.min(gain_j_k);
        made_j_k += gain_j_k;
        (before_j_k, to_room_j) = (now_j_k, given_j);
    }
    println!("entropy made in 60 s: {made_j_k:.4} J/K; least in a step: {least_j_k:.1e} J/K");
    assert!(made_j_k > 0.1);
    // Rounding of the sum over the nodes, about 1e2 J/K.
    assert!(least_j_k > -1e-12, "entropy falls by {least_j_k} J/K in a step");
}
