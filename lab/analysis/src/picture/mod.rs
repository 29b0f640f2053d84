//! Pictures of the analyses, as SVG documents.

mod intervals;
mod lines;
mod matrix;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub use intervals::{Intervals, Mark};
pub use lines::{lines, positive_range};
pub use matrix::matrix;
pub use thermal_charts::{Curve, Stroke};

const FONT: (&str, i32) = ("sans-serif", 15);
const GREY: RGBColor = RGBColor(0x99, 0x99, 0x99);

/// Colours of series, which also differ in lightness.
const COLORS: [RGBColor; 8] = [
    RGBColor(0x1f, 0x77, 0xb4),
    RGBColor(0xe3, 0x77, 0x00),
    RGBColor(0x2c, 0xa0, 0x2c),
    RGBColor(0xd6, 0x27, 0x28),
    RGBColor(0x94, 0x67, 0xbd),
    RGBColor(0x17, 0x9e, 0xae),
    RGBColor(0x8c, 0x56, 0x4b),
    RGBColor(0x22, 0x22, 0x22),
];

/// Colour of a series.
pub fn color(series: usize) -> RGBColor {
    COLORS[series % COLORS.len()]
}

fn text_style(horizontal: HPos, color: RGBColor) -> TextStyle<'static> {
    FONT.into_font().color(&color).pos(Pos::new(horizontal, VPos::Center))
}

/// Estimated width of a text, pixels; the page's font is not known here.
fn width(text: &str) -> i32 {
    8 * text.chars().count() as i32
}

/// Draws into a white picture.
fn svg(
    size: (i32, i32),
    draw: impl FnOnce(&DrawingArea<SVGBackend<'_>, plotters::coord::Shift>) -> anyhow::Result<()>,
) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let size = (size.0.max(1) as u32, size.1.max(1) as u32);
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE)?;
        draw(&root)?;
        root.present()?;
    }
    Ok(svg)
}
