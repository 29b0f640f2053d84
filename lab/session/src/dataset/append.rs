//! A file that grows.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::{RecordingError, error_at};

/// A file to which whole pieces are appended, and which no other program appends to meanwhile.
#[derive(Debug)]
pub struct AppendFile {
    path: PathBuf,
    file: File,
    bytes: u64,
}

impl AppendFile {
    /// Opens a file, or creates it, and keeps its first `bytes`; what a program that was killed has written after them is
    /// removed. With `alone` no other program can open it so.
    ///
    /// # Errors
    /// The file cannot be opened, is shorter, or another program has it.
    pub fn open(path: &Path, bytes: u64, alone: bool) -> Result<Self, RecordingError> {
        let options = OpenOptions::new().create(true).truncate(false).write(true).clone();
        let mut file = options.open(path).map_err(error_at(path))?;
        if alone {
            lock(&file, path)?;
        }
        let length = file.metadata().map_err(error_at(path))?.len();
        if length < bytes {
            return Err(RecordingError::Content {
                path: path.into(),
                line: 1,
                problem: format!("it has {length} bytes; the log says that {bytes} were recorded"),
            });
        }
        file.set_len(bytes).map_err(error_at(path))?;
        file.seek(SeekFrom::End(0)).map_err(error_at(path))?;
        Ok(Self { path: path.into(), file, bytes })
    }

    /// Refuses a file that another program has opened alone.
    ///
    /// # Errors
    /// It has, or the file cannot be opened.
    pub fn check_alone(path: &Path) -> Result<(), RecordingError> {
        let file = OpenOptions::new().write(true).open(path).map_err(error_at(path))?;
        lock(&file, path)
    }

    /// Appends, and waits until it is on the disk.
    ///
    /// # Errors
    /// There is no room, or the disk does not work.
    pub fn append(&mut self, contents: &[u8]) -> Result<(), RecordingError> {
        let written = self.file.write_all(contents).and_then(|()| self.file.sync_data());
        written.map_err(error_at(&self.path))?;
        self.bytes += contents.len() as u64;
        Ok(())
    }

    /// Its length, bytes.
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// Keeps a file to this program until it is closed.
fn lock(file: &File, path: &Path) -> Result<(), RecordingError> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(RecordingError::InUse(path.into())),
        Err(TryLockError::Error(error)) => Err(error_at(path)(error)),
    }
}
