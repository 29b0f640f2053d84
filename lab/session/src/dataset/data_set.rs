//! Reads all sessions of a data set.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::participants::ParticipantList;
use super::read::read_info;
use super::{Folder, RecordedSession, RecordingError, SessionInfo, unreadable};

/// What could be read of a data set.
#[derive(Debug, Default)]
pub struct DataSet {
    /// Its sessions, by participant and task.
    pub sessions: Vec<RecordedSession>,
    /// Why files and folders of it are not among them.
    pub left_out: Vec<DataSetError>,
}

/// Why a data set, or a session of it, cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum DataSetError {
    /// A file or folder cannot be read, or does not say what it should.
    #[error(transparent)]
    File(#[from] RecordingError),
    /// A folder is not, or does not have, what a session is read from.
    #[error("{}: {why}, so no session is read from it", path.display())]
    NoSession {
        /// The folder, or a file in its place.
        path: PathBuf,
        /// What it is not.
        why: &'static str,
    },
    /// A folder has another name than the session was recorded with.
    #[error(
        "{}: session.json says participant {participant}, task {task}; a copied or renamed folder would count as a further \
         participant. Name it sub-{participant}/task-{task}, or remove it",
        folder.display()
    )]
    Renamed {
        /// The folder.
        folder: PathBuf,
        /// Code of the participant when it was recorded.
        participant: String,
        /// Name of the task when it was recorded.
        task: String,
    },
    /// Two folders are of the same participant and task.
    #[error(
        "{} and {}: both are of participant {participant}, task {task}, as session.json says; a copy would count as a further \
         participant. Remove one of them",
        one.display(),
        other.display()
    )]
    Twice {
        /// One of them.
        one: PathBuf,
        /// The other one.
        other: PathBuf,
        /// Code of the participant.
        participant: String,
        /// Name of the task.
        task: String,
    },
    /// Codes of two participants differ in case only.
    #[error(
        "{} and {}: the codes of the participants differ in case only; one person may count as two",
        one.display(),
        other.display()
    )]
    CodesDifferInCase {
        /// A folder of one of them.
        one: PathBuf,
        /// A folder of the other one.
        other: PathBuf,
    },
    /// Session file, participant and seed give another plan than that which was run.
    #[error(
        "{}: the plan of session.toml, participant and seed is not the one that was recorded, so what was presented is not known: \
         a file was changed after the recording, or another version of the program has made the plan",
        .0.display()
    )]
    OtherPlan(PathBuf),
}

/// Prefixes of the folders of a participant and of a task.
const PARTICIPANT: &str = "sub-";
const TASK: &str = "task-";

/// All sessions of a data set. A session that cannot be read is left out; where it is not certain who has done which session,
/// there is none.
///
/// # Errors
/// The folder is no data set, or whoever runs the program may not enter a folder or read a file of it, or a copied or renamed
/// folder, or codes that differ in case only, would count a participant twice.
pub fn recorded_sessions(root: &Path) -> Result<DataSet, DataSetError> {
    let mut left_out = Vec::new();
    let mut known = Vec::new();
    let folders = session_folders(root, &mut left_out)?;
    check_codes(&folders)?;
    for folder in folders {
        match read_info(&folder) {
            Ok(info) => known.push((folder, info)),
            Err(error) => leave_out(error.into(), &mut left_out)?,
        }
    }
    check_identities(&known)?;
    let exclusions = ParticipantList::read(root)?.exclusions()?;
    let mut sessions = Vec::new();
    for (folder, info) in known {
        let excluded = exclusions.get(folder.participant()).cloned();
        match RecordedSession::of(folder, info) {
            Ok(session) => sessions.push(RecordedSession { excluded, ..session }),
            Err(error) => leave_out(error, &mut left_out)?,
        }
    }
    Ok(DataSet { sessions, left_out })
}

/// Leaves a session out, unless it is only this user who may not read it: its data are sound, and results without them would be
/// those of another data set.
fn leave_out(error: DataSetError, left_out: &mut Vec<DataSetError>) -> Result<(), DataSetError> {
    match &error {
        DataSetError::File(RecordingError::Unreadable { error: why, .. })
            if why.kind() == ErrorKind::PermissionDenied =>
        {
            Err(error)
        }
        _ => {
            left_out.push(error);
            Ok(())
        }
    }
}

/// The folders of sessions. What is none is left out.
fn session_folders(
    root: &Path,
    left_out: &mut Vec<DataSetError>,
) -> Result<Vec<Folder>, DataSetError> {
    let source = root.join("sourcedata");
    let mut folders = Vec::new();
    for (participant, path) in folders_in(&source, PARTICIPANT, left_out)? {
        let tasks = match folders_in(&path, TASK, left_out) {
            Ok(tasks) => tasks,
            Err(error) => {
                leave_out(error, left_out)?;
                continue;
            }
        };
        if tasks.is_empty() {
            left_out.push(DataSetError::NoSession { path, why: "has no folder task-TASK" });
        }
        folders.extend(tasks.into_iter().map(|(task, _)| Folder::new(root, &participant, &task)));
    }
    Ok(folders)
}

/// The folders whose names begin with a word, in order: names without the word, and paths. Other folders are left out; files,
/// and folders that are hidden, have nothing to do with sessions.
fn folders_in(
    folder: &Path,
    word: &'static str,
    left_out: &mut Vec<DataSetError>,
) -> Result<Vec<(String, PathBuf)>, DataSetError> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable(folder))? {
        let path = entry.map_err(unreadable(folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let is_folder = match fs::metadata(&path) {
            Ok(metadata) => metadata.is_dir(),
            Err(error) => {
                leave_out(unreadable(&path)(error).into(), left_out)?;
                continue;
            }
        };
        let is_of_word = path
            .file_name()
            .and_then(|name| name.to_str())
            .and_then(|name| name.strip_prefix(word));
        match is_of_word {
            Some(rest) if is_folder => found.push((rest.to_owned(), path)),
            None if !is_folder || name.starts_with('.') => {}
            _ => left_out.push(DataSetError::NoSession {
                path,
                why: if word == TASK { "is no folder task-TASK" } else { "is no folder sub-CODE" },
            }),
        }
    }
    found.sort_unstable();
    Ok(found)
}

/// Refuses codes that differ in case only: one person would count as two.
fn check_codes(folders: &[Folder]) -> Result<(), DataSetError> {
    let mut known: BTreeMap<String, &Folder> = BTreeMap::new();
    for other in folders {
        let one = *known.entry(other.participant().to_ascii_lowercase()).or_insert(other);
        if one.participant() != other.participant() {
            return Err(DataSetError::CodesDifferInCase { one: one.path(), other: other.path() });
        }
    }
    Ok(())
}

/// Refuses folders whose names are not those that the session was recorded with.
fn check_identities(known: &[(Folder, SessionInfo)]) -> Result<(), DataSetError> {
    let mut recorded: BTreeMap<(&str, &str), &Folder> = BTreeMap::new();
    for (folder, info) in known {
        if let Some(one) = recorded.insert((&info.participant, &info.task), folder) {
            return Err(DataSetError::Twice {
                one: one.path(),
                other: folder.path(),
                participant: info.participant.clone(),
                task: info.task.clone(),
            });
        }
    }
    for (folder, info) in known {
        if (folder.participant(), folder.task()) != (&*info.participant, &*info.task) {
            return Err(DataSetError::Renamed {
                folder: folder.path(),
                participant: info.participant.clone(),
                task: info.task.clone(),
            });
        }
    }
    Ok(())
}
