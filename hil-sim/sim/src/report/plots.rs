//! Temperatures, current and errors over time.

use plotters::prelude::*;
use thermal_charts::{Curve, Legend, Panel, Stroke};

use crate::metrics::{contact_times, display_errors};
use crate::run::Outcome;
use crate::scene::Scene;
use crate::trace::TraceRow;

const SIZE: (u32, u32) = (1000, 1050);
/// Largest number of points of a curve; more could not be distinguished.
const POINTS: usize = 1500;

const SKIN: RGBColor = RGBColor(0xd6, 0x27, 0x28);
const REAL: RGBColor = RGBColor(0x22, 0x22, 0x22);
const DISPLAY: RGBColor = RGBColor(0x1f, 0x77, 0xb4);
const SETPOINT: RGBColor = RGBColor(0x2c, 0xa0, 0x2c);
const CAMERA: RGBColor = RGBColor(0xe3, 0x9c, 0x2a);
const CURRENT: RGBColor = RGBColor(0x94, 0x67, 0xbd);

fn curve(
    name: &str,
    color: RGBColor,
    rows: &[TraceRow],
    value: impl Fn(usize, &TraceRow) -> Option<f64>,
) -> Curve {
    let every = rows.len().div_ceil(POINTS).max(1);
    let points = rows.iter().enumerate().step_by(every);
    Curve {
        name: name.into(),
        color,
        // The skin on the real object lies on that on the display, which so is wider, and seen between the dashes.
        stroke: match color {
            SKIN => Stroke::Solid(5),
            REAL => Stroke::Dashed,
            _ => Stroke::Solid(2),
        },
        points: points.filter_map(|(i, row)| Some((row.t_s, value(i, row)?))).collect(),
    }
}

/// Skin temperature recovered from the camera. It is sampled separately because most rows have no frame.
fn camera(rows: &[TraceRow]) -> Curve {
    let frames: Vec<_> =
        rows.iter().filter_map(|row| Some((row.t_s, row.camera?.recovered_c))).collect();
    let every = frames.len().div_ceil(POINTS).max(1);
    Curve {
        name: "skin, recovered from the camera".into(),
        color: CAMERA,
        stroke: Stroke::Solid(1),
        points: frames.into_iter().step_by(every).collect(),
    }
}

/// The plots of a run as one SVG document.
///
/// # Errors
/// The plot cannot be drawn.
pub(super) fn draw(scene: &Scene, outcome: &Outcome) -> anyhow::Result<String> {
    let rows = outcome.trace.rows();
    let contacts = contact_times(scene, outcome);
    let display_errors = display_errors(scene, outcome);
    let mut temperatures = vec![
        curve("skin on the display", SKIN, rows, |_, row| Some(row.skin_c)),
        curve("skin on the real object", REAL, rows, |_, row| Some(row.skin_real_c)),
        curve("display", DISPLAY, rows, |_, row| Some(row.display_c)),
        curve("set-point", SETPOINT, rows, |_, row| row.device.as_ref()?.setpoint_c),
    ];
    if scene.infrared.is_some() {
        // Drawn first, below the others, because it is one of them with noise.
        temperatures.insert(0, camera(rows));
    }
    let errors = [
        curve("skin minus skin on the real object", SKIN, rows, |i, row| {
            contacts[i].map(|_| (row.skin_c - row.skin_real_c) * 1e3)
        }),
        curve("display minus exact set-point", DISPLAY, rows, |i, _| {
            display_errors[i].map(|(_, error_k)| error_k * 1e3)
        }),
    ];
    let current = [curve("current (positive cools)", CURRENT, rows, |_, row| Some(row.current_a))];
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let (upper, rest) = root.split_vertically(430);
        let (middle, lower) = rest.split_vertically(330);
        let panel = |y_name| Panel {
            x: 0.0..scene.duration_s,
            x_name: "time / s",
            y_name,
            legend: Legend::Inside,
        };
        panel("temperature / °C").draw(&upper, &temperatures)?;
        panel("error in contact / mK").draw(&middle, &errors)?;
        panel("current / A").draw(&lower, &current)?;
        root.present()?;
    }
    Ok(svg)
}
