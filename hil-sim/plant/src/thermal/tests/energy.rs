//! Energy balance of tile and finger.

use contact_model::material::find;
use documented_figures::assert_figure;

use super::*;

/// Steps of ten minutes.
const STEPS: usize = 600_000;

/// Heat stored in a slab of the batch relative to the start, J/m2.
fn stored_j_m2(bench: &Bench, index: usize, slab: &Slab, start_c: &[f64]) -> f64 {
    let heat = slab.capacity_j_m2k.iter().zip(start_c).enumerate();
    heat.map(|(node, (capacity, start_c))| {
        capacity * (bench.heat.slabs.node_c(index, node) - start_c)
    })
    .sum()
}

fn nodes_c(bench: &Bench, index: usize, slab: &Slab) -> Vec<f64> {
    (0..slab.cells()).map(|node| bench.heat.slabs.node_c(index, node)).collect()
}

/// Ten minutes of contacts of changing force under a changing current: the heat stored in the tile, and that given by the
/// finger, equal the energies that crossed the boundaries.
#[test]
fn energy_closes_over_ten_minutes_of_contacts() {
    let material = find("granite").expect("known");
    let mut bench = Bench::plain(material);
    let start_c = nodes_c(&bench, 0, &bench.finger);
    let mut given_j = 0.0;
    let mut before_j_m2 = 0.0;
    for k in 0..STEPS {
        let t_s = k as f64 * STEP_S;
        if k % 7000 == 0 {
            let force_n = [0.1, 2.0, 0.0, 0.7, 1.3][k / 7000 % 5];
            let (on_display, on_object) = touch(material, force_n);
            // The contact area changes: heat given until now counts with the previous area.
            let stored = stored_j_m2(&bench, 0, &bench.finger, &start_c);
            given_j += bench.heat.area_m2 * (before_j_m2 - stored);
            before_j_m2 = stored;
            bench.touch(on_display, on_object);
        }
        bench.step((k % 50_000 < 40_000).then(|| 4.0 * (0.7 * t_s).sin() + 0.5));
    }
    let stored = stored_j_m2(&bench, 0, &bench.finger, &start_c);
    given_j += bench.heat.area_m2 * (before_j_m2 - stored);
    let Energy { electrical_j, from_finger_j, to_room_j } = bench.heat.energy();
    let tile_j: f64 = bench.heat.tile.nodes().map(|(capacity, t)| capacity * (t - ROOM_C)).sum();
    let scale_j = electrical_j + from_finger_j.abs() + to_room_j.abs();
    assert!(electrical_j > 500.0 && from_finger_j.abs() > 10.0);
    let tile_open = (tile_j - (electrical_j + from_finger_j - to_room_j)) / scale_j;
    let finger_open = (given_j - from_finger_j) / scale_j;
    assert_figure("plant.energy_open", tile_open.abs().max(finger_open.abs()));
}
