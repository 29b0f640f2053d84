//! Scenes with other fingers, objects, plants and the camera, on the native engine.

mod display_error;
mod examples;
mod fault_kinds;
mod flux;
mod fooled;
mod keys;
mod objects_page;
mod refused;

use std::path::{Path, PathBuf};

use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::run::run;
use thermal_sim::scene::Scene;
use thermal_sim::trace::TraceRow;

/// A scene's text as it is given.
fn scene(text: &str) -> Scene {
    Scene::parse(text, Path::new("test scene")).unwrap_or_else(|error| panic!("{error}"))
}

fn example_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}.toml"))
}

/// Text of an example, each pair's first text replaced by its second; it must be there.
fn example(name: &str, changes: &[(&str, &str)]) -> String {
    let mut text = std::fs::read_to_string(example_path(name)).expect("an example");
    for (from, to) in changes {
        assert!(text.contains(from), "{name} has no {from:?}");
        text = text.replacen(from, to, 1);
    }
    text
}

fn rows(text: &str) -> Vec<TraceRow> {
    let scene = scene(text);
    let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
    let outcome = run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
    outcome.trace.rows().to_vec()
}

/// The row at a time, s.
fn at(rows: &[TraceRow], t_s: f64) -> &TraceRow {
    let row = &rows[(t_s * 1e3).round() as usize];
    assert!((row.t_s - t_s).abs() < 1e-9, "{} instead of {t_s}", row.t_s);
    row
}
