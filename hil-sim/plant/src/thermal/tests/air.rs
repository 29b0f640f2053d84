//! Heat exchange of surfaces with the air.

use contact_model::material::find;

use super::*;
use crate::tile::TileParams;

/// Heat stored in a slab of the batch, J/m2.
fn stored_j_m2(bench: &Bench, index: usize, slab: &Slab) -> f64 {
    let heat = slab.capacity_j_m2k.iter().enumerate();
    heat.map(|(node, capacity)| capacity * bench.heat.slabs.node_c(index, node)).sum()
}

/// Without blood and core, finger and object exchange heat only with each other and, without contact, with the air.
#[test]
fn only_surfaces_without_contact_lose_heat_to_the_air() {
    let granite = find("granite").expect("known");
    let object = ObjectConfig {
        layers: vec![ObjectConfig::layer(granite, 5e-3)],
        ..ObjectConfig::half_space(*granite, 40.0)
    };
    let mut bench = Bench::new(&FingerParams::homogeneous(), &object, TileParams::NOMINAL);
    let film_w_m2k = 15.0;
    bench.heat.lifted_w_m2k =
        bench.heat.surface_m2k_w.map(|m2k_w| 1.0 / (m2k_w + 1.0 / film_w_m2k));
    let (on_display, on_object) = touch(granite, 1.0);
    for (display, on, there) in
        [(on_display, on_object, true), (None, None, true), (None, None, false)]
    {
        bench.heat.set_contacts(display, on, there);
        for _ in 0..1000 {
            let before: [f64; 3] = std::array::from_fn(|index| {
                let slab = if index == 2 { &bench.object } else { &bench.finger };
                stored_j_m2(&bench, index, slab)
            });
            bench.step(None);
            let mean = |index: usize| bench.heat.slabs.mean_c(index, 0);
            let film = |index: usize| {
                (mean(index) - ROOM_C) / (bench.heat.surface_m2k_w[index] + 1.0 / film_w_m2k)
            };
            let given = bench.heat.on_object_w_m2k * (mean(1) - mean(2));
            let to_plate = bench.heat.on_display_w_m2k * (mean(0) - bench.heat.tile.mean_patch_c());
            let lost_w_m2 = match (on.is_some(), there) {
                (true, _) => [to_plate, given, -given],
                (false, true) => [0, 1, 2].map(film),
                (false, false) => [film(0), film(1), 0.0],
            };
            for index in 0..3 {
                let slab = if index == 2 { &bench.object } else { &bench.finger };
                let lost = before[index] - stored_j_m2(&bench, index, slab);
                let off = lost - STEP_S * lost_w_m2[index];
                assert!(
                    off.abs() < 1e-8,
                    "index {index}, contact {}, there {there}: {off} J/m2",
                    on.is_some()
                );
            }
        }
    }
}

/// The uncovered part of the display plate loses heat to the air, at 50 W/(m2 K) and 10 K above the room.
#[test]
fn finger_reduces_the_loss_of_the_plate_to_the_air() {
    let warm = TileParams {
        coolant_k: 10.0,
        film_w_m2k: 50.0,
        // Heat exchange of sink and coolant is negligible.
        sink_k_w: 1e9,
        ..TileParams::NOMINAL
    };
    for covered_m2 in [0.0, 137e-6, 182.1e-6] {
        let mut tile = Tile::new(warm, ROOM_C);
        tile.cover(covered_m2);
        tile.prepare(1e-6);
        tile.first_stage(1e-6, 0.0, 0.0, 0.0);
        tile.second_stage(0.0);
        let lost_w = tile.step_energy(1e-6).to_room_j / 1e-6;
        let expected_w = 50.0 * 10.0 * (warm.plate_m2() - covered_m2);
        assert!((lost_w / expected_w - 1.0).abs() < 1e-4, "{lost_w} W is not {expected_w} W");
    }
}
