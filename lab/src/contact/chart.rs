//! Chart of resistance over force.

use contact_law_fit::{Fit, Recording};
use contact_model::contact_law::ContactLaw;
use contact_model::material::SKIN;
use contact_model::pressure::pressure_pa;
use contact_model::reference::conductance_at_hardness;
use plotters::prelude::*;

use super::Report;

const SIZE: (u32, u32) = (640, 420);
const FONT: (&str, i32) = ("sans-serif", 15);
const MARGIN: u32 = 14;
/// Forces of the axis, N, and points of a curve.
const FORCES_N: std::ops::Range<f64> = 0.08..2.5;
const POINTS: usize = 60;
const FITTED: RGBColor = RGBColor(0x1f, 0x77, 0xb4);
const EQUATION: RGBColor = RGBColor(0xe3, 0x77, 0x00);

impl Report {
    /// Resistance over force with its intervals, and Eq. 6-8, as an SVG document.
    ///
    /// # Errors
    /// The chart cannot be drawn.
    pub fn chart(&self, recording: &Recording, fit: &Fit) -> anyhow::Result<String> {
        let at_hardness_w_m2k = conductance_at_hardness::<f64>(&SKIN.surface, &recording.display);
        let curve = |law: ContactLaw| -> Vec<(f64, f64)> {
            let ratio = FORCES_N.end / FORCES_N.start;
            let point = |i: usize| {
                let force_n = FORCES_N.start * ratio.powf(i as f64 / (POINTS - 1) as f64);
                let conductance = law.conductance_w_m2k(at_hardness_w_m2k, pressure_pa(force_n));
                (force_n, 1e6 / conductance)
            };
            (0..POINTS).map(point).collect()
        };
        let (fitted, equation) = (curve(fit.law), curve(ContactLaw::NOMINAL));
        let ends = self.resistance.iter().flat_map(|one| one.m2k_w_95);
        let values = fitted.iter().chain(&equation).map(|(_, value)| *value);
        let values = values.chain(ends.map(|end| 1e6 * end));
        let (low, high) = values
            .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        let mut svg = String::new();
        {
            let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
            root.fill(&WHITE)?;
            let mut chart = ChartBuilder::on(&root)
                .margin(MARGIN)
                .margin_right(2 * MARGIN)
                .caption(format!("contact resistance of {}", self.code), FONT)
                .x_label_area_size(38)
                .y_label_area_size(64)
                .build_cartesian_2d(FORCES_N.log_scale(), (0.8 * low..1.25 * high).log_scale())?;
            chart
                .configure_mesh()
                .x_desc("force / N")
                .y_desc("R / (1e-6 m\u{b2} K/W)")
                .x_label_formatter(&|force_n| label(*force_n, 1))
                .y_label_formatter(&|value| label(*value, 0))
                .light_line_style(TRANSPARENT)
                .label_style(FONT)
                .draw()?;
            chart
                .draw_series(DashedLineSeries::new(equation, 7, 5, EQUATION.stroke_width(2)))?
                .label("Eq. 6-8")
                .legend(|(x, y)| PathElement::new([(x, y), (x + 20, y)], EQUATION.stroke_width(2)));
            chart
                .draw_series(LineSeries::new(fitted, FITTED.stroke_width(2)))?
                .label("this finger, 95 %")
                .legend(|(x, y)| PathElement::new([(x, y), (x + 20, y)], FITTED.stroke_width(2)));
            chart.draw_series(self.resistance.iter().map(|one| {
                let ends = one.m2k_w_95.map(|end| (one.force_n, 1e6 * end));
                PathElement::new(ends, FITTED.stroke_width(4))
            }))?;
            chart.draw_series(
                self.resistance
                    .iter()
                    .map(|one| Circle::new((one.force_n, 1e6 * one.m2k_w), 4, FITTED.filled())),
            )?;
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.3))
                .label_font(FONT)
                .draw()?;
            root.present()?;
        }
        Ok(svg)
    }
}

/// A label of a logarithmic axis; none but those that begin with 1, 2 or 5, which leave each other room.
fn label(value: f64, decimals: usize) -> String {
    let decade = 10_f64.powf(value.log10().floor());
    let digit = (value / decade).round() as u32;
    if matches!(digit, 1 | 2 | 5 | 10) { format!("{value:.decimals$}") } else { String::new() }
}
