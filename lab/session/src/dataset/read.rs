//! Reads what was recorded, also of a session that was interrupted.

use std::fs;
use std::path::{Path, PathBuf};

use super::log::{Entry, LogLine};
use super::recorder::{INFO, LOG, SESSION, SessionInfo, TELEMETRY};
use super::{Folder, RecordingError, telemetry, unreadable};
use crate::record::TrialRecord;
use crate::{Plan, Session, Update};

/// A session of a participant as it was recorded.
#[derive(Clone, Debug)]
pub struct RecordedSession {
    /// Where it is.
    pub folder: Folder,
    /// What it was.
    pub info: SessionInfo,
    /// Its session file.
    pub session: Session,
    /// Its plan.
    pub plan: Plan,
    /// Its trials, in the order in which they were run.
    pub records: Vec<TrialRecord>,
    /// Everything that happened.
    pub log: Vec<LogLine>,
}

impl RecordedSession {
    /// Reads the session of a participant and task.
    ///
    /// # Errors
    /// A file cannot be read or does not say what it should.
    pub fn read(folder: Folder) -> Result<Self, RecordingError> {
        let info_path = folder.source(INFO);
        let info = fs::read(&info_path).map_err(unreadable(&info_path))?;
        let info: SessionInfo = serde_json::from_slice(&info)
            .map_err(|error| content(&info_path, error.line(), &error))?;
        let session_path = folder.source(SESSION);
        let text = fs::read_to_string(&session_path).map_err(unreadable(&session_path))?;
        let session = Session::parse(&text, &session_path)
            .map_err(|error| content(&session_path, 1, &error))?;
        let plan = Plan::new(&session, &info.participant, info.seed)
            .map_err(|error| content(&session_path, 1, &error))?;
        let (log, _) = read_log(&folder.source(LOG))?;
        let (records, _) = records_of(&log);
        Ok(Self { folder, info, session, plan, records, log })
    }

    /// The file with its telemetry.
    pub fn telemetry_path(&self) -> PathBuf {
        self.folder.source(TELEMETRY)
    }

    /// What participant and operator were told, and the telemetry, with their times, s, in order.
    ///
    /// # Errors
    /// The telemetry cannot be read.
    pub fn updates(&self) -> Result<Vec<(f64, Update)>, RecordingError> {
        let told = self.log.iter().filter_map(|line| match &line.entry {
            Entry::Update(update) => Some((line.t_s, update.clone())),
            Entry::Event { .. } | Entry::Record { .. } => None,
        });
        let mut all: Vec<_> = told.collect();
        let telemetry = telemetry::read(&self.telemetry_path())?;
        all.extend(telemetry.into_iter().map(|(t_s, line)| (t_s, Update::Telemetry(line))));
        all.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        Ok(all)
    }

    /// The records that count.
    pub fn counted(&self) -> impl Iterator<Item = &TrialRecord> {
        self.records.iter().filter(|record| record.void.is_none())
    }
}

/// All sessions of a data set, by participant and task.
///
/// # Errors
/// The folder is no data set, or a file cannot be read.
pub fn recorded_sessions(root: &Path) -> Result<Vec<RecordedSession>, RecordingError> {
    let source = root.join("sourcedata");
    let mut sessions = Vec::new();
    for participant in names(&source, "sub-")? {
        for task in names(&source.join(format!("sub-{participant}")), "task-")? {
            let folder = Folder::new(root, &participant, &task);
            // A session that was killed while it began has no log yet.
            if folder.source(LOG).exists() {
                sessions.push(RecordedSession::read(folder)?);
            }
        }
    }
    Ok(sessions)
}

/// The folders whose names begin with a word, in order, without the word.
fn names(folder: &Path, word: &str) -> Result<Vec<String>, RecordingError> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable(folder))? {
        let name = entry.map_err(unreadable(folder))?.file_name();
        let name = name.to_str().and_then(|name| name.strip_prefix(word));
        names.extend(name.map(str::to_owned));
    }
    names.sort_unstable();
    Ok(names)
}

/// The lines of a log up to and including the last record, and their length in bytes. What follows is of a trial that has not
/// ended, and may be damaged.
pub(super) fn read_log(path: &Path) -> Result<(Vec<LogLine>, u64), RecordingError> {
    let text = fs::read(path).map_err(unreadable(path))?;
    let (mut lines, mut bytes) = (Vec::new(), 0u64);
    let mut committed = (0, 0);
    let mut damaged = None;
    for (number, line) in (1..).zip(text.split_inclusive(|byte| *byte == b'\n')) {
        bytes += line.len() as u64;
        match serde_json::from_slice::<LogLine>(line) {
            Ok(line) => lines.push(line),
            Err(error) => {
                damaged = damaged.or(Some((number, error)));
                continue;
            }
        }
        if let Some(LogLine { entry: Entry::Record { .. }, .. }) = lines.last() {
            if let Some((number, error)) = &damaged {
                return Err(content(path, *number, error));
            }
            committed = (lines.len(), bytes);
        }
    }
    lines.truncate(committed.0);
    Ok((lines, committed.1))
}

/// The records of a log, and the length of the telemetry up to the last one.
pub(super) fn records_of(lines: &[LogLine]) -> (Vec<TrialRecord>, Option<u64>) {
    let mut telemetry = None;
    let records = lines.iter().filter_map(|line| match &line.entry {
        Entry::Record { record, telemetry_bytes } => {
            telemetry = Some(*telemetry_bytes);
            Some((**record).clone())
        }
        _ => None,
    });
    (records.collect(), telemetry)
}

fn content(path: &Path, line: usize, error: &dyn std::error::Error) -> RecordingError {
    RecordingError::Content { path: path.into(), line, problem: error.to_string() }
}
