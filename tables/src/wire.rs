//! What host and device say to each other: words, fields of telemetry, forms of lines.

use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::events::DeviceEventKind;
use thermal_device::learning::FingerKnowledge;
use thermal_device::reference::ContactModel;
use thermal_device::safety::ThermistorId;
use thermal_device::stimulus::{CourseEnd, CourseStart};
use thermal_device::{TelemetryFields, Vocabulary};
use thermal_wire::host::{ArgumentForm, COLUMNS, Column, Need, RequestForm, ValueForm};
use thermal_wire::request::TABLE;
use thermal_wire::telemetry::{DEFAULT_FIELDS, FLUX_FIELDS, NAMES};

use crate::part::Part;

const WORDS: &str = "python/src/thermal_display/words.py";
const TELEMETRY: &str = "python/src/thermal_display/telemetry.py";

pub fn parts() -> Vec<Part> {
    let words = |name, words: &[&str]| Part { file: WORDS, name, text: quoted(words) };
    let telemetry = |name, text| Part { file: TELEMETRY, name, text };
    let (every, named) = COLUMNS.split_at(Column::default_ones().len());
    vec![
        words("assumed-fingers", AssumedFinger::WORDS.words),
        words("finger-knowledge", &FingerKnowledge::ALL.map(FingerKnowledge::name)),
        words("contact-modes", ContactModel::WORDS.words),
        words("laws", Law::WORDS.words),
        words("course-starts", CourseStart::WORDS.words),
        words("course-ends", CourseEnd::WORDS.words),
        words("trigger-events", &trigger_events()),
        words("thermistors", ThermistorId::WORDS.words),
        words("telemetry-fields", &NAMES),
        words("default-fields", &names_of(DEFAULT_FIELDS)),
        words("flux-fields", &names_of(FLUX_FIELDS)),
        telemetry("telemetry-columns", COLUMNS.iter().map(column).collect()),
        telemetry("telemetry-of-every-line", every.iter().map(attribute).collect()),
        telemetry("telemetry-named", named.iter().map(attribute).collect()),
        Part {
            file: "tests/fuzz/wire.dict",
            name: "telemetry-fields",
            text: NAMES.map(|name| format!("\" {name}\"\n")).concat(),
        },
        Part { file: "tests/fuzz/wire.dict", name: "lines", text: dictionary() },
        Part { file: "docs/protocol.md", name: "telemetry", text: fields() },
        Part { file: "docs/protocol.md", name: "lines", text: lines() },
    ]
}

fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\",\n")).collect()
}

fn names_of(fields: TelemetryFields) -> Vec<&'static str> {
    let chosen = NAMES.iter().enumerate().filter(|(place, _)| fields.contains(*place));
    chosen.map(|(_, name)| *name).collect()
}

/// The events that `trigger-out` can mark: all but the edge that another device gives.
fn trigger_events() -> Vec<&'static str> {
    let kinds = DeviceEventKind::ALL.iter().filter(|kind| **kind != DeviceEventKind::Trigger);
    kinds.map(|kind| kind.name()).collect()
}

fn kind(column: &Column) -> &'static str {
    match column.form {
        ValueForm::Number => "number",
        ValueForm::Word(_) => "word",
        _ => "count",
    }
}

fn column(column: &Column) -> String {
    format!("Column(\"{}\", \"{}\", \"{}\"),\n", column.field, column.name, kind(column))
}

fn attribute(column: &Column) -> String {
    let python = match column.form {
        ValueForm::Number => "float",
        ValueForm::Word(_) => "str",
        _ => "int",
    };
    format!("{}: {python}\n", column.name)
}

/// Rows of the fields: those of every line, and those that are there if they are named.
fn fields() -> String {
    let rows = COLUMNS.iter().map(|column| {
        let only = match column.need {
            Need::Nothing => "",
            Need::FluxSensor => "only if named: ",
            Need::Capability(word) => &format!("only if named, with the capability `{word}`: "),
        };
        let unit = match (column.form, column.unit) {
            (ValueForm::Word(_), _) => "word",
            (ValueForm::Number, "degC") => "°C",
            (ValueForm::Number, "W/m^2") => "W/m²",
            (ValueForm::Number, unit) => unit,
            _ => "count",
        };
        format!("| {} | {unit} | {only}{} |\n", column.field, lower(column.description))
    });
    let head = "\n| field | unit | contents |\n|---|---|---|\n\
                | tick | ms | time since reset |\n| state | word | as above |\n";
    let remark = "| remark | word | fault; `limited` if the set-point is not the one that was asked for; `untuned` if the tile \
                  was never [tuned](control.md#limits-of-the-set-point); or `-` |\n";
    head.to_owned() + &rows.collect::<String>() + remark
}

/// A text with a small first letter.
pub fn lower(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// All forms of a line with their arguments.
fn lines() -> String {
    let rows = TABLE.iter().map(|form| {
        let names = form.arguments.iter().map(|argument| place(argument.name, &(argument.form)()));
        let line: Vec<_> = form.words.split_whitespace().map(String::from).chain(names).collect();
        let ranges: Vec<_> = form
            .arguments
            .iter()
            .map(|argument| {
                format!("`{}`: {}", argument.name.to_uppercase(), allowed(&(argument.form)()))
            })
            .collect();
        let effect = form.effect.concat();
        format!("| `{}` | {} | {} |\n", line.join(" "), ranges.join("; "), effect.trim())
    });
    let head = "\n| line | arguments | effect |\n|---|---|---|\n";
    head.to_owned() + &rows.collect::<String>()
}

/// An argument in a line.
fn place(name: &str, form: &ArgumentForm) -> String {
    let name = name.to_uppercase();
    if matches!(form, ArgumentForm::Optional(_)) { format!("[{name}]") } else { name }
}

fn allowed(form: &ArgumentForm) -> String {
    match form {
        ArgumentForm::Number(range) | ArgumentForm::Whole(range) => range.to_string(),
        ArgumentForm::Numbers(ranges) => {
            let ranges: Vec<_> =
                ranges.iter().map(|range| format!("{} {range}", range.name)).collect();
            ranges.join(", ")
        }
        ArgumentForm::Words(words) => words.join(", "),
        ArgumentForm::List(words, separator) => {
            format!("{}, with {separator:?} between", words.join(", "))
        }
        ArgumentForm::Text(text) => (*text).into(),
        ArgumentForm::Optional(form) => allowed(form),
    }
}

/// A line of each form whose arguments are words and numbers, with numbers in the middle of their ranges.
fn dictionary() -> String {
    let line = |form: &RequestForm| {
        let arguments = form.arguments.iter().map(|argument| example(&(argument.form)()));
        let words = form.words.split_whitespace().map(|word| Some(word.into()));
        let words: Option<Vec<String>> = words.chain(arguments).collect();
        words.map(|words| format!("\"{}\\x0a\"\n", words.join(" ")))
    };
    TABLE.iter().filter_map(line).collect()
}

fn example(form: &ArgumentForm) -> Option<String> {
    match form {
        ArgumentForm::Number(range) => Some(middle(range.min, range.max)),
        ArgumentForm::Whole(range) => Some(range.min.to_string()),
        ArgumentForm::Numbers(ranges) => {
            let values: Vec<_> = ranges.iter().map(|range| middle(range.min, range.max)).collect();
            Some(values.join(" "))
        }
        ArgumentForm::Words(words) | ArgumentForm::List(words, _) => {
            words.first().map(ToString::to_string)
        }
        ArgumentForm::Text(_) => None,
        ArgumentForm::Optional(form) => example(form),
    }
}

fn middle(min: f64, max: f64) -> String {
    (0.5 * (min + max)).to_string()
}
