//! Table, picture and page of a comparison.

use std::fmt::Write;

use plotters::prelude::*;
use thermal_charts::{document, escape, svg_element};

use crate::comparison::{Comparison, Report, Tissue};
use crate::display::Display;

/// Width of a display's name and of a number in the table.
const NAME: usize = 20;
const NUMBER: usize = 16;

/// The largest skin errors by display and material, for each finger on this device and on an ideal tile, mK.
pub fn table(report: &Report) -> String {
    let mut text = String::new();
    for tissue in Tissue::ALL {
        let rows: Vec<_> = report.rows.iter().filter(|row| row.tissue == tissue).collect();
        let materials = distinct(&rows, |row| row.material.as_str());
        if rows.is_empty() {
            continue;
        }
        let (of_device, of_ideal): (Value, Value) = (Comparison::max_mk, Comparison::ideal_max_mk);
        for (tile, value) in [("this tile", of_device), ("ideal tile", of_ideal)] {
            if rows.iter().all(|row| value(row).is_none()) {
                continue;
            }
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "\nlargest skin error from 50 ms on, mK, {} finger, {tile}; * better than ours",
                tissue.name()
            );
            let _ = write!(text, "{:NAME$}", "");
            for material in &materials {
                let _ = write!(text, "{material:>NUMBER$}");
            }
            text.push('\n');
            for display in distinct(&rows, |row| row.display) {
                let _ = write!(text, "{:NAME$}", display.name());
                for material in &materials {
                    let row =
                        rows.iter().find(|row| row.display == display && row.material == *material);
                    let cell =
                        row.map_or(String::new(), |row| cell(row, value, tile == "this tile"));
                    let _ = write!(text, "{cell:>NUMBER$}");
                }
                text.push('\n');
            }
        }
    }
    for row in &report.rows {
        for refused in row.faults.iter().chain(&row.refused_lines) {
            let _ = writeln!(text, "{} on {}: {refused}", row.display.name(), row.material);
        }
    }
    text
}

type Value = fn(&Comparison) -> Option<f64>;

fn cell(row: &Comparison, value: Value, on_this_tile: bool) -> String {
    let better =
        if on_this_tile { row.better_than_ours } else { row.better_than_ours_on_ideal_tile };
    let mark = if better == Some(true) { "*" } else { "" };
    value(row).map_or("-".into(), |mk| format!("{mk:.1}{mark}"))
}

/// The page: table, picture, and what each display is.
pub fn page(report: &Report, svg: &str) -> String {
    let mut body = format!("<pre>{}</pre>", escape(&table(report)));
    body += svg_element(svg);
    body += "<table><tr><th>display</th><th>source</th><th>assumed</th></tr>";
    for shown in &report.displays {
        // Writing to a String cannot fail.
        let _ = write!(
            body,
            "<tr><td>{}</td><td>{}</td><td>{}</td></tr>",
            shown.display.name(),
            escape(shown.source),
            escape(shown.assumed)
        );
    }
    body += "</table>";
    document("Earlier displays", "", &body)
}

const SIZE: (u32, u32) = (1100, 900);
const FONT: (&str, i32) = ("sans-serif", 15);
const MARGIN: i32 = 14;
/// Height of the legend below the charts.
const LEGEND: i32 = 84;
const DOT: i32 = 5;
/// Errors that are drawn, mK; smaller ones lie on the lower edge.
const LEAST_MK: f64 = 0.5;

/// Colours of the displays, in the order of [`Display::ALL`].
const COLORS: [RGBColor; 9] = [
    RGBColor(0x1f, 0x77, 0xb4),
    RGBColor(0x17, 0xbe, 0xcf),
    RGBColor(0x8c, 0x56, 0x4b),
    RGBColor(0x94, 0x67, 0xbd),
    RGBColor(0xff, 0x7f, 0x0e),
    RGBColor(0xbc, 0xbd, 0x22),
    RGBColor(0xe3, 0x77, 0xc2),
    RGBColor(0x2c, 0xa0, 0x2c),
    RGBColor(0xd6, 0x27, 0x28),
];

/// The largest errors by material, one chart for each finger: on this device (dots) and on an ideal tile (rings), as an SVG
/// document; `None` without rows.
///
/// # Errors
/// The picture cannot be drawn.
pub fn chart(report: &Report) -> anyhow::Result<Option<String>> {
    let rows: Vec<_> = report.rows.iter().collect();
    let tissues = distinct(&rows, |row| row.tissue);
    if tissues.is_empty() {
        return Ok(None);
    }
    let mut svg = String::new();
    {
        let height = (SIZE.1 - LEGEND as u32) / 2 * tissues.len() as u32 + LEGEND as u32;
        let root = SVGBackend::with_string(&mut svg, (SIZE.0, height)).into_drawing_area();
        root.fill(&WHITE)?;
        let (charts, legend) = root.split_vertically(height as i32 - LEGEND);
        let most_mk = (rows.iter())
            .flat_map(|row| [row.max_mk(), row.ideal_max_mk()])
            .flatten()
            .fold(LEAST_MK, f64::max);
        for (area, tissue) in charts.split_evenly((tissues.len(), 1)).iter().zip(&tissues) {
            largest(area, *tissue, &rows, most_mk)?;
        }
        for (i, display) in distinct(&rows, |row| row.display).into_iter().enumerate() {
            let (x, y) = (76 + 250 * (i as i32 % 4), 4 + 22 * (i as i32 / 4));
            legend.draw(&Circle::new((x, y + 7), DOT, color(display).filled()))?;
            legend.draw(&Text::new(display.name(), (x + 14, y), FONT))?;
        }
        legend.draw(&Text::new(tiles(&rows), (326, 48), FONT))?;
        root.present()?;
    }
    Ok(Some(svg))
}

/// What dots and rings are.
fn tiles(rows: &[&Comparison]) -> &'static str {
    match rows.iter().any(|row| row.max_mk().is_some()) {
        true => "dots: on this tile; rings: on a tile that follows the course exactly",
        false => "on a tile that follows the course exactly",
    }
}

fn largest(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    tissue: Tissue,
    rows: &[&Comparison],
    most_mk: f64,
) -> anyhow::Result<()> {
    let rows: Vec<_> = rows.iter().copied().filter(|row| row.tissue == tissue).collect();
    let materials = distinct(&rows, |row| row.material.as_str());
    let displays = distinct(&rows, |row| row.display);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .caption(format!("{} finger", tissue.name()), FONT)
        .x_label_area_size(30)
        .y_label_area_size(64)
        .build_cartesian_2d(
            -0.5..materials.len() as f64 - 0.5,
            (LEAST_MK * 0.8..most_mk * 1.5).log_scale(),
        )?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_desc("largest skin error / mK")
        .y_label_formatter(&|mk| format!("{mk}"))
        .light_line_style(TRANSPARENT)
        .label_style(FONT)
        .draw()?;
    for i in 1..materials.len() {
        let x = i as f64 - 0.5;
        let edge = [(x, LEAST_MK * 0.8), (x, most_mk * 1.5)];
        chart.draw_series(LineSeries::new(edge, BLACK.mix(0.15)))?;
    }
    let (_, height) = area.dim_in_pixel();
    let (left, _) = area.get_base_pixel();
    for (i, material) in materials.iter().enumerate() {
        for (k, display) in displays.iter().enumerate() {
            let at = i as f64 + (k as f64 - (displays.len() as f64 - 1.0) / 2.0) * 0.09;
            let color = color(*display);
            let own = rows.iter().find(|row| row.display == *display && row.material == *material);
            let Some(row) = own else { continue };
            if let Some(mk) = row.ideal_max_mk() {
                let ring = Circle::new((at, mk.max(LEAST_MK)), DOT, color.stroke_width(2));
                chart.draw_series([ring])?;
            }
            if let Some(mk) = row.max_mk() {
                let dot = Circle::new((at, mk.max(LEAST_MK)), DOT, color.filled());
                chart.draw_series([dot])?;
            }
        }
        let (width, _) = area.estimate_text_size(material, &FONT.into_text_style(area))?;
        let x = chart.backend_coord(&(i as f64, LEAST_MK)).0 - left - width as i32 / 2;
        area.draw(&Text::new((*material).to_owned(), (x, height as i32 - 32), FONT))?;
    }
    Ok(())
}

fn color(display: Display) -> RGBColor {
    let place = Display::ALL.iter().position(|known| *known == display);
    COLORS[place.unwrap_or(0) % COLORS.len()]
}

/// Values in the order in which they first occur.
fn distinct<'a, T: PartialEq + 'a>(
    rows: &[&'a Comparison],
    value: impl Fn(&'a Comparison) -> T,
) -> Vec<T> {
    let mut values = Vec::new();
    for row in rows {
        let value = value(row);
        if !values.contains(&value) {
            values.push(value);
        }
    }
    values
}
