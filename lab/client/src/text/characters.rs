//! Characters of a text that terminals and pages would obey, and how they are shown or refused.

use std::borrow::Cow;

use toml::de::{DeTable, DeValue};

/// Whether a character changes how the text around it is shown, and is not shown itself: the control characters C0, DEL and C1,
/// of which escape sequences of terminals begin with some, and those that change the direction of a text.
pub fn is_control(character: char) -> bool {
    character.is_control()
        || matches!(
            character,
            '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
        )
}

/// A line as it is shown: control characters as `\u{1b}`.
pub fn escaped_line(line: &str) -> Cow<'_, str> {
    escaped(line, is_control)
}

/// A text of several lines as it is shown: control characters but line ends and tabs as `\u{1b}`.
pub fn escaped_text(text: &str) -> Cow<'_, str> {
    escaped(text, is_control_in_text)
}

/// Whether a character is a control character other than a line end or a tab.
fn is_control_in_text(character: char) -> bool {
    is_control(character) && !matches!(character, '\n' | '\t')
}

fn escaped(text: &str, is_escaped: fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(is_escaped) {
        return text.into();
    }
    let mut shown = String::new();
    for character in text.chars() {
        if is_escaped(character) {
            shown.extend(character.escape_unicode());
        } else {
            shown.push(character);
        }
    }
    shown.into()
}

/// The first key or text of a TOML document that has a control character other than a line end or a tab: the byte at which it
/// begins, and what is wrong. Such a text would reach terminals and pages.
pub fn control_in_toml(document: &DeTable<'_>) -> Option<(usize, String)> {
    control_in_table(document, "")
}

fn control_in_table(table: &DeTable<'_>, path: &str) -> Option<(usize, String)> {
    table.iter().find_map(|(key, value)| {
        let name = match path {
            "" => key.get_ref().to_string(),
            path => format!("{path}.{}", key.get_ref()),
        };
        let in_key = || control_in(key.get_ref(), &name, key.span().start);
        in_key().or_else(|| control_in_value(value.get_ref(), &name, value.span().start))
    })
}

fn control_in_value(value: &DeValue<'_>, name: &str, at: usize) -> Option<(usize, String)> {
    match value {
        DeValue::String(text) => control_in(text, name, at),
        DeValue::Array(values) => values
            .iter()
            .find_map(|value| control_in_value(value.get_ref(), name, value.span().start)),
        DeValue::Table(table) => control_in_table(table, name),
        _ => None,
    }
}

fn control_in(text: &str, name: &str, at: usize) -> Option<(usize, String)> {
    let character = text.chars().find(|character| is_control_in_text(*character))?;
    let problem = format!(
        "{} has the control character U+{:04X}; allowed are characters that are shown, line ends and tabs",
        escaped_line(name),
        u32::from(character)
    );
    Some((at, problem))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What Unicode 15.1 calls controls (category Cc), and its characters of the class Bidi_Control, by their numbers.
    #[test]
    fn control_characters_are_shown_by_their_numbers_and_other_text_as_it_is() {
        let controls = (0..0x20).chain(0x7f..0xa0).chain([0x61c, 0x200e, 0x200f]);
        for number in controls.chain(0x202a..0x202f).chain(0x2066..0x206a) {
            let control = char::from_u32(number).unwrap();
            let shown = format!("a\\u{{{number:x}}}b");
            assert_eq!(escaped_line(&format!("a{control}b")), shown);
            let is_kept = matches!(control, '\n' | '\t');
            let shown = if is_kept { format!("a{control}b") } else { shown };
            assert_eq!(escaped_text(&format!("a{control}b")), shown);
        }
        for ordinary in ["23 °C, d′", "für die Hand", "冷たい", "שמאל", "👩‍🔬", "\\u{1b}"]
        {
            assert_eq!(escaped_line(ordinary), ordinary);
            assert_eq!(escaped_text(ordinary), ordinary);
        }
    }

    #[test]
    fn a_control_character_of_a_toml_document_is_named_with_its_key_and_place() {
        let found = |text: &str| {
            let document = DeTable::parse(text).unwrap();
            let (at, problem) = control_in_toml(document.get_ref())?;
            Some((text.split_at(at).1.chars().take(2).collect::<String>(), problem))
        };
        let ends = "; allowed are characters that are shown, line ends and tabs";
        for (text, begin, problem) in [
            (r#"a = "x\u001b[2J""#, "\"x", "a has the control character U+001B"),
            ("a = 'x\u{9b}2J'", "'x", "a has the control character U+009B"),
            (r#"a = { b = [1, ["\u202E"]] }"#, "\"\\", "a.b has the control character U+202E"),
            (r#""k\u0007" = 1"#, "\"k", r"k\u{7} has the control character U+0007"),
            (
                "[[a]]\nb = 1\n[[a]]\nb = \"\"\"\n1\r\n\\u007f\"\"\"",
                "\"\"",
                "a.b has the control character U+007F",
            ),
        ] {
            let problem = format!("{problem}{ends}");
            // A carriage return before a line end belongs to the line end.
            assert_eq!(found(&text.replace('\r', "")), Some((begin.into(), problem)), "{text:?}");
        }
        assert_eq!(found("# \u{202e}\na = \"\"\"\n\tTouch,\nthen lift: 冷\"\"\"\n"), None);
    }
}
