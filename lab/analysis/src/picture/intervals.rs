//! Estimates with their intervals, a row for each.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::{FONT, GREY, color, svg, text_style, width};

/// Height of a row beside that of its series, and of the axis, pixels.
const ROW: i32 = 17;
const AXIS: i32 = 52;
const WIDTH: i32 = 560;
const MARGIN: i32 = 16;
/// Distance of the series of a row, pixels.
const APART: i32 = 7;

/// A picture of estimates with intervals.
pub struct Intervals<'a> {
    /// Quantity and unit of the axis.
    pub axis: &'a str,
    /// First and last value of the axis.
    pub range: (f64, f64),
    /// Distance of labels on the axis.
    pub step: f64,
    /// Names of the series; one has no legend.
    pub series: &'a [&'a str],
    /// Values with a line of their own, and what they are.
    pub lines: Vec<(f64, String)>,
}

/// An estimate.
pub struct Mark {
    pub row: String,
    pub series: usize,
    pub value: f64,
    pub interval: Option<(f64, f64)>,
}

impl Intervals<'_> {
    /// Draws the marks, those with equal `row` beside each other.
    pub fn draw(&self, marks: &[Mark]) -> anyhow::Result<String> {
        let rows = crate::cells::distinct(marks.iter().map(|mark| mark.row.as_str()));
        let left = rows.iter().map(|row| width(row)).max().unwrap_or(0) + MARGIN;
        let has_legend = self.series.len() > 1;
        let longest = self.series.iter().map(|name| width(name)).max();
        let legend = if has_legend { longest.unwrap_or(0) + 40 } else { 90 };
        let height = ROW + APART * self.series.len().max(1) as i32;
        let names = if self.lines.is_empty() { MARGIN } else { 26 };
        let bottom = names + height * rows.len() as i32;
        let (low, high) = self.range;
        let x = |value: f64| {
            let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
            left + (part * f64::from(WIDTH)).round() as i32
        };
        svg((left + WIDTH + legend + MARGIN, bottom + AXIS), |root| {
            for i in 0..rows.len() as i32 {
                let y = names + height * i + height / 2;
                let grid = [(left, y), (left + WIDTH, y)];
                root.draw(&PathElement::new(grid, BLACK.mix(0.08)))?;
            }
            for (i, (value, name)) in self.lines.iter().enumerate() {
                let line = [(x(*value), names), (x(*value), bottom)];
                root.draw(&PathElement::new(line, GREY.stroke_width(1 + i as u32)))?;
                let style = text_style(HPos::Center, GREY);
                root.draw(&Text::new(name.clone(), (x(*value), 12), style))?;
            }
            root.draw(&PathElement::new([(left, bottom), (left + WIDTH, bottom)], BLACK))?;
            let count = ((high - low) / self.step).round().clamp(1.0, 50.0) as u32;
            for i in 0..=count {
                let value = low + f64::from(i) * self.step;
                let at = x(value);
                root.draw(&PathElement::new([(at, bottom), (at, bottom + 5)], BLACK))?;
                let decimals = (-self.step.log10().floor()).clamp(0.0, 6.0) as usize;
                let label = format!("{value:.decimals$}");
                root.draw(&Text::new(label, (at, bottom + 15), text_style(HPos::Center, BLACK)))?;
            }
            let middle = (left + WIDTH / 2, bottom + 38);
            root.draw(&Text::new(self.axis, middle, text_style(HPos::Center, BLACK)))?;
            for (i, row) in rows.iter().enumerate() {
                let y = names + height * i as i32 + height / 2;
                let name =
                    Text::new((*row).to_owned(), (left - 10, y), text_style(HPos::Right, BLACK));
                root.draw(&name)?;
                for mark in marks.iter().filter(|mark| mark.row == *row) {
                    let middle = self.series.len().saturating_sub(1) as i32 * APART / 2;
                    let y = y + APART * mark.series as i32 - middle;
                    let color = color(mark.series);
                    if let Some((from, to)) = mark.interval {
                        let ends = [(x(from), y), (x(to), y)];
                        root.draw(&PathElement::new(ends, color.stroke_width(2)))?;
                    }
                    root.draw(&Circle::new((x(mark.value), y), 4, color.filled()))?;
                }
            }
            if has_legend {
                for (i, name) in self.series.iter().enumerate() {
                    let at = (left + WIDTH + 24, names + 24 * i as i32 + 12);
                    root.draw(&Circle::new(at, 4, color(i).filled()))?;
                    root.draw(&Text::new(*name, (at.0 + 12, at.1 - FONT.1 / 2), FONT))?;
                }
            }
            Ok(())
        })
    }
}
