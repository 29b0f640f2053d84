//! A finger that has not touched anything is left out of the steps.

use contact_model::material::find;

use super::*;

/// The layered finger of a warm hand loses heat to the air that its blood supplies. Left out of the steps for 10 s beside a
/// tile that is cooled, and through the landing after it, it has the temperatures of one whose nodes were advanced throughout.
#[test]
fn a_finger_at_rest_is_as_one_that_is_computed() {
    let granite = find("granite").expect("known");
    let object = ObjectConfig::half_space(*granite, ROOM_C);
    let new = || {
        let mut bench = Bench::new(&FingerParams::layered(), &object, TileParams::NOMINAL);
        bench.heat.set_contacts(None, None, false);
        bench
    };
    let (mut rested, mut computed) = (new(), new());
    computed.heat.at_rest = false;
    let all_c = |bench: &Bench| {
        let node_c = |slab| {
            let slabs = &bench.heat.slabs;
            (0..slabs.cells()).map(move |node| slabs.node_c(slab, node))
        };
        let surfaces = [bench.heat.display_c(), bench.heat.object_c(), bench.heat.tile().sink_c()];
        (0..SLABS).flat_map(node_c).chain(surfaces).collect::<Vec<_>>()
    };
    let (on_display, on_object) = touch(granite, 1.0);
    for ms in 0..11_000 {
        if ms == 10_000 {
            assert!(rested.heat.at_rest && rested.heat.display_c() < ROOM_C - 5.0);
            rested.touch(on_display, on_object);
            computed.touch(on_display, on_object);
        }
        rested.step(Some(1.0));
        computed.step(Some(1.0));
        let worst_k = std::iter::zip(all_c(&rested), all_c(&computed))
            .fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
        assert!(worst_k < 1e-9, "{worst_k} K after {ms} ms");
    }
    assert!(!rested.heat.at_rest);
}
