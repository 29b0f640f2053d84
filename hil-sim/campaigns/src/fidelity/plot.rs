//! Chart of the errors over time and of the largest errors.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::{FidelityRow, Scenario};

const SIZE: (u32, u32) = (1100, 1060);
const TITLE: i32 = 34;
const OVER_TIME: i32 = 640;
pub(super) const FONT: (&str, i32) = ("sans-serif", 15);
pub(super) const MARGIN: i32 = 14;
const DOT: i32 = 5;

/// Colours of the laws, in the order in which they occur.
pub(super) const COLORS: [RGBColor; 4] = [
    RGBColor(0x7f, 0x7f, 0x7f),
    RGBColor(0x1f, 0x77, 0xb4),
    RGBColor(0xd6, 0x27, 0x28),
    RGBColor(0x2c, 0xa0, 0x2c),
];
pub(super) const BOUND: RGBColor = RGBColor(0x22, 0x22, 0x22);

/// Times, s, and errors, mK, that are drawn; smaller errors lie on the lower edge.
const TIMES_S: Range<f64> = 1e-3..12.0;
const ERRORS_MK: Range<f64> = 0.5..5000.0;

/// Materials whose errors are drawn over time, if they were run.
const OVER_TIME_OF: [&str; 4] = ["copper", "granite", "abs", "foam"];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The chart of the first scenario of the rows, as an SVG document; `None` without rows.
///
/// # Errors
/// The plot cannot be drawn.
pub fn draw(rows: &[FidelityRow]) -> anyhow::Result<Option<String>> {
    let Some(first) = rows.first() else {
        return Ok(None);
    };
    let scenario = first.scenario;
    let rows: Vec<_> =
        (rows.iter()).filter(|row| row.scenario == scenario && row.without.is_none()).collect();
    let laws = distinct(&rows, |row| row.law);
    let cases = distinct(&rows, |row| row.case.as_str());
    let mut shown: Vec<_> = OVER_TIME_OF.into_iter().filter(|name| cases.contains(name)).collect();
    if shown.is_empty() {
        shown = cases.iter().copied().take(OVER_TIME_OF.len()).collect();
    }
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let title = format!("Scenario {}: {}", scenario.name(), scenario.title());
        root.draw(&Text::new(title, (MARGIN, MARGIN), (FONT.0, 18)))?;
        let (_, below) = root.split_vertically(TITLE);
        let (upper, lower) = below.split_vertically(OVER_TIME);
        let places = upper.split_evenly((shown.len().div_ceil(2), 2.min(shown.len())));
        for (area, name) in places.iter().zip(&shown) {
            over_time(area, name, &rows, &laws)?;
        }
        largest(&lower, scenario, &rows, &laws, &cases)?;
        root.present()?;
    }
    Ok(Some(svg))
}

/// Values in the order in which they first occur.
fn distinct<'a, T: PartialEq + 'a>(
    rows: &[&'a FidelityRow],
    value: impl Fn(&'a FidelityRow) -> T,
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

/// Magnitude of the error of each law over time, with the largest force that was run.
fn over_time(
    area: &Area<'_>,
    name: &str,
    rows: &[&FidelityRow],
    laws: &[&str],
) -> anyhow::Result<()> {
    let own = || rows.iter().filter(|row| row.case == name);
    let force_n = own().map(|row| row.force_n).fold(0.0, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .caption(format!("{name}, {force_n} N"), FONT)
        .x_label_area_size(38)
        .y_label_area_size(58)
        .build_cartesian_2d(TIMES_S.log_scale(), ERRORS_MK.log_scale())?;
    chart
        .configure_mesh()
        .x_desc("time since landing / s")
        .y_desc("|skin error| / mK")
        .x_label_formatter(&|t_s| plain(*t_s))
        .y_label_formatter(&|mk| plain(*mk))
        .light_line_style(TRANSPARENT)
        .label_style(FONT)
        .draw()?;
    for row in own().filter(|row| row.force_n == force_n) {
        let color = color(laws, row.law);
        let points = row.error_over_time.iter();
        let points = points.map(|(t_s, mk)| (*t_s, mk.abs().clamp(ERRORS_MK.start, ERRORS_MK.end)));
        chart
            .draw_series(LineSeries::new(points, color.stroke_width(2)))?
            .label(row.law)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], color.stroke_width(2)));
    }
    if let Some(bound_mk) = own().find_map(|row| bound_mk(row)) {
        let line = [(TIMES_S.start, bound_mk), (TIMES_S.end, bound_mk)];
        chart.draw_series(DashedLineSeries::new(line, 6, 4, BOUND.stroke_width(1)))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .label_font(FONT)
        .draw()?;
    Ok(())
}

/// The bounded figure at the worst force of each material and law.
fn largest(
    area: &Area<'_>,
    scenario: Scenario,
    rows: &[&FidelityRow],
    laws: &[&str],
    cases: &[&str],
) -> anyhow::Result<()> {
    let unit = rows.first().map_or("mK", |row| row.judged.unit);
    let rows: Vec<_> = rows.iter().filter(|row| row.judged.unit == unit).collect();
    let values = rows.iter().filter_map(|row| row.judged.value);
    let (least, most) = values
        .chain(rows.iter().filter_map(|row| row.judged.bound))
        .fold((f64::INFINITY, f64::MIN_POSITIVE), |(l, m), value| (l.min(value), m.max(value)));
    // Values below half a row of the trace are drawn at that value.
    let least = least.clamp(0.5e-3, most);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(58)
        .y_label_area_size(58)
        .build_cartesian_2d(
            -0.5..cases.len() as f64 - 0.5,
            (least * 0.6..most * 2.0).log_scale(),
        )?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_desc(match scenario {
            Scenario::B => "time until it stays below 50 mK / s".to_owned(),
            _ => format!("largest skin error, worst force / {unit}"),
        })
        .y_label_formatter(&|value| plain(*value))
        .light_line_style(TRANSPARENT)
        .label_style(FONT)
        .draw()?;
    for (i, case) in cases.iter().enumerate() {
        let x = i as f64;
        let own = || rows.iter().filter(|row| row.case == *case);
        if let Some(bound) = own().find_map(|row| row.judged.bound) {
            let line = [(x - 0.5, bound), (x + 0.5, bound)];
            chart.draw_series(DashedLineSeries::new(line, 6, 4, BOUND.stroke_width(1)))?;
        }
        for (k, law) in laws.iter().enumerate() {
            let at = x + (k as f64 - (laws.len() as f64 - 1.0) / 2.0) * 0.18;
            let values = own().filter(|row| row.law == *law).filter_map(|row| row.judged.value);
            if let Some(worst) = values.reduce(f64::max) {
                let dot = Circle::new((at, worst.max(least)), DOT, color(laws, law).filled());
                chart.draw_series([dot])?;
            }
        }
    }
    names(area, cases, |x| chart.backend_coord(&(x, least)).0)
}

/// Names below the axis, in two rows where there are many.
fn names(area: &Area<'_>, cases: &[&str], place: impl Fn(f64) -> i32) -> anyhow::Result<()> {
    let (_, height) = area.dim_in_pixel();
    let (left, _) = area.get_base_pixel();
    for (i, case) in cases.iter().enumerate() {
        let (width, _) = area.estimate_text_size(case, &FONT.into_text_style(area))?;
        let row = if cases.len() > 9 { i as i32 % 3 } else { 0 };
        let at = (place(i as f64) - left - width as i32 / 2, height as i32 - 66 + 18 * row);
        area.draw(&Text::new((*case).to_owned(), at, FONT))?;
    }
    Ok(())
}

fn bound_mk(row: &FidelityRow) -> Option<f64> {
    row.judged.bound.filter(|_| row.judged.unit == "mK")
}

fn color(laws: &[&str], law: &str) -> RGBColor {
    let place = laws.iter().position(|known| *known == law).unwrap_or(0);
    COLORS[place % COLORS.len()]
}

/// A power of ten in decimal notation.
pub(super) fn plain(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}
