//! What a person reads of a run: a table, plots, a page.

pub(crate) mod panel;
mod plots;
mod table;

use std::fmt::Write;
use std::path::Path;

use anyhow::Context;

use crate::metrics::Figures;
use crate::run::Outcome;
use crate::scene::Scene;

pub use table::table;

/// Name of the page.
pub const HTML: &str = "report.html";
/// Name of the plots by themselves.
pub const SVG: &str = "plots.svg";

/// Writes the page, which needs no other file, and the plots by themselves.
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
    for (name, text) in [(HTML, page(scene, outcome, figures, &plots)), (SVG, plots)] {
        let path = folder.join(name);
        std::fs::write(&path, text).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#222}\
table{border-collapse:collapse}td,th{padding:.2rem .8rem;border-bottom:1px solid #ddd;text-align:left}\
svg{max-width:100%;height:auto}code{background:#f3f3f3}";

/// A page that needs no other file; `style` is added to the style of all pages, `body` is HTML.
pub(crate) fn document(title: &str, style: &str, body: &str) -> String {
    let title = escape(title);
    format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>{title}</title>\
         <style>{STYLE}{style}</style><h1>{title}</h1>{body}</html>\n"
    )
}

/// The `<svg>` element of an SVG document.
pub(crate) fn element(svg: &str) -> &str {
    svg.find("<svg").map_or("", |start| &svg[start..])
}

fn page(scene: &Scene, outcome: &Outcome, figures: &Figures, plots: &str) -> String {
    let title = format!("{}, engine {}", figures.material, figures.engine);
    let mut rows = String::new();
    for (name, value) in table::rows(figures) {
        // Writing to a String cannot fail.
        let _ = write!(rows, "<tr><th>{name}</th><td>{}</td></tr>", escape(&value));
    }
    let mut answers = String::new();
    for (t_s, line) in &outcome.answers {
        let _ = write!(
            answers,
            "<tr><td>{t_s:.3}</td><td><code>{}</code></td></tr>",
            escape(line)
        );
    }
    let body = format!(
        "<p>Skin {} °C, room {} °C, object {} °C. Everything here is simulated; costs are emulated, cycles \
         estimated.</p>{}<h2>Figures</h2><table>{rows}</table><h2>Answers of the device</h2>\
         <table><tr><th>t / s</th><th>line</th></tr>{answers}</table>",
        scene.skin_c,
        scene.room_c,
        scene.object_c(),
        element(plots),
    );
    document(&title, "", &body)
}

/// Text as HTML.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
