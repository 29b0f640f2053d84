//! Changes to a data set that was recorded: a participant is renamed, or excluded.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thermal_client::text;

use super::append::AppendFile;
use super::codes::names_in;
use super::folder::{SharedFiles, participant_folders, write_whole};
use super::participants::{Exclusion, ParticipantList, describe_exclusions};
use super::read::read_info;
use super::recorder::{INFO, LOG, pretty, utc_now};
use super::{Folder, RecordingError, error_at, is_there, unreadable};
use crate::{PlanError, check_participant};

/// That a participant was given another code.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Renaming {
    /// The code before.
    pub from: String,
    /// The code after.
    pub to: String,
    /// When, UTC.
    pub time: String,
}

/// Why a data set is not changed.
#[derive(Debug, thiserror::Error)]
pub enum ChangeError {
    /// A file cannot be read or written, or the code differs from another in case only.
    #[error(transparent)]
    File(#[from] RecordingError),
    /// The new code is none.
    #[error(transparent)]
    Code(#[from] PlanError),
    /// The folder is no data set.
    #[error("{}: there is no folder sourcedata, so this is no data set; allowed is a folder that `run` has written", .0.display())]
    NoDataSet(PathBuf),
    /// There is no such participant.
    #[error("{}: there are no data of participant {code}; there are data of {}", root.display(), list(known))]
    Unknown {
        /// The data set.
        root: PathBuf,
        /// The code that was given.
        code: String,
        /// Codes of the participants that have data.
        known: Vec<String>,
    },
    /// There is a participant with the new code.
    #[error("{}: there is a participant {code} already; allowed is a code that nobody has", path.display())]
    Taken {
        /// Where the participant is.
        path: PathBuf,
        /// The code.
        code: String,
    },
    /// The participant has the code.
    #[error("participant {0} has this code; allowed is another one")]
    Same(String),
    /// The participant is excluded already.
    #[error(
        "participant {code} is {exclusion}; whoever is not to be excluded has `no` in the column `excluded` of participants.tsv"
    )]
    Excluded {
        /// The code.
        code: String,
        /// The exclusion.
        exclusion: Exclusion,
    },
    /// The reason is none.
    #[error("the reason {0:?}; allowed is a text of one line, other than n/a")]
    Reason(String),
}

fn list(codes: &[String]) -> String {
    if codes.is_empty() { "nobody".into() } else { codes.join(", ") }
}

/// Gives a participant another code: in folders, names of files, tables, and descriptions of sessions. The code with which the
/// plans were drawn stays in these. Returns the number of sessions.
///
/// If it is interrupted, the same call goes on.
///
/// # Errors
/// There is no such participant, the new code is none or is taken, a session of the participant is being recorded, or a file
/// cannot be read or written.
pub fn rename(root: &Path, old: &str, new: &str) -> Result<usize, ChangeError> {
    check_participant(old)?;
    check_participant(new)?;
    if old == new {
        return Err(ChangeError::Same(new.into()));
    }
    let shared = lock(root)?;
    let mentions = mentions(root, old, new)?;
    let codes = participant_folders(root)?;
    let is_known = |code: &str| codes.iter().any(|known| known == code);
    if is_known(old) {
        check_free(root, old, new)?;
        rename_sessions(root, old, new)?;
    } else if !is_interrupted(root, old, new)? {
        let (root, code) = (root.into(), old.into());
        return Err(ChangeError::Unknown { root, code, known: codes });
    }
    for (path, text) in mentions {
        write_whole(&path, text.as_bytes())?;
    }
    let folder = root.join(format!("sub-{old}"));
    if names_in(root, "sub-")?.iter().any(|name| name == old) {
        rename_files(&folder, old, new)?;
        move_to(&folder, &root.join(format!("sub-{new}")))?;
    }
    drop(shared);
    Ok(Folder::all_of(root, new)?.len())
}

/// Leaves the data of a participant out of the analyses.
///
/// # Errors
/// There is no such participant, it is excluded already, the reason is none, or a file cannot be read or written.
pub fn exclude(root: &Path, code: &str, reason: &str) -> Result<(), ChangeError> {
    let reason = reason.trim();
    if reason.is_empty() || reason == "n/a" || reason.contains(char::is_control) {
        return Err(ChangeError::Reason(reason.into()));
    }
    let _shared = lock(root)?;
    let mut list = ParticipantList::read(root)?;
    let known = participant_folders(root)?;
    if !known.iter().any(|known| known == code) && !list.has(code) {
        let (root, code) = (root.into(), code.into());
        return Err(ChangeError::Unknown { root, code, known });
    }
    if let Some(exclusion) = list.exclusions()?.remove(code) {
        return Err(ChangeError::Excluded { code: code.into(), exclusion });
    }
    list.exclude(code, reason, &utc_now());
    describe_exclusions(root)?;
    Ok(list.write()?)
}

/// Keeps other programs from a data set that is there.
fn lock(root: &Path) -> Result<SharedFiles, ChangeError> {
    let source = root.join("sourcedata");
    if !is_there(&source)? || !source.is_dir() {
        return Err(ChangeError::NoDataSet(root.into()));
    }
    Ok(SharedFiles::lock(root)?)
}

/// Refuses a new code that somebody has.
fn check_free(root: &Path, old: &str, new: &str) -> Result<(), ChangeError> {
    for folder in [root.join("sourcedata"), root.into()] {
        if names_in(&folder, "sub-")?.iter().any(|name| name == new) {
            let path = folder.join(format!("sub-{new}"));
            return Err(ChangeError::Taken { path, code: new.into() });
        }
    }
    if ParticipantList::read(root)?.has(new) {
        return Err(ChangeError::Taken { path: root.join("participants.tsv"), code: new.into() });
    }
    Ok(Folder::new(root, new, "").check_code(Some(old))?)
}

/// Renames the participant in the descriptions of its sessions, and then the folder of these.
fn rename_sessions(root: &Path, old: &str, new: &str) -> Result<(), ChangeError> {
    let time = utc_now();
    let mut changed = Vec::new();
    for folder in Folder::all_of(root, old)? {
        let log = folder.source(LOG);
        if is_there(&log)? {
            AppendFile::check_alone(&log)?;
        }
        let path = folder.source(INFO);
        if !is_there(&path)? {
            continue;
        }
        let mut info = read_info(&folder)?;
        // A call that was interrupted may have renamed it.
        if info.participant == old {
            info.participant = new.into();
            info.renamed.push(Renaming { from: old.into(), to: new.into(), time: time.clone() });
            changed.push((path, info));
        } else if !info.was_renamed(old, new) {
            let problem = format!(
                "it says participant {}; allowed is {old}, as its folder is named",
                info.participant
            );
            return Err(RecordingError::Content { path, line: 1, problem }.into());
        }
    }
    for (path, info) in changed {
        write_whole(&path, &pretty(&info))?;
    }
    let source = root.join("sourcedata");
    move_to(&source.join(format!("sub-{old}")), &source.join(format!("sub-{new}")))
}

/// Whether a call with the same codes has moved the sessions, and may have been interrupted then.
fn is_interrupted(root: &Path, old: &str, new: &str) -> Result<bool, ChangeError> {
    for folder in Folder::all_of(root, new)? {
        if is_there(&folder.source(INFO))? && read_info(&folder)?.was_renamed(old, new) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The tables and descriptions that name the participant, with the new code in them: those of the whole data set, of the folder
/// `phenotype`, and of the participant.
fn mentions(root: &Path, old: &str, new: &str) -> Result<Vec<(PathBuf, String)>, ChangeError> {
    let mut files = files_in(root)?;
    files.extend(files_in(&root.join("phenotype"))?);
    files.extend(all_files(&root.join(format!("sub-{old}")))?);
    let mut mentions = Vec::new();
    for path in files {
        if path.extension().is_none_or(|end| end != "tsv" && end != "json") {
            continue;
        }
        let text = text::read(&path, text::TABLE_BYTES_MAX).map_err(unreadable(&path))?;
        let changed = replaced(&text, &format!("sub-{old}"), &format!("sub-{new}"));
        if changed != text {
            mentions.push((path, changed));
        }
    }
    Ok(mentions)
}

/// A text with a word replaced wherever letters or digits stand neither before nor after it.
fn replaced(text: &str, word: &str, by: &str) -> String {
    let mut result = String::new();
    let mut done = 0;
    for (at, found) in text.match_indices(word) {
        let end = at + found.len();
        let before = text[..at].chars().next_back();
        let after = text[end..].chars().next();
        if before.into_iter().chain(after).any(char::is_alphanumeric) {
            continue;
        }
        result += &text[done..at];
        result += by;
        done = end;
    }
    result + &text[done..]
}

/// Renames the files of a participant, also those in folders.
fn rename_files(folder: &Path, old: &str, new: &str) -> Result<(), ChangeError> {
    for path in all_files(folder)? {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if let Some(rest) = name.strip_prefix(&format!("sub-{old}_")) {
            move_to(&path, &path.with_file_name(format!("sub-{new}_{rest}")))?;
        }
    }
    Ok(())
}

fn move_to(from: &Path, to: &Path) -> Result<(), ChangeError> {
    fs::rename(from, to).map_err(error_at(from))?;
    Ok(())
}

/// The files of a folder and of the folders in it; none if there is no folder. Links to folders are not followed.
fn all_files(folder: &Path) -> Result<Vec<PathBuf>, RecordingError> {
    let mut files = files_in(folder)?;
    for name in names_in(folder, "")? {
        let path = folder.join(name);
        if path.symlink_metadata().map_err(unreadable(&path))?.is_dir() {
            files.extend(all_files(&path)?);
        }
    }
    Ok(files)
}

/// The files of a folder; none if there is no folder.
fn files_in(folder: &Path) -> Result<Vec<PathBuf>, RecordingError> {
    let mut files = Vec::new();
    for path in names_in(folder, "")?.into_iter().map(|name| folder.join(name)) {
        // A link that leads nowhere is no file.
        if is_there(&path)? && path.is_file() {
            files.push(path);
        }
    }
    Ok(files)
}
