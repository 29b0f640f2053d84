//! A line chart in the style of all reports.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;

/// Dash and gap length of a dashed curve, pixels.
const DASH: (u32, u32) = (7, 5);
/// Radius of a dot, pixels.
const DOT: i32 = 4;
/// Font and size of all text in a chart.
const FONT: (&str, i32) = ("sans-serif", 15);
/// Space around a chart, pixels.
const MARGIN: i32 = 14;
/// Padding around the text of a legend, pixels.
const PADDING: i32 = 8;
/// Line height of a legend, pixels.
const LINE_HEIGHT: i32 = 20;
/// Length of the line sample of a curve in a legend, pixels.
const SAMPLE: i32 = 22;

/// Area of an SVG picture in which a chart is drawn.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Style of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A line of this width, pixels.
    Solid(u32),
    /// A dashed line two pixels wide.
    Dashed,
    /// Dots alone.
    Dots,
}

/// A named curve.
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Colour of the curve and of its sample in the legend.
    pub color: RGBColor,
    /// Style of the curve.
    pub stroke: Stroke,
    /// Points `(x, y)` in the units of the axes, in drawing order.
    pub points: Vec<(f64, f64)>,
}

/// Position of the legend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legend {
    /// In the upper right corner of the curves.
    Inside,
    /// Right of the curves, with this width in pixels.
    Beside(u32),
}

/// A chart: axes and position of the legend.
pub struct Panel<'a> {
    /// Range of the horizontal axis; that of the vertical axis is fitted to the curves.
    pub x: Range<f64>,
    /// Quantity and unit of the horizontal axis.
    pub x_name: &'a str,
    /// Quantity and unit of the vertical axis.
    pub y_name: &'a str,
    /// Position of the legend.
    pub legend: Legend,
}

impl Panel<'_> {
    /// Draws the curves with a y range that contains all of them.
    ///
    /// # Errors
    /// The chart cannot be drawn.
    pub fn draw(&self, area: &Area<'_>, curves: &[Curve]) -> anyhow::Result<()> {
        let (all, _) = area.dim_in_pixel();
        match self.legend {
            Legend::Inside => {
                self.chart(area, curves)?;
                let mut width = 0;
                for curve in curves {
                    width = width
                        .max(area.estimate_text_size(&curve.name, &FONT.into_text_style(area))?.0);
                }
                let (width, height) =
                    (width as i32 + SAMPLE + 2 * PADDING, LINE_HEIGHT * curves.len() as i32);
                let left = all as i32 - MARGIN - PADDING - width;
                let corners = [(left, MARGIN + PADDING), (left + width, MARGIN + PADDING + height)];
                area.draw(&Rectangle::new(corners, WHITE.mix(0.85).filled()))?;
                area.draw(&Rectangle::new(corners, BLACK.mix(0.3)))?;
                legend(area, (left + PADDING / 2, corners[0].1), curves)
            }
            Legend::Beside(width) => {
                let (left, right) = area.split_horizontally(all.saturating_sub(width));
                self.chart(&left, curves)?;
                legend(&right, (0, MARGIN), curves)
            }
        }
    }

    fn chart(&self, area: &Area<'_>, curves: &[Curve]) -> anyhow::Result<()> {
        let values =
            || curves.iter().flat_map(|curve| curve.points.iter().map(|(_, value)| *value));
        let (low, high) =
            values().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        let margin = ((high - low) * 0.08).max(0.05);
        let span = high - low + 2.0 * margin;
        // Labels of neighbouring lines must differ.
        let decimals = match span {
            _ if span < 0.5 => 2,
            _ if high - low < 100.0 => 1,
            _ => 0,
        };
        let rounding = if decimals == 2 { 100.0 } else { 10.0 };
        let mut chart = ChartBuilder::on(area)
            .margin(MARGIN)
            .x_label_area_size(38)
            .y_label_area_size(64)
            .build_cartesian_2d(self.x.clone(), low - margin..high + margin)?;
        chart
            .configure_mesh()
            .x_desc(self.x_name)
            .y_desc(self.y_name)
            // Adding zero converts a negative zero into zero.
            .y_label_formatter(&|value| {
                format!("{:.decimals$}", (value * rounding).round() / rounding + 0.0)
            })
            .light_line_style(TRANSPARENT)
            .label_style(FONT)
            .draw()?;
        for curve in curves {
            let points = curve.points.iter().copied();
            let (color, stroke) = (curve.color, curve.stroke);
            match stroke {
                Stroke::Solid(width) => {
                    chart.draw_series(LineSeries::new(points, color.stroke_width(width)))?;
                }
                Stroke::Dashed => {
                    let style = color.stroke_width(2);
                    chart.draw_series(DashedLineSeries::new(points, DASH.0, DASH.1, style))?;
                }
                Stroke::Dots => {
                    chart
                        .draw_series(points.map(|point| Circle::new(point, DOT, color.filled())))?;
                }
            }
        }
        Ok(())
    }
}

/// Draws line samples and names as a list with its upper left corner at `(x, y)`.
fn legend(area: &Area<'_>, (x, y): (i32, i32), curves: &[Curve]) -> anyhow::Result<()> {
    for (i, curve) in (0..).zip(curves) {
        let middle = y + i * LINE_HEIGHT + LINE_HEIGHT / 2;
        let (color, ends) = (curve.color, [(x, middle), (x + SAMPLE, middle)]);
        match curve.stroke {
            Stroke::Solid(width) => {
                area.draw(&PathElement::new(ends, color.stroke_width(width)))?
            }
            Stroke::Dashed => {
                let style = color.stroke_width(2);
                area.draw(&DashedPathElement::new(ends, DASH.0, DASH.1, style))?;
            }
            Stroke::Dots => {
                area.draw(&Circle::new((x + SAMPLE / 2, middle), DOT, color.filled()))?
            }
        }
        let at = (x + SAMPLE + PADDING, middle - FONT.1 / 2);
        area.draw(&Text::new(curve.name.as_str(), at, FONT))?;
    }
    Ok(())
}
