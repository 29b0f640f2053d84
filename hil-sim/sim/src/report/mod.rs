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
        "<p>Skin {} °C, room {} °C, object {} °C. Everything here is simulated; costs are emulated, cycles \
         estimated.</p>{}<h2>Figures</h2><table>{rows}</table><h2>Answers of the device</h2>\
         <table><tr><th>t / s</th><th>line</th><th>answer</th></tr>{answers}</table>",
        scene.skin_c,
        scene.room_c,
        scene.object_c(),
        svg_element(plots),
    );
    document(&title, "", &body)
}
