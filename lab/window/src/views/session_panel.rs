//! Phase, trial, gate and placement of a session; orders of a monitored device.

use std::time::Duration;

use egui::{ProgressBar, RichText, Ui};

use super::theme::colours;
use crate::gate::Gate;
use crate::keys::Action;
use crate::model::{End, Model};
use crate::monitor::Order;
use crate::texts;

/// Draws the panel of a session or of a monitored device.
pub(super) fn panel(ui: &mut Ui, model: &Model, now: Duration, actions: &mut Vec<Action>) {
    if model.session().is_some() {
        session(ui, model, now);
    } else {
        orders(ui, actions);
    }
    readings(ui, model);
}

fn session(ui: &mut Ui, model: &Model, now: Duration) {
    let colours = colours(ui.visuals().dark_mode);
    match model.end() {
        Some(End::Completed) => {
            ui.label(RichText::new("Session completed").heading().color(colours.good));
        }
        Some(End::Broken(reason)) => {
            ui.label(RichText::new("Session ended").heading().color(colours.alarm));
            ui.label(reason);
        }
        None => {}
    }
    if let (None, Some(session)) = (model.trial(), model.session()) {
        for warning in &session.warnings {
            ui.label(RichText::new(warning).color(colours.warning));
        }
    }
    if let Some(view) = model.trial() {
        let trial = &view.trial;
        ui.label(RichText::new(format!("Trial {} of {}", trial.number, view.of)).heading());
        let mut parts = vec![format!("block {}", trial.block)];
        if !trial.part.is_empty() {
            parts.insert(0, format!("part {}", trial.part));
        }
        if view.attempt > 1 {
            parts.push(format!("attempt {}", view.attempt));
        }
        ui.label(parts.join(", "));
        let done = trial.number.saturating_sub(1) as f32 / view.of.max(1) as f32;
        ui.add(ProgressBar::new(done).desired_height(8.0));
    }
    let running = model.phase().filter(|_| model.end().is_none());
    if let Some((phase, since)) = running {
        ui.separator();
        let passed = now.saturating_sub(since).as_secs_f64();
        ui.horizontal(|ui| {
            ui.label(RichText::new(phase.name().to_uppercase()).heading());
            ui.label(format!("for {passed:.0} s"));
        });
        ui.label(texts::phase(phase));
    }
    if let Some(gate) = model.gate(now) {
        show_gate(ui, &gate);
    }
    let placement = model.placement();
    if !placement.is_empty() && model.end().is_none() {
        ui.separator();
        ui.label(RichText::new("What goes where").strong());
        for line in placement {
            ui.label(line);
        }
    }
}

fn show_gate(ui: &mut Ui, gate: &Gate) {
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(gate.what).strong());
        if let Some((left, then)) = gate.left {
            ui.label(format!("{:.0} s left, {then}", left.as_secs_f64().ceil()));
        }
    });
    ui.add(ProgressBar::new(gate.reached).desired_height(10.0));
    if let Some(value) = &gate.value {
        ui.label(value);
    }
}

fn orders(ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.label(RichText::new("Orders").heading());
    for order in Order::ALL {
        let what = match order {
            Order::Arm => "Arm",
            Order::Clear => "Clear the fault",
            Order::Off => "Bridge off",
        };
        let text = format!("{what}   [{}]", texts::key_cap(order.key()));
        let hint = match order {
            Order::Arm => "self-test if it was not passed yet, then skin temperature",
            Order::Clear => "refused while the fault is present",
            Order::Off => "",
        };
        if ui.add_sized([300.0, 40.0], egui::Button::new(text)).on_hover_text(hint).clicked() {
            actions.push(Action::Order(order));
        }
    }
}

fn readings(ui: &mut Ui, model: &Model) {
    if model.fingers().is_empty() {
        return;
    }
    ui.separator();
    ui.label(RichText::new("Readings").strong());
    egui::Grid::new("readings").num_columns(3).striped(true).show(ui, |ui| {
        ui.label("finger");
        ui.label("sink, °C");
        ui.label("room, °C");
        ui.end_row();
        for (finger, view) in model.fingers() {
            let number =
                |value: Option<f64>| value.map_or("unknown".into(), |value| format!("{value:.2}"));
            ui.label(format!("{finger}"));
            ui.label(number(view.last.sink_c));
            ui.label(number(view.last.room_c));
            ui.end_row();
        }
    });
}
