//! What the whole-system tests share: scenes, and runs of them on either engine; the flash of settings.

pub mod flash;

mod bare;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use hil_sim::World;
use hil_sim::engine::{Image, Native};
use hil_sim::machine::Firmware;
use hil_sim::metrics::skin_errors;
use hil_sim::run::{Outcome, run};
use hil_sim::scene::Scene;
use hil_sim::trace::Row;

pub use bare::{Bare, START};

/// The image of the current sources, built once.
///
/// # Panics
/// It cannot be built.
pub fn image() -> &'static Path {
    static IMAGE: OnceLock<PathBuf> = OnceLock::new();
    IMAGE.get_or_init(|| hil_sim::firmware::build(1).expect("the image builds"))
}

/// A finger of 34 °C on `material`, room and object at 24 °C; `rest` is what else the scene says, tables last.
///
/// # Panics
/// The scene is wrong.
#[must_use]
pub fn scene(material: &str, duration_s: f64, keys: &str, tables: &str) -> Scene {
    let text = format!(
        "duration_s = {duration_s}\nskin_c = 34\nroom_c = 24\nseed = 1\n{keys}\n\
         [object]\nmaterial = \"{material}\"\nstart_c = 24\n{tables}\n"
    );
    Scene::parse(&text, Path::new("test scene")).expect("a good scene")
}

/// Forces as a scene has them: pairs of time in s and force in N.
#[must_use]
pub fn forces(pairs: &[(f64, f64)]) -> String {
    let table =
        |(t_s, force_n): &(f64, f64)| format!("[[force]]\nt_s = {t_s}\nforce_n = {force_n}\n");
    pairs.iter().map(table).collect()
}

/// Lines of the host as a scene has them.
#[must_use]
pub fn host(lines: &[(f64, &str)]) -> String {
    lines
        .iter()
        .map(|(t_s, line)| format!("[[host]]\nt_s = {t_s}\nline = {line:?}\n"))
        .collect()
}

/// Runs a scene on an image.
///
/// # Errors
/// The image is no image, or its run stops.
pub fn on(image: &Firmware, scene: &Scene) -> anyhow::Result<Outcome> {
    let mut engine = Image::new(image, World::new(scene)?)?;
    Ok(run(scene, &mut engine, |_| ())?)
}

/// Runs a scene on the release image.
///
/// # Panics
/// It does not run to its end.
#[must_use]
pub fn on_image(scene: &Scene) -> Outcome {
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    on(&firmware, scene).expect("the image runs to the end")
}

/// Runs a scene natively.
///
/// # Panics
/// The plant refuses the scene.
#[must_use]
pub fn natively(scene: &Scene) -> Outcome {
    let mut engine = Native::new(World::new(scene).expect("a plant for the scene"));
    run(scene, &mut engine, |_| ()).expect("the device takes the scene")
}

/// Rows from one time to another, s.
pub fn between(outcome: &Outcome, from_s: f64, to_s: f64) -> impl Iterator<Item = &Row> {
    outcome
        .trace
        .rows()
        .iter()
        .filter(move |row| row.t_s >= from_s && row.t_s < to_s)
}

/// Largest error of the skin from a time after each landing or appearance on, K.
///
/// # Panics
/// No contact lasts that long.
#[must_use]
pub fn worst_k(scene: &Scene, outcome: &Outcome, from_s: f64) -> f64 {
    // Half a row of slack: times are differences of sums.
    let late = skin_errors(scene, outcome).filter(|(since_s, _)| *since_s > from_s - 0.5e-3);
    let errors_k = late.map(|(_, error_k)| error_k.abs());
    errors_k.reduce(f64::max).expect("contact")
}

/// Mean of a value over rows.
pub fn mean<'a>(rows: impl Iterator<Item = &'a Row>, value: impl Fn(&Row) -> f64) -> f64 {
    let (mut count, mut sum) = (0u32, 0.0);
    for row in rows {
        count += 1;
        sum += value(row);
    }
    sum / f64::from(count)
}
