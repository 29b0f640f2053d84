//! Matching a force: two lines, target and actual.

use std::time::Duration;

use egui::{Align2, Color32, FontId, Pos2, Rect, Shape, Stroke, Ui, pos2};

use crate::participant::Follow;

/// Time that the width of the picture shows, s.
const SHOWN_S: f64 = 10.0;
const TARGET: Color32 = Color32::from_rgb(0xF2, 0xB1, 0x34);
const ACTUAL: Color32 = Color32::from_rgb(0x56, 0xB4, 0xE9);
const EDGE: Color32 = Color32::from_rgb(0x50, 0x58, 0x5E);

/// Draws the lines; now is at the right of the middle, where the eye rests. There are no numbers.
pub(super) fn force(ui: &mut Ui, follow: &Follow, now: Duration) {
    let size = ui.available_size();
    let (response, painter) = ui.allocate_painter(size, egui::Sense::hover());
    let rect = response.rect.shrink2(egui::vec2(size.x * 0.04, size.y * 0.06));
    painter.rect_stroke(rect, 6.0, Stroke::new(1.0, EDGE), egui::StrokeKind::Inside);
    let right = rect.left() + rect.width() * 0.8;
    let y = |force_n: f64| {
        let share = (force_n / follow.range_n()).clamp(0.0, 1.0) as f32;
        rect.bottom() - share * rect.height()
    };
    let x = |at: Duration| {
        let age_s = now.saturating_sub(at).as_secs_f64();
        right - (age_s / SHOWN_S) as f32 * (right - rect.left())
    };
    let target_y = y(follow.target_n);
    let dashes = [pos2(rect.left(), target_y), pos2(rect.right(), target_y)];
    painter.extend(Shape::dashed_line(&dashes, Stroke::new(4.0, TARGET), 18.0, 10.0));
    let shown = follow.forces.iter().filter(|(at, _)| x(*at) >= rect.left());
    let points: Vec<Pos2> = shown.map(|(at, force_n)| pos2(x(*at), y(*force_n))).collect();
    if let Some(last) = points.last().copied() {
        painter.add(Shape::line(points, Stroke::new(5.0, ACTUAL)));
        painter.circle_filled(pos2(right, last.y), 12.0, ACTUAL);
    }
    let font = FontId::proportional((size.y * 0.045).clamp(16.0, 40.0));
    let label = Rect::from_min_max(rect.left_top(), rect.right_bottom()).shrink(10.0);
    let at = pos2(label.right(), target_y - 8.0);
    painter.text(at, Align2::RIGHT_BOTTOM, "target", font.clone(), TARGET);
    painter.text(label.right_bottom(), Align2::RIGHT_BOTTOM, "your force", font, ACTUAL);
}
