//! Pictures of the waveforms that a bench simulates.

use std::ops::Range;

use anyhow::Result;
use plotters::prelude::*;
use thermal_charts::{Curve, Legend, Panel, Stroke};

use crate::netlist::Netlists;
use crate::ngspice;

/// Colours of the curves of a chart, in their order.
const COLORS: [RGBColor; 4] =
    [RGBColor(200, 60, 40), RGBColor(40, 90, 180), RGBColor(40, 140, 70), RGBColor(140, 80, 160)];
/// Width of a picture and height of one of its charts, pixels.
const SIZE: (u32, u32) = (1000, 260);
/// Width of the legends, pixels.
const LEGEND: u32 = 250;
/// Points of a curve that a picture can show.
const POINTS: f64 = 2000.0;

/// One chart: the name and unit of its vertical axis, and its signals as (name, ngspice's name of it, factor).
pub type Chart = (&'static str, &'static [(&'static str, &'static str, f64)]);

/// A bench's picture: its name, and the simulation that it shows.
pub type Picture = (&'static str, fn() -> Scene);

/// A simulation to draw.
pub struct Scene {
    /// The deck behind the netlists.
    pub lines: String,
    /// Name and unit of the horizontal axis, and how many of this unit a second is.
    pub time: (&'static str, f64),
    /// What is drawn of it, in that unit.
    pub range: Range<f64>,
    /// Charts, one below the other.
    pub charts: &'static [Chart],
}

/// Simulates and draws; an SVG document.
///
/// # Errors
/// The simulation fails, or the picture cannot be drawn.
pub fn draw(name: &str, netlists: &Netlists, scene: &Scene) -> Result<String> {
    let signals: Vec<_> = scene
        .charts
        .iter()
        .flat_map(|(_, signals)| signals.iter().map(|(_, signal, _)| *signal))
        .collect();
    let deck = format!("picture-{name}");
    let mut curves = ngspice::waveforms(&deck, netlists, &scene.lines, &signals)?.into_iter();
    let (time_name, per_second) = scene.time;
    let mut svg = String::new();
    {
        let rows = scene.charts.len();
        let size = (SIZE.0, SIZE.1 * rows as u32);
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE)?;
        for (area, (y_name, signals)) in root.split_evenly((rows, 1)).iter().zip(scene.charts) {
            let curves: Vec<_> = signals
                .iter()
                .zip(COLORS)
                .zip(curves.by_ref())
                .map(|(((name, _, factor), color), points)| {
                    let points = points
                        .into_iter()
                        .map(|(time_s, value)| (time_s * per_second, value * factor));
                    Curve {
                        name: (*name).to_owned(),
                        color,
                        stroke: Stroke::Solid(2),
                        points: visible(points, &scene.range),
                    }
                })
                .collect();
            let panel = Panel {
                x: scene.range.clone(),
                x_name: time_name,
                y_name,
                legend: Legend::Beside(LEGEND),
            };
            panel.draw(area, &curves)?;
        }
        root.present()?;
    }
    Ok(svg)
}

/// The points in a range, without those that a picture could not show apart from the one before.
fn visible(points: impl Iterator<Item = (f64, f64)>, range: &Range<f64>) -> Vec<(f64, f64)> {
    let inside: Vec<_> = points.filter(|(x, _)| range.contains(x)).collect();
    let (low, high) =
        inside.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, y)| {
            (low.min(*y), high.max(*y))
        });
    let (wide, tall) =
        ((range.end - range.start) / POINTS, (high - low).max(f64::MIN_POSITIVE) / 200.0);
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for (x, y) in inside {
        let apart = kept.last().is_none_or(|(x0, y0)| x - x0 > wide || (y - y0).abs() > tall);
        if apart {
            kept.push((x, y));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_keeps_its_steps_and_loses_points_that_nobody_could_see() {
        let flat = (0..100_000).map(|i| (f64::from(i) * 1e-5, if i < 50_000 { 0.0 } else { 1.0 }));
        let kept = visible(flat, &(0.0..1.0));
        assert!(kept.len() < 2100, "{}", kept.len());
        let step = kept.windows(2).find(|pair| pair[0].1 != pair[1].1);
        let step = step.map(|pair| pair[1].0 - pair[0].0);
        assert!(step.is_some_and(|gap| gap <= 1.0 / 2000.0 + 1e-5));
    }
}
