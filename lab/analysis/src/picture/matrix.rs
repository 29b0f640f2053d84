//! A confusion matrix.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::{svg, text_style, width};

const CELL: (i32, i32) = (112, 44);
const HEAD: i32 = 62;
const INK: RGBColor = RGBColor(0x1f, 0x4e, 0x79);

/// Draws counts by presented (rows) and answered (columns), each shaded by its part of the row.
pub fn matrix(labels: &[String], counts: &[Vec<u32>]) -> anyhow::Result<String> {
    let left =
        labels.iter().map(|label| width(label)).max().unwrap_or(0).max(width("presented")) + 24;
    let size = (left + CELL.0 * labels.len() as i32 + 16, HEAD + CELL.1 * counts.len() as i32 + 16);
    svg(size, |root| {
        let answered = (left + CELL.0 * labels.len() as i32 / 2, 16);
        root.draw(&Text::new("answered", answered, text_style(HPos::Center, BLACK)))?;
        root.draw(&Text::new("presented", (left - 10, 44), text_style(HPos::Right, BLACK)))?;
        for (column, label) in (0..).zip(labels) {
            let at = (left + CELL.0 * column + CELL.0 / 2, 44);
            root.draw(&Text::new(label.clone(), at, text_style(HPos::Center, BLACK)))?;
        }
        for (row, (label, counts)) in (0..).zip(labels.iter().zip(counts)) {
            let top = HEAD + CELL.1 * row;
            let at = (left - 10, top + CELL.1 / 2);
            root.draw(&Text::new(label.clone(), at, text_style(HPos::Right, BLACK)))?;
            let total = counts.iter().sum::<u32>().max(1);
            for (column, count) in (0..).zip(counts) {
                let part = f64::from(*count) / f64::from(total);
                let corner = (left + CELL.0 * column, top);
                let corners = [corner, (corner.0 + CELL.0, corner.1 + CELL.1)];
                root.draw(&Rectangle::new(corners, INK.mix(part).filled()))?;
                let edge =
                    if row == column { BLACK.stroke_width(2) } else { BLACK.mix(0.2).into() };
                root.draw(&Rectangle::new(corners, edge))?;
                let ink = if part > 0.5 { WHITE } else { BLACK };
                let ink = RGBColor(ink.0, ink.1, ink.2);
                let text = format!("{count} ({:.0} %)", 100.0 * part);
                let middle = (corner.0 + CELL.0 / 2, corner.1 + CELL.1 / 2);
                root.draw(&Text::new(text, middle, text_style(HPos::Center, ink)))?;
            }
        }
        Ok(())
    })
}
