//! Where the files of a session are.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::{RecordingError, error_at};

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

    /// A file in which the session was recorded.
    pub fn source(&self, name: &str) -> PathBuf {
        let Self { root, participant, task } = self;
        let folder = root.join("sourcedata").join(format!("sub-{participant}"));
        folder.join(format!("task-{task}")).join(name)
    }

    /// A file of behavioural data, by the end of its name, such as `events.tsv`.
    pub fn behaviour(&self, end: &str) -> PathBuf {
        let Self { root, participant, task } = self;
        let folder = root.join(format!("sub-{participant}")).join("beh");
        folder.join(format!("sub-{participant}_task-{task}_{end}"))
    }
}

/// Writes a file as a whole: whoever reads it, at whatever time, finds the old contents or the new ones.
pub(super) fn write_whole(path: &Path, contents: &[u8]) -> Result<(), RecordingError> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(error_at(folder))?;
    }
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
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
