//! Reads what was recorded, also of a session that was interrupted.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use thermal_client::text;

use super::check::contradictions;
use super::log::{Entry, LogLine};
use super::recorder::{INFO, LOG, SESSION, SessionInfo, TELEMETRY, sha256};
use super::{DataSetError, Exclusion, Folder, RecordingError, telemetry, unreadable};
use crate::record::TrialRecord;
use crate::{Plan, Session, Update};

/// Largest log, bytes: 1 GiB, a hundred times that of 10 000 trials.
const LOG_BYTES_MAX: u64 = 1 << 30;

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
    /// That the participant is excluded.
    pub excluded: Option<Exclusion>,
    /// What in its files is not as it was recorded, but does not change the trials above.
    pub remarks: Vec<String>,
}

impl RecordedSession {
    /// Reads the session of a folder with this description.
    ///
    /// # Errors
    /// A file cannot be read or does not say what it should, or the files contradict each other.
    pub(super) fn of(folder: Folder, info: SessionInfo) -> Result<Self, DataSetError> {
        let session_path = folder.source(SESSION);
        let text =
            text::read(&session_path, crate::file::BYTES_MAX).map_err(unreadable(&session_path))?;
        let session = Session::parse(&text, &session_path)
            .map_err(|error| content(&session_path, 1, &error))?;
        let plan = Plan::new(&session, info.plan_code(), info.seed)
            .map_err(|error| content(&session_path, 1, &error))?;
        let mut remarks = Vec::new();
        if sha256(plan.csv().as_bytes()) != info.plan_sha256 {
            return Err(DataSetError::OtherPlan(folder.path()));
        }
        if sha256(text.as_bytes()) != info.session_sha256 {
            remarks.push(format!("{}: changed after the recording", session_path.display()));
        }
        let log_path = folder.source(LOG);
        let ReadLog { lines: log, damaged, .. } = read_log(&log_path)?;
        let contradictions = contradictions(&session, &plan, &log);
        if let Some((line, first)) = contradictions.first() {
            let problem = match contradictions.len() {
                1 => first.clone(),
                count => format!("{first}; {count} contradictions in all"),
            };
            return Err(RecordingError::Content { path: log_path, line: *line, problem }.into());
        }
        let (records, telemetry_bytes) = records_of(&log);
        remarks.extend(damaged.map(|error| format!("{error}; what follows is left out")));
        let telemetry = folder.source(TELEMETRY);
        let length = match fs::metadata(&telemetry) {
            Err(error) if error.kind() == ErrorKind::NotFound => 0,
            metadata => metadata.map_err(unreadable(&telemetry))?.len(),
        };
        // What else is wrong with it is said where it is analysed.
        if let Err(error) = text::open(&telemetry, text::RECORDING_BYTES_MAX)
            && error.kind() == ErrorKind::PermissionDenied
        {
            return Err(unreadable(&telemetry)(error).into());
        }
        if let Some(bytes) = telemetry_bytes.filter(|bytes| length < *bytes) {
            remarks.push(format!(
                "{}: it has {length} bytes; the log says that {bytes} were recorded",
                telemetry.display()
            ));
        }
        Ok(Self { folder, info, session, plan, records, log, excluded: None, remarks })
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

/// The description of a session.
pub(super) fn read_info(folder: &Folder) -> Result<SessionInfo, RecordingError> {
    let path = folder.source(INFO);
    let text = text::read(&path, text::DOCUMENT_BYTES_MAX).map_err(unreadable(&path))?;
    serde_json::from_str(&text).map_err(|error| content(&path, error.line(), &error))
}

/// A log up to and including the last record. What follows is of a trial that has not ended, and may be damaged.
pub(super) struct ReadLog {
    pub lines: Vec<LogLine>,
    /// Their length.
    pub bytes: u64,
    /// The first damaged line after them, if it has an end: a program that was killed leaves a line without one.
    pub damaged: Option<RecordingError>,
}

pub(super) fn read_log(path: &Path) -> Result<ReadLog, RecordingError> {
    let text = text::read_bytes(path, LOG_BYTES_MAX).map_err(unreadable(path))?;
    let mark = text::mark_length(&text).map_err(unreadable(path))?;
    let (mut lines, mut bytes) = (Vec::new(), mark as u64);
    let mut committed = (0, 0);
    let mut damaged = None;
    for (number, line) in (1..).zip(text[mark..].split_inclusive(|byte| *byte == b'\n')) {
        bytes += line.len() as u64;
        match serde_json::from_slice::<LogLine>(line) {
            Ok(line) => lines.push(line),
            Err(_) if !line.ends_with(b"\n") => continue,
            Err(error) => {
                damaged = damaged.or(Some(content(path, number, &error)));
                continue;
            }
        }
        if let Some(LogLine { entry: Entry::Record { .. }, .. }) = lines.last() {
            if let Some(error) = damaged {
                return Err(error);
            }
            committed = (lines.len(), bytes);
        }
    }
    lines.truncate(committed.0);
    Ok(ReadLog { lines, bytes: committed.1, damaged })
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
