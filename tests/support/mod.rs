#![doc = include_str!("../README.md")]

pub mod flash;

use std::path::Path;

use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::metrics::skin_errors;
use thermal_sim::run::{Outcome, run};
use thermal_sim::scene::Scene;
use thermal_sim::trace::TraceRow;

/// A scene with a finger of 34 °C on `material`, room and object at 24 °C; `keys` and `tables` are appended to the scene's text.
///
/// # Panics
/// The scene is wrong.
pub fn scene(material: &str, duration_s: f64, keys: &str, tables: &str) -> Scene {
    let text = format!(
        "duration_s = {duration_s}\nskin_c = 34\nroom_c = 24\nseed = 1\n{keys}\n\
         [object]\nmaterial = \"{material}\"\nstart_c = 24\n{tables}\n"
    );
    Scene::parse(&text, Path::new("test scene")).expect("a good scene")
}

/// A scene's `[[force]]` tables of pairs of time, s, and force, N.
pub fn forces(pairs: &[(f64, f64)]) -> String {
    let table =
        |(t_s, force_n): &(f64, f64)| format!("[[force]]\nt_s = {t_s}\nforce_n = {force_n}\n");
    pairs.iter().map(table).collect()
}

/// A scene's `[[host]]` tables of pairs of time, s, and line.
pub fn host(lines: &[(f64, &str)]) -> String {
    lines.iter().map(|(t_s, line)| format!("[[host]]\nt_s = {t_s}\nline = {line:?}\n")).collect()
}

/// 2 s with copper under 2 N from 0.5 s on.
///
/// # Panics
/// The scene is wrong.
pub fn copper_contact() -> Scene {
    scene("copper", 2.0, "", &forces(&[(0.5, 2.0)]))
}

/// Runs a scene on the native engine.
///
/// # Panics
/// The plant refuses the scene.
pub fn natively(scene: &Scene) -> Outcome {
    let mut engine = NativeEngine::new(World::new(scene).expect("a plant for the scene"));
    run(scene, &mut engine, |_| ()).expect("the device takes the scene")
}

/// Rows of a trace from one time up to another, s.
pub fn between(outcome: &Outcome, from_s: f64, to_s: f64) -> impl Iterator<Item = &TraceRow> {
    outcome.trace.rows().iter().filter(move |row| row.t_s >= from_s && row.t_s < to_s)
}

/// Largest skin error from a time after each landing or appearance on, K.
///
/// # Panics
/// There is no contact that long.
pub fn worst_k(scene: &Scene, outcome: &Outcome, from_s: f64) -> f64 {
    // Half a row of tolerance for rounding of times.
    let late = skin_errors(scene, outcome).filter(|(since_s, _)| *since_s > from_s - 0.5e-3);
    let errors_k = late.map(|(_, error_k)| error_k.abs());
    errors_k.reduce(f64::max).expect("contact")
}

/// Mean of a value over rows.
pub fn mean<'a>(rows: impl Iterator<Item = &'a TraceRow>, value: impl Fn(&TraceRow) -> f64) -> f64 {
    let (mut count, mut sum) = (0u32, 0.0);
    for row in rows {
        count += 1;
        sum += value(row);
    }
    sum / f64::from(count)
}
