//! Reads session files.

mod design;
mod materials;
mod nesting;
mod present;
mod score;
mod setup;
mod source;
mod trial;
mod value;

#[cfg(test)]
mod tests;

use std::path::Path;

use thermal_client::text;
use toml::de::DeTable;

use self::design::Parts;
pub use self::source::SessionError;
use self::source::Source;
use self::value::{Table, Value, Whole};
use crate::Session;

/// Number of the form of session files.
const FORMAT: Whole = Whole::new("format", 1, 1, None);
/// Largest file, bytes.
pub(crate) const BYTES_MAX: u64 = 1 << 20;
/// Longest text for people, characters.
const TEXT_MAX: usize = 10_000;

const KEYS: [&str; 16] = [
    "format",
    "title",
    "task",
    "cite",
    "instruction",
    "device",
    "materials",
    "stations",
    "present",
    "rest",
    "trial",
    "design",
    "part",
    "staircase",
    "void",
    "score",
];

pub(crate) fn read(path: &Path) -> Result<Session, SessionError> {
    let unreadable =
        |error: std::io::Error| SessionError::of_file(path, format!("cannot be read: {error}"));
    parse(&text::read(path, BYTES_MAX).map_err(unreadable)?, path)
}

pub(crate) fn parse(file_text: &str, path: &Path) -> Result<Session, SessionError> {
    // Texts of several lines are the same whatever ends the lines of the file.
    let with_lf = &file_text.replace("\r\n", "\n");
    let source = Source { file: path, text: with_lf };
    nesting::check(&source)?;
    let document = DeTable::parse(source.text).map_err(|error| {
        let span = error.span().unwrap_or_default();
        let problem = match error.message() {
            "duplicate key" => {
                let key = source.quote(span.clone());
                format!("{key} again; allowed is each key once")
            }
            other => other.into(),
        };
        source.error(span.start, problem)
    })?;
    if let Some((at, problem)) = text::control_in_toml(document.get_ref()) {
        return Err(source.error(at, problem));
    }
    let file = Table::new(&source, String::new(), 0, document.get_ref());
    file.only(&KEYS)?;
    let format = file.need(FORMAT.key, "1")?;
    format.whole(&FORMAT).map_err(|_| format.wrong("1"))?;
    let text_of = |key: &str, most| file.need(key, "a text")?.text(most);
    let materials = materials::materials(file.get("materials"))?;
    let read = setup::stations(file.need("stations", "a table for each station")?)?;
    let stations = &read.stations;
    let design = design::design(&file, stations)?;
    let present = present::present(
        file.need("present", "what the stations present")?,
        stations,
        &design,
        &materials,
    )?;
    let device = setup::device(file.get("device"), &read, &present)?;
    let rest = setup::rest(file.get("rest"), &present)?;
    let trial = trial::trial(file.need("trial", "a table")?, &present, &design)?;
    let voids = trial::voids(file.get("void"), &file, &trial, stations, &design)?;
    let score = score::score(
        file.get("score"),
        &file,
        &score::Facts { stations, present: &present.present, trial: &trial, design: &design },
    )?;
    let Parts { design, staircases, break_s, .. } = design;
    Ok(Session {
        title: text_of("title", 200)?,
        task: task(file.need("task", TASK)?)?,
        cite: text_of("cite", 400)?,
        instruction: text_of("instruction", TEXT_MAX)?,
        device,
        materials,
        stations: read.stations,
        present: present.present,
        rest,
        trial: trial.rules,
        answer: trial.answer,
        design,
        staircases,
        break_s,
        voids,
        score,
        text: file_text.into(),
    })
}

/// A label of BIDS.
const TASK: &str = "1 to 20 letters and digits";

fn task(value: &Value<'_>) -> Result<String, SessionError> {
    let task = value.string(TASK)?;
    let known = task.chars().all(|c| c.is_ascii_alphanumeric());
    if known && (1..=20).contains(&task.len()) { Ok(task.into()) } else { Err(value.wrong(TASK)) }
}
