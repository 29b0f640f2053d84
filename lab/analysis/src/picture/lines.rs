//! Curves over a common axis.

use std::ops::Range;

use thermal_charts::{Curve, Legend, Panel};

use super::svg;

const WIDTH: i32 = 1000;
const HEIGHT: i32 = 380;
/// Height of a line of the legend, pixels.
const LINE: i32 = 20;

/// Draws curves with a legend beside them.
pub fn lines(
    x: Range<f64>,
    x_name: &str,
    y_name: &str,
    curves: &[Curve],
) -> anyhow::Result<String> {
    let longest = curves.iter().map(|curve| super::width(&curve.name)).max();
    let panel =
        Panel { x, x_name, y_name, legend: Legend::Beside(longest.unwrap_or(0) as u32 + 60) };
    let height = HEIGHT.max(LINE * curves.len() as i32 + 40);
    svg((WIDTH, height), |root| panel.draw(root, curves))
}

/// The range from 0 to the largest of the values, which is not empty.
pub fn positive_range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let largest = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
    0.0..if largest > 0.0 { largest } else { 1.0 }
}
