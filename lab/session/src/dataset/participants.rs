//! The list of the participants of a data set, `participants.tsv`, and who of them is excluded.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};
use thermal_client::text;

use super::folder::write_whole;
use super::recorder::pretty;
use super::{RecordingError, unreadable};

const LIST: &str = "participants.tsv";
const DESCRIPTION: &str = "participants.json";
/// What has no value in a table of BIDS.
const NONE: &str = "n/a";
/// The columns of an exclusion.
const EXCLUDED: &str = "excluded";
const REASON: &str = "exclusion_reason";
const TIME: &str = "exclusion_time";

/// That a participant's data are left out of the analyses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exclusion {
    /// Why; `None` if the list does not say.
    pub reason: Option<String>,
    /// When it was recorded, UTC; `None` if the list does not say.
    pub time: Option<String>,
}

impl fmt::Display for Exclusion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("excluded")?;
        if let Some(time) = &self.time {
            write!(f, " at {time}")?;
        }
        write!(f, ": {}", self.reason.as_deref().unwrap_or("no reason is recorded"))
    }
}

/// The list, which may have columns that people have added.
pub(super) struct ParticipantList {
    path: PathBuf,
    header: Vec<String>,
    /// The cells of each row, and its line in the file, from 1.
    rows: Vec<(usize, Vec<String>)>,
}

impl ParticipantList {
    /// The list of a data set; an empty one if there is none.
    pub(super) fn read(root: &Path) -> Result<Self, RecordingError> {
        let path = root.join(LIST);
        let text = text::read_if_there(&path, text::TABLE_BYTES_MAX).map_err(unreadable(&path))?;
        let text = text.unwrap_or_default();
        let cells = |line: &str| line.split('\t').map(str::to_owned).collect::<Vec<_>>();
        let filled = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
        let mut rows = filled.map(|(number, line)| (number, cells(line)));
        let (line, header) = rows.next().unwrap_or_else(|| (1, cells("participant_id")));
        if let Some(name) = text::repeated_column(header.iter().map(String::as_str)) {
            let problem = format!("two columns {name:?}; allowed is each name once");
            return Err(RecordingError::Content { path, line, problem });
        }
        Ok(Self { path, header, rows: rows.collect() })
    }

    pub(super) fn has(&self, code: &str) -> bool {
        self.rows.iter().any(|(_, cells)| is_of(cells, code))
    }

    /// Adds a participant, of whom the other columns say nothing, unless it is there.
    pub(super) fn add(&mut self, code: &str) {
        if !self.has(code) {
            let mut cells = vec![NONE.to_owned(); self.header.len()];
            cells[0] = format!("sub-{code}");
            self.rows.push((0, cells));
        }
    }

    /// Sets a value of a participant in a column, which is added if it is not there.
    fn set(&mut self, code: &str, column: &str, value: &str) {
        let at = self.column(column).unwrap_or_else(|| {
            self.header.push(column.into());
            self.header.len() - 1
        });
        for (_, cells) in &mut self.rows {
            if cells.len() < self.header.len() {
                cells.resize(self.header.len(), NONE.into());
            }
            if is_of(cells, code) {
                cells[at] = value.into();
            }
        }
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }

    /// Who is excluded, by code.
    pub(super) fn exclusions(&self) -> Result<BTreeMap<String, Exclusion>, RecordingError> {
        let mut exclusions = BTreeMap::new();
        let Some(excluded) = self.column(EXCLUDED) else {
            return Ok(exclusions);
        };
        for (line, cells) in &self.rows {
            let cell = |column: Option<usize>| {
                let cell = column.and_then(|at| cells.get(at)).map(|cell| cell.trim());
                cell.filter(|cell| !cell.is_empty() && *cell != NONE)
            };
            match cell(Some(excluded)).map(str::to_ascii_lowercase).as_deref() {
                None | Some("no") => {}
                Some("yes") => {
                    let code = cells[0].strip_prefix("sub-").unwrap_or(&cells[0]);
                    let text = |name| cell(self.column(name)).map(str::to_owned);
                    let exclusion = Exclusion { reason: text(REASON), time: text(TIME) };
                    exclusions.insert(code.to_owned(), exclusion);
                }
                Some(other) => {
                    return Err(RecordingError::Content {
                        path: self.path.clone(),
                        line: *line,
                        problem: format!("{EXCLUDED} = {other:?}; allowed are yes, no and {NONE}"),
                    });
                }
            }
        }
        Ok(exclusions)
    }

    /// Excludes a participant, for a reason of one line.
    pub(super) fn exclude(&mut self, code: &str, reason: &str, time: &str) {
        self.add(code);
        for (column, value) in [(EXCLUDED, "yes"), (REASON, reason), (TIME, time)] {
            self.set(code, column, value);
        }
    }

    pub(super) fn write(&self) -> Result<(), RecordingError> {
        let rows = self.rows.iter().map(|(_, cells)| cells);
        let lines = std::iter::once(&self.header).chain(rows).map(|cells| cells.join("\t") + "\n");
        write_whole(&self.path, lines.collect::<String>().as_bytes())
    }
}

fn is_of(cells: &[String], code: &str) -> bool {
    cells[0].strip_prefix("sub-") == Some(code)
}

/// Describes the columns of an exclusion, beside what is described already.
pub(super) fn describe_exclusions(root: &Path) -> Result<(), RecordingError> {
    let path = root.join(DESCRIPTION);
    let text = text::read_if_there(&path, text::DOCUMENT_BYTES_MAX).map_err(unreadable(&path))?;
    let mut all: Map<String, Value> = match text {
        Some(text) => serde_json::from_str(&text).map_err(|error| RecordingError::Content {
            path: path.clone(),
            line: error.line(),
            problem: error.to_string(),
        })?,
        None => Map::new(),
    };
    let known = all.len();
    for (column, about) in [
        (
            EXCLUDED,
            json!({
                "Description": "Whether the data of the participant are left out of the analyses",
                "Levels": { "yes": "Left out", "no": "Not left out, as n/a" },
            }),
        ),
        (REASON, json!({ "Description": "Why the data of the participant are left out" })),
        (TIME, json!({ "Description": "When the exclusion was recorded, UTC" })),
    ] {
        all.entry(column).or_insert(about);
    }
    if all.len() > known { write_whole(&path, &pretty(&all)) } else { Ok(()) }
}
