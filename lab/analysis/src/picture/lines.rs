//! Curves over a common axis.

use std::ops::Range;

use thermal_charts::{Curve, Legend, Panel};

use super::svg;

const SIZE: (i32, i32) = (1000, 380);

/// Draws curves with a legend beside them.
pub fn lines(
    x: Range<f64>,
    x_name: &str,
    y_name: &str,
    curves: &[Curve],
) -> anyhow::Result<String> {
    let longest = curves.iter().map(|curve| super::width(&curve.name)).max();
    let panel = Panel {
        x,
        x_name,
        y_name,
        legend: Legend::Beside(longest.unwrap_or(0) as u32 + 60),
    };
    svg(SIZE, |root| panel.draw(root, curves))
}

/// The range from 0 to the largest of the values, which is not empty.
pub fn positive_range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let largest = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
    0.0..if largest > 0.0 { largest } else { 1.0 }
}
