//! Colours and sizes. The colours of the lines are those of Okabe and Ito, which people tell apart who do not see all colours.

use egui::{Color32, Context, FontId, Style, TextStyle, Theme};

/// Colours of the operator's window.
#[derive(Clone, Copy, Debug)]
pub struct Colours {
    pub setpoint: Color32,
    pub display: Color32,
    pub skin: Color32,
    pub force: Color32,
    pub current: Color32,
    pub demand: Color32,
    pub warning: Color32,
    pub alarm: Color32,
    pub good: Color32,
}

/// Background of the stop, and of whatever is an alarm.
pub const RED: Color32 = Color32::from_rgb(0xC6, 0x1A, 0x1A);
/// Background of the operator's questions, with black text on it.
pub const AMBER: Color32 = Color32::from_rgb(0xF2, 0xB1, 0x34);

/// Colours for light or dark.
pub const fn colours(dark: bool) -> Colours {
    if dark {
        Colours {
            setpoint: Color32::from_rgb(0x70, 0x70, 0x70),
            display: Color32::from_rgb(0x56, 0xB4, 0xE9),
            skin: Color32::from_rgb(0xE6, 0x9F, 0x00),
            force: Color32::from_rgb(0x2B, 0xC4, 0x9A),
            current: Color32::from_rgb(0xE2, 0x9B, 0xC4),
            demand: Color32::from_rgb(0x70, 0x70, 0x70),
            warning: Color32::from_rgb(0xF0, 0xC0, 0x50),
            alarm: Color32::from_rgb(0xFF, 0x7A, 0x70),
            good: Color32::from_rgb(0x5E, 0xD0, 0x90),
        }
    } else {
        Colours {
            setpoint: Color32::from_rgb(0x90, 0x90, 0x90),
            display: Color32::from_rgb(0x00, 0x72, 0xB2),
            skin: Color32::from_rgb(0xC2, 0x55, 0x00),
            force: Color32::from_rgb(0x00, 0x7D, 0x5B),
            current: Color32::from_rgb(0xA8, 0x44, 0x7F),
            demand: Color32::from_rgb(0x90, 0x90, 0x90),
            warning: Color32::from_rgb(0x8A, 0x5A, 0x00),
            alarm: Color32::from_rgb(0xB0, 0x10, 0x10),
            good: Color32::from_rgb(0x0A, 0x70, 0x3C),
        }
    }
}

/// Sizes that are read from the other side of a table.
pub fn apply(ctx: &Context, dark: bool) {
    ctx.set_theme(if dark { Theme::Dark } else { Theme::Light });
    ctx.all_styles_mut(|style| {
        for (text_style, size) in [
            (TextStyle::Heading, 22.0),
            (TextStyle::Body, 16.0),
            (TextStyle::Button, 17.0),
            (TextStyle::Small, 13.0),
        ] {
            style.text_styles.insert(text_style, FontId::proportional(size));
        }
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.button_padding = egui::vec2(12.0, 7.0);
        style.interaction.selectable_labels = false;
        // The font is a light one: grey text on white would be faint.
        let text = if style.visuals.dark_mode {
            Color32::from_rgb(0xE6, 0xE6, 0xE6)
        } else {
            Color32::from_rgb(0x14, 0x14, 0x14)
        };
        style.visuals.override_text_color = Some(text);
    });
}

/// Calm colours of the participant's window, always the same, so that no participant has others than the one before.
pub fn participant_style(style: &mut Style) {
    style.visuals = egui::Visuals::dark();
    style.visuals.panel_fill = Color32::from_rgb(0x20, 0x26, 0x2B);
    style.visuals.override_text_color = Some(Color32::from_rgb(0xEC, 0xEC, 0xE6));
    style.interaction.selectable_labels = false;
}
