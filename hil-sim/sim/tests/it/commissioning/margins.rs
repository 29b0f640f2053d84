//! The margins that a device reports, against what its loop does when its gain is raised.

use thermal_client::client::{IdentifiedTile, QueryMargins};
use thermal_client::commissioning::arm;
use thermal_sim::commissioning::settings_for_device;
use thermal_sim::engine::NativeEngine;

use super::{ROOM_C, bench, device, wait};

/// Of its gain margin: so much more gain must oscillate, so much of it must not.
const BEYOND: f64 = 1.3;
const WITHIN: f64 = 0.7;
/// A display that is held moves less than that, K, peak to peak; one that oscillates at the converter's noise and beyond
/// grows until the bridge's limit, to many times that.
const STILL_K: f64 = 0.03;
const OSCILLATES_K: f64 = 0.1;

/// How far the plate moves in the last second after a little more of what it is held at, K, peak to peak.
fn moves(
    plants: &thermal_sim::commissioning::CommissioningSetup,
    settings: &[String],
    times: f64,
) -> f64 {
    let mut engine = NativeEngine::new(plants.in_use().expect("a plant"));
    let mut bench = bench(&mut engine, settings);
    wait(&mut bench, 10);
    let words: Vec<&str> = settings.last().expect("a tile").split(' ').collect();
    let [set, tile, gain, rest @ ..] = &words[..] else { panic!("{words:?}") };
    let gain: f64 = gain.parse().expect("a gain");
    // The law's gain is the reciprocal of the tile's.
    let line = format!("{set} {tile} {:.6} {}", gain / times, rest.join(" "));
    bench.command("law pi").expect("obeyed");
    arm(&mut bench, None).expect("armed");
    bench.command("hold 26").expect("obeyed");
    wait(&mut bench, 14_000);
    bench.command(&line).expect("obeyed");
    wait(&mut bench, 3000);
    // So wild an oscillation that both thermistors part is one.
    let answer = bench.query("hold 26.2").expect("an answer");
    if answer.starts_with("err tripped by displays-apart") {
        return f64::INFINITY;
    }
    assert_eq!(answer, "ok");
    wait(&mut bench, 6000);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..1000 {
        wait(&mut bench, 1);
        let display_c = bench.link().world().plant().display_c();
        (low, high) = (low.min(display_c), high.max(display_c));
    }
    high - low
}

/// Of devices with quick sensors: behind a slow one the margin is so large that no line of settings reaches it.
#[test]
fn the_loop_oscillates_beyond_its_gain_margin_and_not_within() {
    for draw in [0, 11, 12, 16] {
        let plants = device((draw > 0).then_some(draw), draw);
        let settings = settings_for_device(plants.params(), ROOM_C, draw).expect("settings");
        let mut engine = NativeEngine::new(plants.in_use().expect("a plant"));
        let IdentifiedTile { gain_margin, .. } =
            bench(&mut engine, &settings).ask(&QueryMargins).expect("margins");
        let within = moves(&plants, &settings, WITHIN * gain_margin);
        let beyond = moves(&plants, &settings, BEYOND * gain_margin);
        println!(
            "draw {draw}: margin {gain_margin:.2}; moves {within:.4} within, {beyond:.4} K beyond"
        );
        assert!(within < STILL_K, "draw {draw}: {within}");
        assert!(beyond > OSCILLATES_K, "draw {draw}: {beyond}");
    }
}
