//! The sink: 200 J/K, and some 6 J/K of the tile on it, at 0.15 K/W.

use thermal_sim::scene::FaultKind;

use super::*;

/// A world whose sink and tile have been at 60 deg C for long. The comparator has noticed.
fn hot() -> World {
    let mut world = ideal();
    run(&mut world, 90_000, OFF, &[broken(FaultKind::SinkHot, 60.0)]);
    assert!((world.plant().sink_c() - 60.0).abs() < 0.01);
    world
}

/// What of 36 K over the room is gone after 10 s.
fn lost(all: &[ActiveFault]) -> f64 {
    let mut world = hot();
    run(&mut world, 10_000, OFF, all);
    (60.0 - world.plant().sink_c()) / 36.0
}

#[test]
fn sink_cools_as_capacity_and_fan_have_it() {
    for (all, factor) in [
        (vec![], 1.0),
        (vec![FaultKind::FanOff.into()], 10.0),
        (vec![broken(FaultKind::FanOff, 4.0)], 4.0),
    ] {
        let tau_s = 206.0 * 0.15 * factor;
        let expected = 1.0 - f64::exp(-10.0 / tau_s);
        let lost = lost(&all);
        // The tile follows late.
        assert!((lost / expected - 1.0).abs() < 0.05, "{factor}: {lost} for {expected}");
    }
}

#[test]
fn sink_goes_where_its_coolant_is() {
    let mut world = ideal();
    run(&mut world, 300_000, OFF, &[broken(FaultKind::ChillerOff, 40.0)]);
    // The plate gives some 0.15 W to the room.
    let sink_c = world.plant().sink_c();
    assert!((sink_c - 40.0).abs() < 0.05, "{sink_c}");
    run(&mut world, 300_000, OFF, &[]);
    let sink_c = world.plant().sink_c();
    assert!((sink_c - 24.0).abs() < 0.05, "{sink_c}");
}

/// Some 6 J/K behind 0.285 W/K: a plate of 25 deg C on a sink of 55 deg C is at 45 deg C after some 11 s.
#[test]
fn hot_sink_heats_an_unpowered_plate() {
    let scene = scene(&format!("{IDEAL}comparator.hot_c = 100\n"));
    let mut world = World::new(&scene).expect("a plant");
    let mut ms = 0;
    while world.plant().display_c() < 45.0 && ms < 60_000 {
        run(&mut world, 1, OFF, &[broken(FaultKind::SinkHot, 55.0)]);
        ms += 1;
    }
    assert!((9_000..14_000).contains(&ms), "{ms} ms");
}
