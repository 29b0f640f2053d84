//! The recorded data of a session, as a data set after BIDS (Brain Imaging Data Structure, behavioural data).
//!
//! ```text
//! dataset_description.json, README.md, participants.tsv, participants.json
//! sub-01/beh/sub-01_task-p5_events.tsv (+ .json)                      a row for each trial
//! sub-01/beh/sub-01_task-p5_recording-finger0_physio.tsv.gz (+ .json) telemetry of a finger of the device
//! sourcedata/sub-01/task-p5/                                          what the files above are written from
//!     session.toml, plan.csv, session.json    what was to be done, with which device
//!     log.jsonl                               everything that happened, in lines of JSON
//!     telemetry.csv                           all telemetry
//!     clock.json                              what only clock and computer say
//! ```
//!
//! `log.jsonl` and `telemetry.csv` grow by one trial at a time. A thread beside the session writes it and forces it to the disk,
//! before the next one is written. A power cut loses the trial that runs, and the one before if it was not on the disk yet.

mod append;
mod bids;
mod change;
mod check;
mod codes;
mod data_set;
mod events;
mod folder;
mod log;
mod participants;
mod physio;
mod read;
mod recorder;
mod telemetry;

use std::io;
use std::path::PathBuf;

pub use change::{ChangeError, Renaming, exclude, rename};
pub use codes::{KnownCode, alike_codes};
pub use data_set::{DataSet, DataSetError, recorded_sessions};
pub use folder::Folder;
pub use log::{Entry, LogLine};
pub use participants::Exclusion;
pub use read::RecordedSession;
pub use recorder::{DeviceReport, ProgramVersion, Recorder, SessionInfo};

/// Why data cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The operating system does not let a file be written.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The operating system does not let a file of a session be written of which trials are recorded.
    #[error(
        "{}: {error}. What was recorded before is whole; --resume goes on when {}",
        path.display(),
        if is_full(error) { "there is room" } else { "the file can be written" }
    )]
    FileOfTrials {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The operating system does not let a file be read.
    #[error("{}: {error}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// Another program records the same session.
    #[error("{}: another program records this session", .0.display())]
    InUse(PathBuf),
    /// There are data of this participant and task.
    #[error(
        "{}: this participant has done this task; --resume goes on where it was interrupted, another --out or --participant \
         begins anew",
        .0.display()
    )]
    Exists(PathBuf),
    /// There are data of a participant whose code differs in capital letters only; on some computers both have one folder.
    #[error(
        "participant {given}: there are data of {known}; allowed is {known} itself, or a code that differs in more than capital letters"
    )]
    AlikeCode {
        /// The code that was given.
        given: String,
        /// The one that is there.
        known: String,
    },
    /// What was recorded belongs to another seed, plan or kind of participant.
    #[error("{}: recorded with {what} {recorded}; given is {given}", path.display())]
    OtherSession {
        /// The file that says so.
        path: PathBuf,
        /// What differs.
        what: &'static str,
        /// Its value there.
        recorded: String,
        /// Its value now.
        given: String,
    },
    /// The session file that is given says something else than the recorded one.
    #[error(
        "{}: {}; a session goes on with what it began with: give the file that was recorded",
        path.display(),
        if *is_as_recorded {
            "the session file that is given says something else than this one, which was recorded, not in comments only"
        } else {
            "this is not the session file that was recorded, and neither is the one that is given"
        }
    )]
    OtherFile {
        /// The session file in the data set.
        path: PathBuf,
        /// Whether it is still the one that was recorded.
        is_as_recorded: bool,
    },
    /// There is nothing to go on with.
    #[error("{}: there is no session to resume", .0.display())]
    Missing(PathBuf),
    /// A file does not say what it should.
    #[error("{}:{line}: {problem}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
}

/// Whether a file cannot be written because there is no room.
fn is_full(error: &io::Error) -> bool {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    matches!(error.kind(), StorageFull | QuotaExceeded | FileTooLarge)
}

/// Whether there is a file of this name. One that cannot be looked at is an error, not an absent one.
fn is_there(path: &std::path::Path) -> Result<bool, RecordingError> {
    path.try_exists().map_err(unreadable(path))
}

/// Names the file of an error of the operating system.
fn error_at(path: &std::path::Path) -> impl Fn(io::Error) -> RecordingError + '_ {
    move |error| RecordingError::File { path: path.into(), error }
}

/// The same of a file that is read.
fn unreadable(path: &std::path::Path) -> impl Fn(io::Error) -> RecordingError + '_ {
    move |error| RecordingError::Unreadable { path: path.into(), error }
}
