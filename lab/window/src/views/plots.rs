//! The last 20 s of a finger as lines.

use egui::{Color32, RichText, Sense, Stroke, Ui, vec2};
use egui_plot::{Line, LineStyle, Plot, PlotBounds, PlotPoints, uniform_grid_spacer};
use thermal_client::client::Telemetry;

use super::theme::{Colours, colours};
use crate::model::FingerView;
use crate::trace::TRACE_S;

/// Most points of a line; a window is not wider.
const POINTS_MAX: usize = 1200;

/// A quantity of a plot.
struct Quantity {
    name: &'static str,
    colour: Color32,
    /// What another quantity follows, drawn broad below it, so that both are seen where they agree.
    followed: bool,
    of: fn(&Telemetry) -> Option<f64>,
}

impl Quantity {
    const fn width(&self) -> f32 {
        if self.followed { 5.0 } else { 2.0 }
    }
}

/// A piece of the line before its name.
fn swatch(ui: &mut Ui, quantity: &Quantity) {
    let (rect, _) = ui.allocate_exact_size(vec2(26.0, 12.0), Sense::hover());
    let stroke = Stroke::new(quantity.width(), quantity.colour);
    ui.painter().hline(rect.x_range(), rect.center().y, stroke);
}

/// A plot: unit, digits of its values, smallest height of its range.
struct Frame {
    title: &'static str,
    unit: &'static str,
    digits: usize,
    range_min: f64,
    from_zero: bool,
}

/// Draws temperatures, force and current below each other.
pub(super) fn plots(ui: &mut Ui, view: &FingerView, target_n: Option<f64>) {
    let colours = colours(ui.visuals().dark_mode);
    let height = ui.available_height();
    temperatures(ui, view, &colours, height * 0.5);
    force(ui, view, &colours, target_n, height * 0.24);
    current(ui, view, &colours, height * 0.26);
}

fn temperatures(ui: &mut Ui, view: &FingerView, colours: &Colours, height: f32) {
    let quantities = [
        Quantity {
            name: "set-point",
            colour: colours.setpoint,
            followed: true,
            of: |sample| sample.setpoint_c,
        },
        Quantity {
            name: "display",
            colour: colours.display,
            followed: false,
            of: |sample| sample.display_c,
        },
        Quantity {
            name: "skin",
            colour: colours.skin,
            followed: false,
            of: |sample| sample.skin_c,
        },
    ];
    let frame =
        Frame { title: "temperature", unit: "°C", digits: 2, range_min: 2.0, from_zero: false };
    plot(ui, view, &frame, &quantities, None, height);
}

fn force(ui: &mut Ui, view: &FingerView, colours: &Colours, target_n: Option<f64>, height: f32) {
    let quantities = [Quantity {
        name: "force",
        colour: colours.force,
        followed: false,
        of: |sample| sample.force_n,
    }];
    let frame = Frame { title: "force", unit: "N", digits: 2, range_min: 1.0, from_zero: true };
    plot(ui, view, &frame, &quantities, target_n, height);
}

fn current(ui: &mut Ui, view: &FingerView, colours: &Colours, height: f32) {
    let quantities = [
        Quantity {
            name: "demanded",
            colour: colours.demand,
            followed: true,
            of: |sample| sample.demand_a,
        },
        Quantity {
            name: "measured",
            colour: colours.current,
            followed: false,
            of: signed_current_a,
        },
    ];
    let frame = Frame {
        title: "current, positive cools",
        unit: "A",
        digits: 2,
        range_min: 2.0,
        from_zero: false,
    };
    plot(ui, view, &frame, &quantities, None, height);
}

/// Measured current with the sign of the demanded one, A; a demand that is not known says nothing about the direction.
fn signed_current_a(line: &Telemetry) -> Option<f64> {
    let sign = if line.demand_a.is_some_and(|demand_a| demand_a < 0.0) { -1.0 } else { 1.0 };
    line.current_a.map(|current_a| sign * current_a)
}

fn plot(
    ui: &mut Ui,
    view: &FingerView,
    frame: &Frame,
    quantities: &[Quantity],
    target: Option<f64>,
    height: f32,
) {
    let top = ui.cursor().top();
    ui.horizontal(|ui| {
        ui.label(RichText::new(frame.title).strong());
        for quantity in quantities {
            let now = (quantity.of)(&view.last)
                .map_or("unknown".into(), |now| format!("{now:.*} {}", frame.digits, frame.unit));
            swatch(ui, quantity);
            ui.label(format!("{} {now}", quantity.name));
        }
        if let Some(target) = target {
            ui.label(format!("- - target {target:.2} {}", frame.unit));
        }
    });
    let height = (height - (ui.cursor().top() - top) - ui.spacing().item_spacing.y).max(40.0);
    let (least, most) = range(view, frame, quantities, target);
    let is_last = frame.unit == "A";
    Plot::new(frame.title)
        .height(height)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .allow_axis_zoom_drag(false)
        .show_x(false)
        .show_y(false)
        .y_axis_min_width(44.0)
        .grid_color(ui.visuals().weak_text_color().gamma_multiply(0.45))
        .grid_fade(0.2)
        .x_grid_spacer(uniform_grid_spacer(|_| [20.0, 5.0, 5.0]))
        .x_axis_formatter(
            move |mark, _| {
                if is_last { format!("{:.0} s", mark.value) } else { String::new() }
            },
        )
        .show(ui, |plot_ui| {
            plot_ui.set_plot_bounds(PlotBounds::from_min_max([-TRACE_S, least], [0.0, most]));
            for quantity in quantities {
                for points in segments(view, quantity.of) {
                    let line = Line::new(quantity.name, points).color(quantity.colour);
                    plot_ui.line(line.width(quantity.width()));
                }
            }
            if let Some(target) = target {
                let points = PlotPoints::from(vec![[-TRACE_S, target], [0.0, target]]);
                plot_ui.line(Line::new("target", points).style(LineStyle::dashed_dense()));
            }
        });
}

/// Runs of points that are known.
fn segments(view: &FingerView, of: fn(&Telemetry) -> Option<f64>) -> Vec<PlotPoints<'static>> {
    let step = view.trace.samples().count().div_ceil(POINTS_MAX).max(1);
    let mut runs: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
    for sample in view.trace.samples() {
        // By the tick, so that a point stays or goes for good and the line does not shimmer as it moves.
        if !(sample.tick / 5).is_multiple_of(step as u32) {
            continue;
        }
        match (of(sample), runs.last_mut()) {
            (Some(value), Some(run)) => run.push([-view.trace.age_s(sample), value]),
            (None, Some(run)) if !run.is_empty() => runs.push(Vec::new()),
            _ => {}
        }
    }
    runs.into_iter().filter(|run| !run.is_empty()).map(PlotPoints::from).collect()
}

/// A range that holds all values and moves in steps, so that the eye has something to hold on to.
fn range(
    view: &FingerView,
    frame: &Frame,
    quantities: &[Quantity],
    target: Option<f64>,
) -> (f64, f64) {
    let samples = view.trace.samples();
    let values =
        samples.flat_map(|sample| quantities.iter().filter_map(|quantity| (quantity.of)(sample)));
    let values = values.chain(target).chain(frame.from_zero.then_some(0.0));
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
        (least.min(value), most.max(value))
    });
    if least > most {
        return (0.0, frame.range_min);
    }
    let step = frame.range_min / 2.0;
    let margin = 0.05 * (most - least).max(frame.range_min);
    let least = ((least - if frame.from_zero { 0.0 } else { margin }) / step).floor() * step;
    let most = ((most + margin) / step).ceil() * step;
    (least, most.max(least + frame.range_min))
}
