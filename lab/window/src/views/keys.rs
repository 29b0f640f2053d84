//! Keys of egui as those of this crate.

use egui::{Context, Event};

use crate::Key;

/// The keys that were pressed in the window that is drawn now. Repetitions of a key that is held do not count: an answer is
/// given once.
pub fn pressed(ctx: &Context) -> Vec<Key> {
    ctx.input(|input| input.events.iter().filter_map(key).collect())
}

fn key(event: &Event) -> Option<Key> {
    let &Event::Key { key, physical_key, pressed: true, repeat, modifiers } = event else {
        return None;
    };
    // The digits of a French keyboard are digits only with the shift key; their place counts otherwise.
    let found = named(key).or_else(|| physical_key.and_then(named))?;
    let steps = matches!(found, Key::Left | Key::Right | Key::Backspace);
    let shortcut = modifiers.ctrl || modifiers.alt || modifiers.command;
    let counts = found == Key::Escape || (!shortcut && (!repeat || steps));
    counts.then_some(found)
}

fn named(key: egui::Key) -> Option<Key> {
    use egui::Key as K;
    Some(match key {
        K::Escape => Key::Escape,
        K::Enter => Key::Enter,
        K::Backspace => Key::Backspace,
        K::Tab => Key::Tab,
        K::ArrowLeft => Key::Left,
        K::ArrowRight => Key::Right,
        K::ArrowUp => Key::Up,
        K::ArrowDown => Key::Down,
        K::Period | K::Comma => Key::Point,
        K::Minus => Key::Minus,
        K::F11 => Key::F11,
        other => {
            let mut name = other.symbol_or_name().chars();
            match (name.next()?, name.next()) {
                (letter @ 'A'..='Z', None) => Key::Letter(letter.to_ascii_lowercase()),
                (digit @ '0'..='9', None) => Key::Digit(digit as u8 - b'0'),
                _ => return None,
            }
        }
    })
}
