//! Air takes heat from what it reaches, and from nothing else.

use contact_model::material::find;

use super::*;
use crate::tile::TileParams;

/// Heat stored in a lane, J/m2.
fn stored_j_m2(bench: &Bench, lane: usize, slab: &Slab) -> f64 {
    let heat = slab.capacity_j_m2k.iter().enumerate();
    heat.map(|(node, capacity)| capacity * bench.heat.slabs.node_c(lane, node))
        .sum()
}

/// Without blood and core: what a finger and an object lose is what they give each other and, apart, the air.
#[test]
fn lifted_surfaces_lose_to_the_air_and_touching_ones_do_not() {
    let granite = find("granite").expect("known");
    let object = ObjectConfig {
        thickness_m: 5e-3,
        ..ObjectConfig::half_space(*granite, 40.0)
    };
    let mut bench = Bench::new(&FingerParams::homogeneous(), &object, TileParams::CLASS);
    let film_w_m2k = 15.0;
    bench.heat.lifted_w_m2k = bench
        .heat
        .surface_m2k_w
        .map(|m2k_w| 1.0 / (m2k_w + 1.0 / film_w_m2k));
    let (on_display, on_object) = touch(granite, 1.0);
    for (display, on, there) in [
        (on_display, on_object, true),
        (None, None, true),
        (None, None, false),
    ] {
        bench.heat.touch(display, on, there);
        for _ in 0..1000 {
            let before: [f64; 3] = std::array::from_fn(|lane| {
                let slab = if lane == 2 {
                    &bench.object
                } else {
                    &bench.finger
                };
                stored_j_m2(&bench, lane, slab)
            });
            bench.step(None);
            let mean = |lane: usize| bench.heat.slabs.mean_c(lane, 0);
            let film = |lane: usize| {
                (mean(lane) - ROOM_C) / (bench.heat.surface_m2k_w[lane] + 1.0 / film_w_m2k)
            };
            let given = bench.heat.on_object_w_m2k * (mean(1) - mean(2));
            let to_plate = bench.heat.on_display_w_m2k * (mean(0) - bench.heat.tile.mean_patch_c());
            let lost_w_m2 = match (on.is_some(), there) {
                (true, _) => [to_plate, given, -given],
                (false, true) => [0, 1, 2].map(film),
                (false, false) => [film(0), film(1), 0.0],
            };
            for lane in 0..3 {
                let slab = if lane == 2 {
                    &bench.object
                } else {
                    &bench.finger
                };
                let lost = before[lane] - stored_j_m2(&bench, lane, slab);
                let off = lost - STEP_S * lost_w_m2[lane];
                assert!(
                    off.abs() < 1e-8,
                    "lane {lane}, touching {}, there {there}: {off} J/m2",
                    on.is_some()
                );
            }
        }
    }
}

/// The display's plate loses to the air what a finger leaves free of it: 50 W/(m2 K), 10 K above the room.
#[test]
fn a_finger_covers_the_plate_from_the_air() {
    let warm = TileParams {
        coolant_k: 10.0,
        film_w_m2k: 50.0,
        // So that sink and coolant exchange nothing to speak of.
        sink_k_w: 1e9,
        ..TileParams::CLASS
    };
    for covered_m2 in [0.0, 137e-6, 182.1e-6] {
        let mut tile = Tile::new(warm, ROOM_C);
        tile.cover(covered_m2);
        tile.prepare(1e-6);
        tile.first(1e-6, 0.0, 0.0, 0.0);
        tile.second(0.0);
        let lost_w = tile.crossed(1e-6).to_room_j / 1e-6;
        let wanted_w = 50.0 * 10.0 * (warm.plate_m2() - covered_m2);
        assert!(
            (lost_w / wanted_w - 1.0).abs() < 1e-4,
            "{lost_w} W is not {wanted_w} W"
        );
    }
}
