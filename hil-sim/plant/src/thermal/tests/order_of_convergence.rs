//! Order of convergence of all coupled bodies in time.

use contact_model::material::find;
use documented_figures::assert_figure;

use super::*;

/// Longest step, s; shorter ones halve it.
const COARSE_S: f64 = 16e-3;

#[test]
fn bodies_in_contact_converge_at_second_order_in_time() {
    let material = find("copper").expect("known");
    let cut = |layers: &[_], back| Slab::new(layers, back, 100.0, &Grading::STANDARD);
    let finger = FingerParams::layered();
    let slab = cut(&finger.layers, finger.back());
    let object = cut(
        &ObjectConfig::half_space(*material, ROOM_C).layers,
        crate::slab::BackBoundary::Insulated,
    );
    let mut heat = ThermalModel::new(
        (&slab, SKIN_C),
        (&object, ROOM_C),
        Tile::new(TileParams::NOMINAL, ROOM_C),
        (finger.air_w_m2k, ROOM_C),
        COARSE_S,
    );
    let (on_display, on_object) = touch(material, 1.0);
    heat.set_contacts(on_display, on_object, true);
    let mut bridge = Bridge::new(BridgeParams::NOMINAL, TileParams::NOMINAL.resistance_ohm());
    let legs = BridgeOutputs { a: Leg::Duty(1.0), b: Leg::Duty(0.8), enabled: true };
    // Away from the start of the contact, when temperatures change with the square root of time.
    for _ in 0..16_000 {
        heat.step(8, &mut bridge, &legs);
    }
    let steps = 32;
    let run = |halvings: usize| {
        let (mut heat, mut bridge) = (heat.clone(), bridge.clone());
        for _ in 0..steps << halvings {
            heat.step(halvings, &mut bridge, &legs);
        }
        [
            heat.skin_c(Finger::OnDisplay),
            heat.skin_c(Finger::OnObject),
            heat.display_c(),
            heat.object_c(),
            heat.tile.sink_c(),
            heat.tile.current().mean_a,
        ]
    };
    let mut least = f64::INFINITY;
    let finest: Vec<[f64; 6]> = (0..5).map(run).collect();
    for (i, what) in
        ["skin on display", "skin on object", "display", "object", "sink"].iter().enumerate()
    {
        // Differences of successive solutions fall by four.
        let difference: Vec<f64> = finest.windows(2).map(|w| w[0][i] - w[1][i]).collect();
        let orders: Vec<f64> = difference.windows(2).map(|d| (d[0] / d[1]).abs().log2()).collect();
        println!("{what}: differences {difference:?}, orders {orders:.3?}");
        let last = orders.last().expect("three");
        assert!(*last < 2.1, "{what}: order {last}");
        least = least.min(*last);
    }
    assert_figure("plant.order_together", least);
}
