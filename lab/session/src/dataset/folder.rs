//! Where the files of a session are.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::codes::names_in;
use super::{RecordingError, error_at};

/// End of the name of a file that is being written as a whole.
const PART: &str = ".part";

/// The folder of a data set, and in it the files of one participant and task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder {
    root: PathBuf,
    participant: String,
    task: String,
}

impl Folder {
    /// The files of a participant, a code of letters and digits, and a task in a data set.
    pub fn new(root: &Path, participant: &str, task: &str) -> Self {
        Self { root: root.into(), participant: participant.into(), task: task.into() }
    }

    /// The data set.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Code of the participant.
    pub fn participant(&self) -> &str {
        &self.participant
    }

    /// Name of the task.
    pub fn task(&self) -> &str {
        &self.task
    }

    /// The folder in which the session was recorded.
    pub fn path(&self) -> PathBuf {
        let Self { root, participant, task } = self;
        let folder = root.join("sourcedata").join(format!("sub-{participant}"));
        folder.join(format!("task-{task}"))
    }

    /// A file in which the session was recorded.
    pub fn source(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    /// The sessions of a participant; none if there are no data.
    pub(super) fn all_of(root: &Path, participant: &str) -> Result<Vec<Self>, RecordingError> {
        let folder = root.join("sourcedata").join(format!("sub-{participant}"));
        let tasks = names_in(&folder, "task-")?;
        Ok(tasks.into_iter().map(|task| Self::new(root, participant, &task)).collect())
    }

    /// Removes what programs that were killed have left of the files of this session that they wrote as a whole. No other program
    /// may have it.
    pub(super) fn remove_parts(&self) -> Result<(), RecordingError> {
        remove_parts(&self.path(), "")?;
        let files = self.behaviour("");
        let begin = files.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        files.parent().map_or(Ok(()), |folder| remove_parts(folder, begin))
    }

    /// A file of behavioural data, by the end of its name, such as `events.tsv`.
    pub fn behaviour(&self, end: &str) -> PathBuf {
        let Self { root, participant, task } = self;
        let folder = root.join(format!("sub-{participant}")).join("beh");
        folder.join(format!("sub-{participant}_task-{task}_{end}"))
    }
}

/// The codes of participants with recorded sessions, by the names of folders.
pub(super) fn participant_folders(root: &Path) -> Result<Vec<String>, RecordingError> {
    names_in(&root.join("sourcedata"), "sub-")
}

/// Keeps other programs from the files that all participants share, from beginning a session, and from renaming participants,
/// until it is dropped.
pub(super) struct SharedFiles(
    #[expect(dead_code, reason = "the lock ends when it is closed")] fs::File,
);

impl SharedFiles {
    /// Waits until no other program has them.
    ///
    /// # Errors
    /// The operating system does not lock them.
    pub(super) fn lock(root: &Path) -> Result<Self, RecordingError> {
        let folder = root.join("sourcedata");
        let path = folder.join("shared-files.lock");
        fs::create_dir_all(&folder).map_err(error_at(&folder))?;
        let file = fs::File::create(&path).map_err(error_at(&path))?;
        file.lock().map_err(error_at(&path))?;
        Ok(Self(file))
    }
}

/// Removes the parts of files whose names begin so, which nobody writes any more.
pub(super) fn remove_parts(folder: &Path, begin: &str) -> Result<(), RecordingError> {
    for rest in names_in(folder, begin)? {
        let process = rest.strip_suffix(PART).and_then(|rest| rest.rsplit_once('.'));
        if process.is_some_and(|(_, id)| id.parse::<u32>().is_ok()) {
            let path = folder.join(format!("{begin}{rest}"));
            fs::remove_file(&path).map_err(error_at(&path))?;
        }
    }
    Ok(())
}

/// Writes a file as a whole: whoever reads it, at whatever time, finds the old contents or the new ones.
pub(super) fn write_whole(path: &Path, contents: &[u8]) -> Result<(), RecordingError> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(error_at(folder))?;
    }
    let mut name = path.as_os_str().to_owned();
    // Of this program alone: several may write the same file.
    name.push(format!(".{}{PART}", std::process::id()));
    let part = PathBuf::from(name);
    let written = fs::File::create(&part).and_then(|mut file| {
        file.write_all(contents)?;
        file.sync_all()
    });
    written.and_then(|()| fs::rename(&part, path)).map_err(|error| {
        // The error that counts is the first one.
        let _ignored = fs::remove_file(&part);
        error_at(path)(error)
    })
}
