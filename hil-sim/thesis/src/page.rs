//! The report: an HTML page with tables and figures, and the rows as CSV.

use std::fmt::Write;
use std::path::Path;

use plotters::prelude::*;
use thermal_charts::{Curve, Legend, Panel, Stroke, document, escape, svg_element};

use super::figure::{Figure, FigureDifference, Kind};
use super::measured::{Measurement, VARIANTS};
use super::row::Row;
use super::{Chapter, Counts};

/// File name of the page.
pub const HTML: &str = "thesis.html";
/// File name of the rows as CSV.
pub const CSV: &str = "thesis.csv";

const SIZE: (u32, u32) = (1100, 460);
/// Width of the legend, pixels.
const LEGEND: u32 = 250;
const COLORS: [RGBColor; 7] = [
    RGBColor(0xd6, 0x27, 0x28),
    RGBColor(0x1f, 0x77, 0xb4),
    RGBColor(0x2c, 0xa0, 0x2c),
    RGBColor(0x94, 0x67, 0xbd),
    RGBColor(0xe3, 0x77, 0x00),
    RGBColor(0x17, 0x9e, 0xae),
    RGBColor(0x22, 0x22, 0x22),
];
const STYLE: &str = "body{max-width:76rem}table{font-size:.85rem;width:100%}td.n{text-align:right}td.n,td.w{white-space:nowrap}\
td.v{white-space:nowrap;font-weight:600}.agrees{color:#1a7f37}.cut{color:#7a5c00}.differs{color:#b35900}\
.damaged{color:#6639ba}.wrong{color:#cf222e}.shows{color:#1a7f37}.shows-with-gap{color:#7a5c00}.cannot{color:#cf222e}figure{margin:2rem 0}figcaption{font-weight:600}";

/// Writes [`HTML`] and [`CSV`] into `folder`, which exists.
///
/// # Errors
/// A file cannot be written, or a figure not be drawn.
pub fn write(
    folder: &Path,
    chapters: &[Chapter],
    figures: &[Figure],
    differences: &[FigureDifference],
    measured: &[Measurement],
) -> anyhow::Result<()> {
    let page = page(chapters, figures, differences, measured)?;
    thermal_charts::write(folder, HTML, page)?;
    thermal_charts::write(folder, CSV, csv(chapters)?)
}

fn page(
    chapters: &[Chapter],
    figures: &[Figure],
    differences: &[FigureDifference],
    measured: &[Measurement],
) -> anyhow::Result<String> {
    let mut body = format!(
        "<p>Every number of H.-N. Ho's thesis (MIT, 2006) that a program can recompute, beside what the contact model \
         and the infrared instrument give. A tolerance (±), a range or a limit is how words of the text are read. {}.</p>",
        Counts::of(chapters).text()
    );
    for (i, chapter) in chapters.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = write!(
            body,
            "<h2>Chapter {}: {}</h2><table><tr><th>place</th><th>quantity</th><th>stated</th><th>computed</th>\
             <th>unit</th><th>verdict</th><th>remark</th></tr>",
            chapter.number,
            escape(chapter.title)
        );
        for row in &chapter.rows {
            body.push_str(&line(row));
        }
        body.push_str("</table>");
        let prefix = format!("{}-", chapter.number);
        let first = chapters.iter().position(|one| one.number == chapter.number);
        for figure in
            figures.iter().filter(|figure| first == Some(i) && figure.number.starts_with(&prefix))
        {
            let svg = draw(figure)?;
            let compared = differences.iter().find(|difference| difference.number == figure.number);
            let compared = compared.map_or(String::new(), |difference| {
                format!("<p>By the plant's finite volumes: {}.</p>", escape(&difference.text()))
            });
            let _ = write!(
                body,
                "<figure><figcaption>Figure {}. {}</figcaption>{}{compared}</figure>",
                figure.number,
                escape(&figure.title),
                svg_element(&svg)
            );
        }
    }
    body.push_str(&measured_table(measured));
    Ok(document("The thesis recomputed", STYLE, &body))
}

/// The measurements beside what each plant gives.
fn measured_table(measured: &[Measurement]) -> String {
    let mut table = String::from(
        "<h2>Measurements beside the plant</h2><table><tr><th>place</th><th>quantity</th><th>measured</th>",
    );
    for variant in VARIANTS {
        // Writing to a String cannot fail.
        let _ = write!(table, "<th>finger {}, {}</th>", variant.finger(), variant.contact());
    }
    table.push_str("<th>unit</th><th>verdict</th><th>why</th></tr>");
    for row in measured {
        let plants = row.plant_texts().map(|text| format!("<td class=\"n\">{text}</td>"));
        let _ = write!(
            table,
            "<tr><td class=\"w\">{}</td><td>{}</td><td class=\"n\">{}</td>{}<td class=\"w\">{}</td>\
             <td class=\"w {}\">{}</td><td>{}</td></tr>",
            row.place,
            escape(&row.quantity),
            escape(&row.measured.to_string()),
            plants.concat(),
            row.unit,
            row.shown().word(),
            row.shown().text(),
            escape(row.why()),
        );
    }
    table.push_str("</table>");
    table
}

fn line(row: &Row) -> String {
    format!(
        "<tr><td class=\"w\">{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"w\">{}</td>\
         <td class=\"v {}\">{}</td><td>{}</td></tr>",
        row.place,
        escape(&row.quantity),
        escape(&row.stated.to_string()),
        row.computed_text(),
        row.unit,
        row.verdict().word(),
        row.verdict(),
        escape(&row.remark_text()),
    )
}

fn draw(figure: &Figure) -> anyhow::Result<String> {
    let curves: Vec<Curve> = figure
        .curves
        .iter()
        .map(|curve| Curve {
            name: curve.label.clone(),
            color: COLORS[curve.group % COLORS.len()],
            stroke: match curve.kind {
                Kind::Line => Stroke::Solid(2),
                Kind::Dashed => Stroke::Dashed,
                Kind::Dots => Stroke::Dots,
            },
            points: curve.points.clone(),
        })
        .collect();
    let last = curves.iter().flat_map(|curve| &curve.points);
    let last = last.fold(0.0, |last: f64, (x, _)| last.max(*x));
    let panel =
        Panel { x: 0.0..last, x_name: figure.x, y_name: figure.y, legend: Legend::Beside(LEGEND) };
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        panel.draw(&root, &curves)?;
        root.present()?;
    }
    Ok(svg)
}

fn csv(chapters: &[Chapter]) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "chapter", "place", "quantity", "unit", "stated", "computed", "verdict", "remark",
    ])?;
    for chapter in chapters {
        for row in &chapter.rows {
            writer.write_record([
                &chapter.number.to_string(),
                row.place,
                &row.quantity,
                row.unit,
                &row.stated.to_string(),
                &row.computed.to_string(),
                &row.verdict().to_string(),
                &row.remark_text(),
            ])?;
        }
    }
    Ok(writer.into_inner()?)
}
