//! The operator's view.

use std::time::Duration;

use egui::{Align, Color32, Frame, Layout, Panel, RichText, ScrollArea, Ui, vec2};
use thermal_client::fault_words;
use thermal_device::StateName;

use super::plots::plots;
use super::session_panel::panel;
use super::theme::{AMBER, RED, colours};
use crate::keys::Action;
use crate::link_quality::ScreenLatency;
use crate::model::{FingerView, Model};
use crate::texts;

/// Silence of the device after which its state is not known any more.
const SILENT: Duration = Duration::from_secs(1);

/// What the operator has chosen to see.
#[derive(Clone, Debug, Default)]
pub struct OperatorState {
    /// Finger whose lines are drawn.
    pub finger: u8,
    /// Dark or light.
    pub dark: bool,
    /// What was measured of the frames so far.
    pub latency: ScreenLatency,
}

impl OperatorState {
    /// Shows the next finger that the device has.
    pub fn next_finger(&mut self, model: &Model) {
        let mut fingers = model.fingers().keys();
        let next = fingers.find(|finger| **finger > self.finger);
        let first = model.fingers().keys().next();
        self.finger = next.or(first).copied().unwrap_or(0);
    }

    fn view<'a>(&self, model: &'a Model) -> Option<&'a FingerView> {
        let chosen = model.fingers().get(&self.finger);
        chosen.or_else(|| model.fingers().values().next())
    }
}

/// Draws the view; returns what was clicked.
pub fn operator(
    ui: &mut Ui,
    model: &Model,
    state: &mut OperatorState,
    now: Duration,
) -> Vec<Action> {
    let mut actions = Vec::new();
    Panel::top("device").show(ui, |ui| header(ui, model, state, now, &mut actions));
    Panel::bottom("log").resizable(false).show(ui, |ui| log(ui, model, state, now, &mut actions));
    if let Some(fault) = tripped(model) {
        Panel::top("fault").frame(banner(RED)).show(ui, |ui| {
            let words = fault_words(fault);
            let title = format!("Tripped by `{}`: {}.", fault.name(), words.meaning);
            ui.label(RichText::new(title).strong().size(18.0).color(Color32::WHITE));
            ui.label(RichText::new(format!("What to do: {}.", words.remedy)).color(Color32::WHITE));
        });
    }
    if model.question().is_some() {
        Panel::top("question")
            .frame(banner(AMBER))
            .show(ui, |ui| question(ui, model, &mut actions));
    }
    Panel::left("session").exact_size(330.0).resizable(false).show(ui, |ui| {
        ScrollArea::vertical().show(ui, |ui| {
            ui.add_space(4.0);
            panel(ui, model, now, &mut actions);
        });
    });
    egui::CentralPanel::default().show(ui, |ui| match state.view(model) {
        Some(view) => {
            plots(ui, view, model.participant().follow.as_ref().map(|follow| follow.target_n))
        }
        None => {
            ui.centered_and_justified(|ui| ui.label("No telemetry yet"));
        }
    });
    actions
}

/// The fault of the first finger that is tripped.
fn tripped(model: &Model) -> Option<thermal_device::safety::Fault> {
    model.fingers().values().find_map(|view| view.last.fault())
}

fn banner(fill: Color32) -> Frame {
    Frame::new().fill(fill).inner_margin(10.0)
}

fn header(
    ui: &mut Ui,
    model: &Model,
    state: &mut OperatorState,
    now: Duration,
    actions: &mut Vec<Action>,
) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            stop(ui, model, actions);
            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                let title = model.session().map_or("Monitor", |session| session.title.as_str());
                ui.label(RichText::new(title).heading());
                device(ui, model, state, now);
                ui.label(RichText::new(texts::EMERGENCY_STOP).small());
            });
        });
    });
    ui.add_space(2.0);
}

fn stop(ui: &mut Ui, model: &Model, actions: &mut Vec<Action>) {
    let text = if model.is_stopped() { "STOPPING" } else { "STOP [Esc]" };
    let label =
        RichText::new(format!("{text}\nbridge off")).size(24.0).strong().color(Color32::WHITE);
    let button = egui::Button::new(label).fill(RED).corner_radius(8.0);
    if ui.add_sized(vec2(200.0, 84.0), button).clicked() {
        actions.push(Action::Stop);
    }
}

/// State of the shown finger in words, and the choice of the finger if there are several.
fn device(ui: &mut Ui, model: &Model, state: &mut OperatorState, now: Duration) {
    let colours = colours(ui.visuals().dark_mode);
    ui.horizontal(|ui| {
        let silent = model.link().silent_for(now).filter(|silent| *silent >= SILENT);
        match (state.view(model), silent) {
            (_, Some(_)) if model.end().is_some() => {
                ui.label(RichText::new("Not connected any more.").strong());
            }
            (_, Some(silent)) => {
                let text = format!(
                    "No telemetry for {:.0} s: the state of the device is not known.",
                    silent.as_secs_f64()
                );
                ui.label(RichText::new(text).strong().color(colours.alarm));
            }
            (None, None) => {
                ui.label("Waiting for the device.");
            }
            (Some(view), None) => {
                let (word, meaning) = texts::state(view.last.state);
                let colour = match view.last.state {
                    StateName::Tripped(_) => colours.alarm,
                    driven if driven.is_driven() => colours.warning,
                    _ => colours.good,
                };
                ui.label(RichText::new(word).heading().strong().color(colour));
                ui.label(meaning);
                let warning = match view.last {
                    last if last.limited => Some("set-point limited to its range"),
                    last if last.is_untuned => Some("tile not tuned: send tune"),
                    _ => None,
                };
                if let Some(warning) = warning {
                    ui.label(RichText::new(warning).color(colours.warning));
                }
            }
        }
    });
    if model.fingers().len() > 1 {
        ui.horizontal(|ui| {
            ui.label("finger [F]");
            for (finger, view) in model.fingers() {
                let text = format!("{finger} {}", view.last.state.name());
                if ui.selectable_label(state.finger == *finger, text).clicked() {
                    state.finger = *finger;
                }
            }
        });
    }
}

fn question(ui: &mut Ui, model: &Model, actions: &mut Vec<Action>) {
    let Some(question) = model.question() else {
        return;
    };
    let (title, text) = texts::question(question);
    ui.label(RichText::new(title).heading().strong().color(Color32::BLACK));
    ui.label(RichText::new(text).color(Color32::BLACK));
    ui.horizontal(|ui| {
        for choice in texts::choices(question) {
            let label = format!("{}   [{}]", choice.label, texts::key_cap(choice.key));
            let button = egui::Button::new(RichText::new(label).strong().color(Color32::BLACK));
            if ui.add(button.fill(Color32::from_rgb(0xFF, 0xF3, 0xD6))).clicked() {
                actions.push(Action::Decide(choice.decision));
            }
        }
    });
}

fn log(
    ui: &mut Ui,
    model: &Model,
    state: &OperatorState,
    now: Duration,
    actions: &mut Vec<Action>,
) {
    let colours = colours(ui.visuals().dark_mode);
    ui.add_space(2.0);
    let height = ui.text_style_height(&egui::TextStyle::Body) * 4.6;
    ScrollArea::vertical()
        .max_height(height)
        .min_scrolled_height(height)
        .auto_shrink(false)
        .stick_to_bottom(true)
        .show(ui, |ui| {
            for notice in model.notices() {
                let ago = notice.at.as_secs();
                ui.label(format!("{:02}:{:02}  {}", ago / 60, ago % 60, notice.text));
            }
        });
    ui.separator();
    ui.horizontal(|ui| {
        let link = model.link();
        let lost = format!("lines {}, lost {}", link.received, link.lost);
        let recent =
            link.lost_at.is_some_and(|at| now.saturating_sub(at) < Duration::from_secs(10));
        ui.label(RichText::new(lost).color(if recent {
            colours.alarm
        } else {
            ui.visuals().text_color()
        }));
        if let Some(median_ms) = state.latency.percentile_ms(50) {
            ui.label(format!(
                "on screen within {median_ms} ms (median), {} ms (95 %)",
                state.latency.percentile_ms(95).unwrap_or(median_ms)
            ));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.small_button("light, dark [L]").clicked() {
                actions.push(Action::Theme);
            }
            if model.session().is_some()
                && ui.small_button("participant full screen [F11]").clicked()
            {
                actions.push(Action::FullScreen);
            }
        });
    });
    ui.add_space(4.0);
}
