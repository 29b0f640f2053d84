//! The HTML page.

use std::fmt::Write;

use thermal_charts::{document, escape, svg_element};

use super::{BoxReport, FidelityRow, PopulationReport, box_table, population_table, table};

/// File name of the page.
pub const HTML: &str = "fidelity.html";
/// File name of the separate chart.
pub const SVG: &str = "fidelity.svg";

/// A self-contained page.
pub fn page(
    rows: &[FidelityRow],
    boxed: Option<&BoxReport>,
    populations: &[PopulationReport],
    charts: &[&str],
) -> String {
    let mut body =
        "<p>Everything here is simulated; instructions are emulated, cycles estimated.</p>"
            .to_owned();
    for svg in charts {
        body += svg_element(svg);
    }
    for text in [
        (!rows.is_empty()).then(|| table(rows, true)),
        boxed.map(box_table),
        (!populations.is_empty()).then(|| population_table(populations)),
    ]
    .into_iter()
    .flatten()
    {
        // Writing to a String cannot fail.
        let _ = write!(body, "<pre>{}</pre>", escape(&text));
    }
    let style = "pre{font-size:12px;line-height:1.35;overflow-x:auto}body{max-width:80rem}";
    document("Skin on the display against skin on the material", style, &body)
}
