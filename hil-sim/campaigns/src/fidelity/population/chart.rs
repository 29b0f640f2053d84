//! Chart of the share of runs below an error.

use plotters::prelude::*;

use super::super::plot::{BOUND, COLORS, FONT, MARGIN, plain};
use super::{Aim, Population, PopulationResult, Since};
use std::ops::Range;

/// File name of the chart.
pub const SVG: &str = "populations.svg";
const SIZE: (u32, u32) = (1100, 760);
/// Errors that are drawn, mK; smaller and larger ones lie on the edges.
const ERRORS_MK: Range<f64> = 1.0..10_000.0;
/// Share of the runs at most, %.
const SHARES: Range<f64> = 0.0..100.0;

/// The chart as an SVG document; `None` without results.
///
/// # Errors
/// The plot cannot be drawn.
pub fn draw(results: &[PopulationResult]) -> anyhow::Result<Option<String>> {
    let shown: Vec<_> = (Population::ALL.into_iter())
        .filter(|population| results.iter().any(|one| one.population == *population))
        .collect();
    if shown.is_empty() {
        return Ok(None);
    }
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let places = root.split_evenly((shown.len().div_ceil(2), 2.min(shown.len())));
        for (area, population) in places.iter().zip(&shown) {
            let title = format!("{}: {}", population.name(), population.title());
            let mut chart = ChartBuilder::on(area)
                .margin(MARGIN)
                // Room for half of the last label.
                .margin_right(24)
                .caption(title, (FONT.0, 13))
                .x_label_area_size(38)
                .y_label_area_size(58)
                .build_cartesian_2d(ERRORS_MK.log_scale(), SHARES)?;
            chart
                .configure_mesh()
                .x_desc("largest skin error from 50 ms on / mK")
                .y_desc("runs below it / %")
                .x_label_formatter(&|mk| plain(*mk))
                .y_label_formatter(&|percent| plain(*percent))
                .light_line_style(TRANSPARENT)
                .label_style(FONT)
                .draw()?;
            let drawn = |aim: &&Aim| aim.since == Since::Ms50;
            for Aim { percent, aim_mk, .. } in population.aims().iter().filter(drawn) {
                let line = [(*aim_mk, 0.0), (*aim_mk, *percent), (ERRORS_MK.start, *percent)];
                chart.draw_series(DashedLineSeries::new(line, 6, 4, BOUND.stroke_width(1)))?;
            }
            for (way, color) in population.ways().iter().zip([COLORS[2], COLORS[0]]) {
                let own = results.iter();
                let own = own.filter(|one| (one.population, one.way) == (*population, *way));
                let mut errors: Vec<_> = own.map(|one| one.max_after_50ms_mk).collect();
                errors.sort_by(f64::total_cmp);
                let share = SHARES.end / errors.len() as f64;
                let points = errors.iter().enumerate().map(|(i, mk)| {
                    (mk.clamp(ERRORS_MK.start, ERRORS_MK.end), (i + 1) as f64 * share)
                });
                chart
                    .draw_series(LineSeries::new(points, color.stroke_width(2)))?
                    .label(way.name())
                    .legend(move |(x, y)| {
                        PathElement::new([(x, y), (x + 20, y)], color.stroke_width(2))
                    });
            }
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::LowerRight)
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.3))
                .label_font(FONT)
                .draw()?;
        }
        root.present()?;
    }
    Ok(Some(svg))
}
