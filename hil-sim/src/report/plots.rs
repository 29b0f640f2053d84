//! Temperatures, current and errors over time.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::metrics::contact_times;
use crate::run::Outcome;
use crate::scene::Scene;
use crate::trace::Row;

const SIZE: (u32, u32) = (1000, 1050);
/// Points of a curve; more cannot be told apart.
const POINTS: usize = 1500;

const SKIN: RGBColor = RGBColor(0xd6, 0x27, 0x28);
const REAL: RGBColor = RGBColor(0x22, 0x22, 0x22);
const DISPLAY: RGBColor = RGBColor(0x1f, 0x77, 0xb4);
const SETPOINT: RGBColor = RGBColor(0x2c, 0xa0, 0x2c);
const CURRENT: RGBColor = RGBColor(0x94, 0x67, 0xbd);

struct Curve {
    name: &'static str,
    color: RGBColor,
    width: u32,
    points: Vec<(f64, f64)>,
}

impl Curve {
    fn new(
        name: &'static str,
        color: RGBColor,
        rows: &[Row],
        value: impl Fn(usize, &Row) -> Option<f64>,
    ) -> Self {
        let every = rows.len().div_ceil(POINTS).max(1);
        let points = rows.iter().enumerate().step_by(every);
        Self {
            name,
            color,
            // The real skin's curve lies on it.
            width: if color == SKIN { 4 } else { 2 },
            points: points
                .filter_map(|(i, row)| Some((row.t_s, value(i, row)?)))
                .collect(),
        }
    }
}

/// The plots of a run as one SVG document.
///
/// # Errors
/// The plot cannot be drawn.
pub(super) fn draw(scene: &Scene, outcome: &Outcome) -> anyhow::Result<String> {
    let rows = outcome.trace.rows();
    let contacts = contact_times(scene, outcome);
    let temperatures = [
        Curve::new("skin on the display", SKIN, rows, |_, row| Some(row.skin_c)),
        Curve::new("skin on the real object", REAL, rows, |_, row| {
            Some(row.skin_real_c)
        }),
        Curve::new("display", DISPLAY, rows, |_, row| Some(row.display_c)),
        Curve::new("set-point", SETPOINT, rows, |_, row| {
            row.device.as_ref()?.setpoint_c
        }),
    ];
    let errors = [
        Curve::new("skin minus skin on the real object", SKIN, rows, |i, row| {
            contacts[i].map(|_| (row.skin_c - row.skin_real_c) * 1e3)
        }),
        Curve::new("display minus exact set-point", DISPLAY, rows, |i, row| {
            contacts[i].map(|since_s| (row.display_c - scene.exact_setpoint_c(since_s, row.force_n)) * 1e3)
        }),
    ];
    let current = [Curve::new("current (positive cools)", CURRENT, rows, |_, row| {
        Some(row.current_a)
    })];
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let (upper, rest) = root.split_vertically(430);
        let (middle, lower) = rest.split_vertically(330);
        panel(&upper, scene.duration_s, "temperature / C", &temperatures)?;
        panel(&middle, scene.duration_s, "error in contact / mK", &errors)?;
        panel(&lower, scene.duration_s, "current / A", &current)?;
        root.present()?;
    }
    Ok(svg)
}

fn panel(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    duration_s: f64,
    unit: &str,
    curves: &[Curve],
) -> anyhow::Result<()> {
    let values = || {
        curves
            .iter()
            .flat_map(|curve| curve.points.iter().map(|(_, value)| *value))
    };
    let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    let margin = ((high - low) * 0.08).max(0.05);
    let mut chart = ChartBuilder::on(area)
        .margin(14)
        .x_label_area_size(38)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..duration_s, low - margin..high + margin)?;
    chart
        .configure_mesh()
        .x_desc("time / s")
        .y_desc(unit)
        // Adding zero turns a negative zero into zero.
        .y_label_formatter(&|value| format!("{:.1}", (value * 10.0).round() / 10.0 + 0.0))
        .light_line_style(TRANSPARENT)
        .label_style(("sans-serif", 15))
        .draw()?;
    for curve in curves {
        let (color, width) = (curve.color, curve.width);
        chart
            .draw_series(LineSeries::new(
                curve.points.iter().copied(),
                color.stroke_width(width),
            ))?
            .label(curve.name)
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 22, y)], color.stroke_width(width)));
    }
    chart
        .configure_series_labels()
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 15))
        .position(SeriesLabelPosition::UpperRight)
        .draw()?;
    Ok(())
}
