//! Reports of a run for people: a table, plots and a page.

mod plots;
mod table;

use std::fmt::Write;
use std::path::Path;

use thermal_charts::{document, escape, svg_element};

use crate::metrics::Figures;
use crate::run::{Exchange, Outcome};
use crate::scene::Scene;

pub use table::table;

/// File name of the page.
pub const HTML: &str = "report.html";
/// File name of the separate plots.
pub const SVG: &str = "plots.svg";

/// Writes the page, which is self-contained, and the plots as a separate file.
///
/// # Errors
/// A file cannot be written.
pub fn write(
    folder: &Path,
    scene: &Scene,
    outcome: &Outcome,
    figures: &Figures,
) -> anyhow::Result<()> {
    let plots = plots::draw(scene, outcome)?;
    thermal_charts::write(folder, HTML, page(scene, outcome, figures, &plots))?;
    thermal_charts::write(folder, SVG, plots)
}

/// The result in words.
fn result(figures: &Figures) -> String {
    let trips = figures.trips_and_resets();
    let ended = match trips.as_slice() {
        [] => String::new(),
        trips => format!(" The device did not run through: {}.", trips.join(", ")),
    };
    let Some(errors) = figures.skin_error_mk else {
        return format!("No finger has touched the object.{ended}");
    };
    let most = errors.max_after_50ms.map_or("no contact of 50 ms".into(), |most| {
        format!("at most {most:.1} mK from 50 ms after each landing on")
    });
    format!(
        "The skin on the display differs from the skin on the real object ({}) by {:.1} mK (RMS over the contact; {most}). It was at \
         {:.1} to {:.1} °C.{ended}",
        figures.material, errors.rms, figures.skin_c.min, figures.skin_c.max
    )
}

fn page(scene: &Scene, outcome: &Outcome, figures: &Figures, plots: &str) -> String {
    let title = format!("{}, engine {}", figures.material, figures.engine);
    let mut rows = String::new();
    for (name, value) in table::rows(figures) {
        // Writing to a String cannot fail.
        let _ = write!(rows, "<tr><th>{name}</th><td>{}</td></tr>", escape(&value));
    }
    let mut answers = String::new();
    for Exchange { t_s, line, answer } in outcome.exchanges() {
        let _ = write!(
            answers,
            "<tr><td>{t_s:.3}</td><td><code>{}</code></td><td><code>{}</code></td></tr>",
            escape(line.unwrap_or("-")),
            escape(answer)
        );
    }
    let body = format!(
        "<p><strong>{}</strong></p><p>Skin {} °C, room {} °C, object {} °C. Everything here is simulated; costs are emulated, cycles \
         estimated.</p>{}<h2>Figures</h2><table>{rows}</table><h2>Answers of the device</h2>\
         <table><tr><th>t / s</th><th>line</th><th>answer</th></tr>{answers}</table>",
        escape(&result(figures)),
        scene.skin_c,
        scene.room_c,
        scene.object_c(),
        svg_element(plots),
    );
    document(&title, "", &body)
}
