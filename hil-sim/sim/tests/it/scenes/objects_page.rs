//! The example and the figures of `docs/objects.md`.

use documented_figures::assert_figure;
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::metrics::figures;
use thermal_sim::run::run;

use super::{at, example, rows, scene};

/// Largest skin error from 50 ms after the landing on, mK. No line is refused, and nothing trips.
fn skin_max_mk(text: &str) -> f64 {
    let scene = scene(text);
    let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
    let outcome = run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
    let figures = figures(&scene, &outcome);
    assert_eq!(figures.refused_lines, []);
    assert_eq!(figures.faults, []);
    figures.skin_max_mk().expect("a contact of more than 50 ms")
}

#[test]
fn the_page_shows_the_example() {
    let page = include_str!("../../../../../docs/objects.md");
    let (_, block) = page.split_once("```toml\n").expect("a scene");
    let (shown, _) = block.split_once("```").expect("its end");
    assert_eq!(scene(shown), scene(&example("copper-on-foam", &[])));
}

#[test]
fn skin_errors_are_those_of_the_page() {
    let sheet = |thickness: &str| {
        let thickness = format!("thickness_m = {thickness}");
        example("copper-on-foam", &[("thickness_m = 0.003", &thickness)])
    };
    let half_space = ("[object]\n", "[object]\ntold = \"half-space\"\n");
    for (name, text) in [
        ("on_foam", example("copper-on-foam", &[])),
        ("as_half_space", example("copper-on-foam", &[half_space])),
        ("as_slab", example("copper-slab", &[])),
        ("as_slab_film", example("copper-slab", &[("insulated", "film 10")])),
        ("sheet_300_um", sheet("0.0003")),
        ("sheet_30_um", sheet("0.00003")),
    ] {
        assert_figure(&format!("objects.{name}"), skin_max_mk(&text));
    }
}

#[test]
fn the_finger_warms_the_sheet_and_not_a_block_as_the_page_says() {
    let sheet = rows(&example("copper-on-foam", &[]));
    let block = rows(&example("copper", &[]));
    let [sheet, block] = [&sheet, &block].map(|rows| at(rows, 11.0));
    assert_figure("objects.sheet_warmed", sheet.object_real_c - 24.0);
    assert_figure("objects.block_warmed", block.object_real_c - 24.0);
    assert_figure("objects.sheet_skin", sheet.skin_real_c - block.skin_real_c);
}
