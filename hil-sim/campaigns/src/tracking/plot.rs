//! Chart of the errors over time.

use plotters::prelude::*;
use thermal_charts::{Curve, Legend, Panel, Stroke};

use super::{SENSOR_LAGS_S, TouchingFinger, TrackingReport};

const SIZE: (u32, u32) = (1100, 1000);
/// Stimuli that are drawn, if they were run.
const SHOWN: [&str; 4] =
    ["ramp of 1 K/s", "ramp of 5 K/s", "pulse of -5 K at 4 K/s", "display of copper"];
/// Largest difference under a finger that the device is made for, mK.
const DESIGN_ERROR_MK: f64 = 30.0;
const COLORS: [RGBColor; SENSOR_LAGS_S.len()] =
    [RGBColor(0x2c, 0xa0, 0x2c), RGBColor(0x1f, 0x77, 0xb4), RGBColor(0xd6, 0x27, 0x28)];
const DESIGN_ERROR_COLOR: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// Largest number of points of a curve.
const POINTS: usize = 700;

/// Display minus course under the thesis's finger, as an SVG document.
///
/// # Errors
/// The plot cannot be drawn.
pub fn chart(report: &TrackingReport) -> anyhow::Result<String> {
    let finger = TouchingFinger::ALL.iter().position(|touch| *touch == TouchingFinger::Thesis);
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let areas = root.split_evenly((2, 2));
        for (area, shown) in areas.iter().zip(SHOWN) {
            let stimulus = report.stimuli.iter().position(|name| name == shown);
            let Some((stimulus, finger)) = stimulus.zip(finger) else {
                continue;
            };
            let results = &report.results[stimulus][finger];
            let mut end_s = 0.0f64;
            let mut curves = Vec::new();
            for ((result, lag_s), color) in results.iter().zip(SENSOR_LAGS_S).zip(COLORS) {
                let every = result.curve.len().div_ceil(POINTS).max(1);
                let counted = result.curve.iter().filter(|(t_s, ..)| *t_s >= 0.05);
                let points = counted.step_by(every);
                curves.push(Curve {
                    name: format!("thermistors of {lag_s} s"),
                    color,
                    stroke: Stroke::Solid(2),
                    points: points
                        .map(|(t_s, wanted_c, display_c)| (*t_s, 1e3 * (display_c - wanted_c)))
                        .collect(),
                });
                let last = result.curve.last();
                end_s = end_s.max(last.map_or(0.0, |(t_s, ..)| *t_s));
            }
            for error_mk in [DESIGN_ERROR_MK, -DESIGN_ERROR_MK] {
                curves.push(Curve {
                    name: format!("{error_mk:+} mK"),
                    color: DESIGN_ERROR_COLOR,
                    stroke: Stroke::Dashed,
                    points: [(0.0, error_mk), (end_s, error_mk)].into(),
                });
            }
            let x_name = format!("{shown}: time / s");
            let panel = Panel {
                x: 0.0..end_s,
                x_name: &x_name,
                y_name: "display minus course / mK",
                legend: Legend::Inside,
            };
            panel.draw(area, &curves)?;
        }
        root.present()?;
    }
    Ok(svg)
}
