//! The participant's view.

use std::time::Duration;

use egui::text::LayoutJob;
use egui::{
    Align, Align2, Color32, FontId, Painter, Pos2, Rect, RichText, Sense, Shape, Stroke, Ui, pos2,
    vec2,
};
use thermal_session::{AnswerKind, Cue, Question, Response};

use super::force::force;
use crate::entry::NumberEntry;
use crate::participant::{ParticipantView, ShownCue};
use crate::texts;

/// How long a tone brightens its symbol, as long as it sounds.
const FLASH: Duration = Duration::from_millis(200);
const CALM: Color32 = Color32::from_rgb(0x9F, 0xC5, 0xD8);
const BRIGHT: Color32 = Color32::from_rgb(0xFF, 0xE0, 0x8A);
const BUTTON: Color32 = Color32::from_rgb(0x34, 0x40, 0x48);
const CHOSEN: Color32 = Color32::from_rgb(0x2C, 0x5F, 0x7D);
/// Width of a column of text that is read without moving the head, of the font's height.
const COLUMN_EM: f32 = 26.0;

/// Draws the view; returns the answer that was clicked, or confirmed with the mouse.
pub fn participant(
    ui: &mut Ui,
    view: &ParticipantView,
    entry: Option<&mut NumberEntry>,
    now: Duration,
) -> Option<Response> {
    let size = (ui.available_height() / 16.0).clamp(18.0, 72.0);
    if let Some(follow) = &view.follow {
        force(ui, follow, now);
        return None;
    }
    if view.waits {
        centred(ui, "Please wait", size);
        return None;
    }
    if let Some(question) = view.question.as_ref() {
        return if view.answered {
            centred(ui, "Thank you", size);
            None
        } else {
            ask(ui, question, entry, &view.stations, size)
        };
    }
    match (view.cue, &view.instruction) {
        (_, Some(text)) => centred(ui, text, size * 0.8),
        (Some(cue), None) => show_cue(ui, cue, now, size),
        (None, None) => centred(ui, texts::participant_phase(view.phase), size),
    }
    None
}

fn centred(ui: &mut Ui, text: &str, size: f32) {
    let rect = ui.available_rect_before_wrap();
    let width = rect.width().min(COLUMN_EM * size) - 2.0 * size;
    let colour = ui.visuals().text_color();
    let font = FontId::proportional(size);
    let mut job = LayoutJob::simple(text.into(), font, colour, width.max(size));
    job.halign = Align::Center;
    let galley = ui.painter().layout_job(job);
    // With that alignment the galley's origin is the middle of its upper edge.
    let at = rect.center() - vec2(0.0, galley.size().y / 2.0);
    ui.painter().galley(at, galley, colour);
}

fn show_cue(ui: &mut Ui, shown: ShownCue, now: Duration, size: f32) {
    let rect = ui.available_rect_before_wrap();
    let flashes = now.saturating_sub(shown.at) < FLASH;
    let colour = if flashes { BRIGHT } else { CALM };
    let radius = rect.height() * 0.16;
    let centre = rect.center() - vec2(0.0, rect.height() * 0.08);
    let painter = ui.painter();
    painter.circle_stroke(centre, radius * 1.35, Stroke::new(radius * 0.07, colour));
    symbol(painter, shown.cue, centre, radius, colour);
    let below = pos2(rect.center().x, centre.y + radius * 1.35 + size);
    let font = FontId::proportional(size * 1.3);
    painter.text(below, Align2::CENTER_TOP, texts::cue(shown.cue), font, colour);
}

/// Arrows: along above the stimuli, down onto them, up from them; an interval has its number.
fn symbol(painter: &Painter, cue: Cue, centre: Pos2, radius: f32, colour: Color32) {
    let stroke = Stroke::new(radius * 0.16, colour);
    let arrow = |direction: egui::Vec2| {
        let tip = centre + direction * radius * 0.8;
        let side = direction.rot90() * radius * 0.4;
        let back = direction * radius * 0.45;
        painter.line_segment(
            [centre - direction * radius * 0.8, tip - direction * radius * 0.2],
            stroke,
        );
        let head = vec![tip, tip - back + side, tip - back - side];
        painter.add(Shape::convex_polygon(head, colour, Stroke::NONE));
    };
    match cue {
        Cue::Reach => arrow(vec2(1.0, 0.0)),
        Cue::Touch => arrow(vec2(0.0, 1.0)),
        Cue::Lift => arrow(vec2(0.0, -1.0)),
        Cue::Interval(index) => {
            let number = (u16::from(index) + 1).to_string();
            painter.text(
                centre,
                Align2::CENTER_CENTER,
                number,
                FontId::proportional(radius * 1.4),
                colour,
            );
        }
    }
}

fn ask(
    ui: &mut Ui,
    question: &Question,
    entry: Option<&mut NumberEntry>,
    stations: &[String],
    size: f32,
) -> Option<Response> {
    let rect = ui.available_rect_before_wrap();
    let title =
        Rect::from_min_max(rect.left_top(), pos2(rect.right(), rect.top() + rect.height() * 0.34));
    let mut upper = ui.new_child(egui::UiBuilder::new().max_rect(title));
    centred(&mut upper, &question.ask, size);
    let lower = Rect::from_min_max(title.left_bottom(), rect.right_bottom())
        .shrink2(vec2(rect.width() * 0.06, 0.0));
    let mut lower_ui = ui.new_child(egui::UiBuilder::new().max_rect(lower));
    match &question.kind {
        AnswerKind::OneOf(words) => choose(&mut lower_ui, words, size),
        AnswerKind::NumberPerStation(..) => numbers(&mut lower_ui, entry?, stations, size),
    }
}

/// A button for each answer: two or three beside each other, more below each other in columns.
fn choose(ui: &mut Ui, words: &[String], size: f32) -> Option<Response> {
    let rect = ui.available_rect_before_wrap();
    let columns = words.len().clamp(1, 3);
    let rows = words.len().div_ceil(columns).max(1);
    let gap = size * 0.5;
    let width = (rect.width() - gap * (columns - 1) as f32) / columns as f32;
    let height = ((rect.height() - gap * rows as f32) / rows as f32).min(size * 3.4);
    let mut chosen = None;
    for (index, word) in words.iter().enumerate() {
        let (column, row) = ((index % columns) as f32, (index / columns) as f32);
        let corner = rect.left_top() + vec2(column * (width + gap), row * (height + gap));
        let place = Rect::from_min_size(corner, vec2(width, height));
        let text = RichText::new(word).size(size);
        let button = egui::Button::new(text).fill(BUTTON).corner_radius(10.0);
        if ui.put(place, button).clicked() {
            chosen = Some(Response::Choice(index));
        }
        if index < 9 {
            let cap = place.left_top() + vec2(size * 0.45, size * 0.35);
            let font = FontId::proportional(size * 0.6);
            ui.painter().text(cap, Align2::LEFT_TOP, index + 1, font, CALM);
            let beside = cap + vec2(size * 0.8, size * 0.38);
            let of_two = (words.len() == 2).then_some(index);
            key_arrow(ui.painter(), word, of_two, beside, size);
        }
    }
    chosen
}

/// The arrow key of an answer that has one. It is drawn, because the font has no arrows.
fn key_arrow(painter: &Painter, word: &str, of_two: Option<usize>, at: Pos2, size: f32) {
    let length = vec2(size * 0.7, 0.0);
    let stroke = Stroke::new(size * 0.06, CALM);
    match (word.to_lowercase().as_str(), of_two) {
        ("left", _) => painter.arrow(at + length, -length, stroke),
        ("right", _) => painter.arrow(at, length, stroke),
        (_, Some(0)) => painter.arrow(at + length, -length, stroke),
        (_, Some(_)) => painter.arrow(at, length, stroke),
        (_, None) => {}
    }
}

/// A line for each station: its name, a scale, the number.
fn numbers(
    ui: &mut Ui,
    entry: &mut NumberEntry,
    stations: &[String],
    size: f32,
) -> Option<Response> {
    let width = ui.available_width();
    for station in 0..entry.texts().len() {
        let is_chosen = station == entry.station();
        let (line, response) = ui.allocate_exact_size(vec2(width, size * 1.9), Sense::click());
        if response.clicked() {
            entry.choose(station);
        }
        ui.painter().rect_filled(line, 10.0, if is_chosen { CHOSEN } else { BUTTON });
        let name = stations.get(station).map_or("", String::as_str);
        text(ui, line.left_center() + vec2(size * 0.5, 0.0), Align2::LEFT_CENTER, name, size * 0.8);
        let text_of = entry.texts().get(station).map_or("", String::as_str);
        let shown = if is_chosen { format!("{text_of}_") } else { text_of.to_owned() };
        text(
            ui,
            line.right_center() - vec2(size * 0.5, 0.0),
            Align2::RIGHT_CENTER,
            &shown,
            size * 0.9,
        );
        let left = pos2(line.left() + width * 0.25, line.center().y - size * 0.22);
        let bar = Rect::from_min_size(left, vec2(width * 0.55, size * 0.44));
        scale(ui, entry, station, bar);
        ui.add_space(size * 0.1);
    }
    ui.add_space(size * 0.3);
    let button =
        egui::Button::new(RichText::new("Enter").size(size * 0.8)).fill(BUTTON).corner_radius(10.0);
    let clicked = ui.horizontal(|ui| {
        let is_complete = entry.response().is_some();
        let clicked = ui.add_enabled(is_complete, button).clicked();
        let (least, most) = entry.range();
        let hint = format!("numbers from {least} to {most}; arrows up and down choose the line");
        ui.label(RichText::new(hint).size(size * 0.45).color(CALM));
        clicked
    });
    if clicked.inner { entry.response() } else { None }
}

/// A scale to click and drag on. It has no mark until there is a number, because a mark would suggest one.
fn scale(ui: &mut Ui, entry: &mut NumberEntry, station: usize, bar: Rect) {
    let (least, most) = entry.range();
    let response = ui.interact(bar, ui.id().with(("scale", station)), Sense::click_and_drag());
    if let Some(pointer) = response.interact_pointer_pos() {
        let share = f64::from((pointer.x - bar.left()) / bar.width()).clamp(0.0, 1.0);
        entry.choose(station);
        entry.set(station, least + share * (most - least));
    }
    let painter = ui.painter();
    painter.rect_filled(bar, bar.height() / 2.0, Color32::from_rgb(0x14, 0x18, 0x1B));
    if let Some(value) = entry.value(station) {
        let share = ((value - least) / (most - least)) as f32;
        let x = bar.left() + share * bar.width();
        let filled = Rect::from_min_max(bar.left_top(), pos2(x, bar.bottom()));
        painter.rect_filled(filled, bar.height() / 2.0, CALM);
        painter.circle_filled(pos2(x, bar.center().y), bar.height() * 0.9, CALM);
    }
}

fn text(ui: &Ui, at: Pos2, align: Align2, text: &str, size: f32) {
    let colour = ui.visuals().text_color();
    ui.painter().text(at, align, text, FontId::proportional(size), colour);
}
