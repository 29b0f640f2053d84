//! What the device answers: classes of the Python package, and a table of docs/protocol.md.

use thermal_device::Vocabulary as _;
use thermal_device::learning::FingerKnowledge;
use thermal_device::reference::ContactModel;
use thermal_wire::answer::ANSWERS;
use thermal_wire::host::{AnswerForm, FieldForm, FieldRow, ValueForm};
use thermal_wire::request::TABLE;

use crate::part::Part;

/// Answers that have a class in Python, and its name; of the others the package returns the only value.
const CLASSES: [(&str, &str); 12] = [
    ("Identity", "Identity"),
    ("BoardReport", "BoardReport"),
    ("Status", "Status"),
    ("ContactLawReport", "ContactLaw"),
    ("Cause", "Cause"),
    ("SelfTestReport", "SelfTestReport"),
    ("RawReadings", "RawReadings"),
    ("IdentifiedTile", "IdentifiedTile"),
    ("CalibrationFit", "CalibrationFit"),
    ("FluxReport", "FluxReport"),
    ("SurfaceReport", "DisplaySurface"),
    ("PersonReport", "PersonReport"),
];

pub fn parts() -> Vec<Part> {
    let classes = ANSWERS.iter().filter_map(|answer| {
        let (name, class) = CLASSES.into_iter().find(|(name, _)| *name == answer.name)?;
        let file = "python/src/thermal_display/replies.py";
        Some(Part { file, name, text: body(answer, class) })
    });
    let table = Part { file: "docs/protocol.md", name: "answers", text: table() };
    classes.chain([table]).collect()
}

/// A value as Python has it.
struct Attribute {
    name: String,
    kind: String,
    what: String,
    read: String,
}

/// Attributes of a class, and the method that reads them.
fn body(answer: &AnswerForm, class: &str) -> String {
    let attributes: Vec<_> = answer.rows.iter().flat_map(attributes).collect();
    let declared = attributes
        .iter()
        .map(|Attribute { name, kind, what, .. }| format!("{name}: {kind}\n\"\"\"{what}.\"\"\"\n"));
    let read =
        attributes.iter().map(|Attribute { name, read, .. }| format!("        {name}={read},\n"));
    let (optional, absent) = answer.none.map_or_else(Default::default, |(name, word)| {
        let absent =
            format!("    if reply.value(\"{name}\", str) == \"{word}\":\n        return None\n");
        (" | None", absent)
    });
    let declared: String = declared.collect();
    let read: String = read.collect();
    format!(
        "{declared}\n@classmethod\ndef read(cls, reply: Fields) -> {class}{optional}:\n{absent}    return cls(\n{read}    )\n"
    )
}

fn attributes(row: &FieldRow) -> Vec<Attribute> {
    let (wire, what) = (row.name, row.what);
    let attribute = |name: &str, kind: String, read| Attribute {
        name: name.strip_prefix("is_").unwrap_or(name).into(),
        kind,
        what: what.into(),
        read,
    };
    let one = |kind: &str, read| vec![attribute(row.column, kind.into(), read)];
    match row.form {
        FieldForm::Named(form) => {
            let (kind, read) = named(wire, form);
            vec![attribute(row.column, kind, read)]
        }
        FieldForm::IfReported(form) => {
            let (form, none) = match form {
                ValueForm::OrUnknown(form) => (*form, ", \"-\""),
                form => (form, ""),
            };
            let (kind, convert) = word(form);
            let read = typed(&kind, format!("reply.if_reported(\"{wire}\", {convert}{none})"));
            vec![attribute(row.column, format!("{kind} | None"), read)]
        }
        FieldForm::ListIfReported => {
            one("tuple[str, ...]", format!("reply.words_behind(\"{wire}\")"))
        }
        FieldForm::NameAlone => one("bool", format!("\"{wire}\" in reply.words")),
        FieldForm::WordAt(place) => one("str", format!("reply.words[{place}]")),
        FieldForm::StateAndFault => vec![
            attribute("state", "State".into(), format!("State(reply.value(\"{wire}\", str))")),
            Attribute {
                name: "fault".into(),
                kind: "str | None".into(),
                what: "Fault by which the device is tripped".into(),
                read: "reply.or_none(\"fault\", str)".into(),
            },
        ],
        FieldForm::Numbers(numbers) => numbers()
            .into_iter()
            .map(|(name, range)| Attribute {
                name: name.into(),
                kind: "float".into(),
                what: format!("{}: {range}", capital(range.name)),
                read: format!("reply.value(\"{name}\", real)"),
            })
            .collect(),
    }
}

/// Python's type of a value behind its name, and how it is read.
fn named(wire: &str, form: ValueForm) -> (String, String) {
    let or_none = |form, none: &str| {
        let (kind, convert) = word(form);
        let read = typed(&kind, format!("reply.or_none(\"{wire}\", {convert}{none})"));
        (format!("{kind} | None"), read)
    };
    match form {
        ValueForm::OrUnknown(form) => or_none(*form, ""),
        ValueForm::NumberOr(none) => or_none(ValueForm::Number, &format!(", \"{none}\"")),
        ValueForm::TextOr(none) => or_none(ValueForm::Text, &format!(", \"{none}\"")),
        ValueForm::CountWithin(min, max) => {
            ("int".into(), format!("reply.whole_within(\"{wire}\", {min}, {max})"))
        }
        form => {
            let (kind, convert) = word(form);
            let read = typed(&kind, format!("reply.value(\"{wire}\", {convert})"));
            (kind, read)
        }
    }
}

/// Python's type of a word, and the function that makes it of the word.
fn word(form: ValueForm) -> (String, String) {
    let (kind, convert) = match form {
        ValueForm::Number => ("float", "real"),
        ValueForm::Count => ("int", "int"),
        ValueForm::Bit => ("bool", "bit"),
        ValueForm::Whether(yes, no) => {
            return ("bool".into(), format!("whether(\"{yes}\", \"{no}\")"));
        }
        ValueForm::Word(words) => (literal(&words()), "str"),
        _ => ("str", "str"),
    };
    (kind.into(), convert.into())
}

/// Python's type of these words.
fn literal(words: &[&str]) -> &'static str {
    if words == ContactModel::WORDS.words {
        "ContactMode"
    } else if words == FingerKnowledge::ALL.map(FingerKnowledge::name) {
        "FingerKnowledge"
    } else {
        "str"
    }
}

/// The expression with the type that a checker of types cannot know.
fn typed(kind: &str, read: String) -> String {
    if ["float", "int", "bool", "str"].contains(&kind) {
        read
    } else {
        format!("cast({kind}, {read})")
    }
}

/// A text with a large first letter.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// All values of all answers, by the lines that are answered so.
fn table() -> String {
    let rows = ANSWERS.iter().flat_map(|answer| {
        let asked = TABLE.iter().filter(|form| {
            let of = form.answer.unwrap_or_default();
            of == answer.name || of == format!("Option<{}>", answer.name)
        });
        let asked: Vec<_> = asked.map(|form| format!("`{}`", form.words.trim())).collect();
        let asked = asked.join(", ");
        let none = answer.none.map(|(name, word)| {
            format!("| {asked} | `{name}={word}` | | there is nothing to report |\n")
        });
        let values = answer.rows.iter().map(move |row| {
            let (value, allowed) = value(row);
            format!("| {asked} | {value} | {allowed} | {} |\n", crate::wire::lower(row.what))
        });
        none.into_iter().chain(values)
    });
    let head = "\n| answer to | value | is | what it is |\n|---|---|---|---|\n";
    head.to_owned() + &rows.collect::<String>()
}

/// How a value stands in the answer, and what it can be.
fn value(row: &FieldRow) -> (String, String) {
    let name = row.name;
    match row.form {
        FieldForm::Named(form) => (format!("`{name}=…`"), allowed(form)),
        FieldForm::IfReported(form) => {
            (format!("`{name}=…`"), format!("{}; may be missing", allowed(form)))
        }
        FieldForm::ListIfReported => (format!("`{name}=…`"), "words with commas between".into()),
        FieldForm::NameAlone => (format!("`{name}`"), "there or not".into()),
        FieldForm::WordAt(_) => (name.into(), "word".into()),
        FieldForm::StateAndFault => {
            ("`state=… fault=…`".into(), "words; `-` without a fault".into())
        }
        FieldForm::Numbers(numbers) => {
            let (names, ranges): (Vec<_>, Vec<_>) = numbers()
                .into_iter()
                .map(|(name, range)| (format!("`{name}=…`"), range.to_string()))
                .unzip();
            (names.join(" "), ranges.join("; "))
        }
    }
}

fn allowed(form: ValueForm) -> String {
    match form {
        ValueForm::Number => "number".into(),
        ValueForm::Count => "whole number".into(),
        ValueForm::CountWithin(min, max) => format!("{min} to {max}"),
        ValueForm::Word(words) => words().join(", "),
        ValueForm::Bit => "`1` or `0`".into(),
        ValueForm::Whether(yes, no) => format!("{yes} or {no}"),
        ValueForm::Text => "word".into(),
        ValueForm::NumberOr(word) => format!("number, or `{word}`"),
        ValueForm::TextOr(word) => format!("word, or `{word}`"),
        ValueForm::ListOr(word) => format!("words with commas between, or `{word}`"),
        ValueForm::OrUnknown(form) => format!("{}, or `-`", allowed(*form)),
    }
}
