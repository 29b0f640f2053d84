//! A file that grows.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, SeekFrom, Write};
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};

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

    /// What appends this in another thread, in which a slow disk holds up nobody.
    ///
    /// # Errors
    /// The operating system gives no second handle of the file.
    pub fn append(&mut self, contents: Vec<u8>) -> Result<Append, RecordingError> {
        let file = self.file.try_clone().map_err(error_at(&self.path))?;
        self.bytes += contents.len() as u64;
        Ok(Append { path: self.path.clone(), file, contents })
    }

    /// Its length with what is still to be appended, bytes.
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// A piece that is to be appended to a file.
#[derive(Debug)]
pub struct Append {
    path: PathBuf,
    file: File,
    contents: Vec<u8>,
}

impl Append {
    /// Appends it, and waits until it is on the disk.
    fn execute(mut self) -> Result<(), RecordingError> {
        let written = self.file.write_all(&self.contents).and_then(|()| self.file.sync_data());
        written.map_err(error_at(&self.path))
    }
}

/// Appends in a thread of its own. Whoever drops it waits for the disk.
#[derive(Debug, Default)]
pub struct Writing(Option<JoinHandle<Result<(), RecordingError>>>);

impl Writing {
    /// Begins to append these in this order, up to the first that fails, after those before are on the disk.
    ///
    /// # Errors
    /// Those before could not be appended; nothing is appended then.
    pub fn begin(&mut self, pieces: Vec<Append>) -> Result<(), RecordingError> {
        self.wait()?;
        self.0 = Some(thread::spawn(|| pieces.into_iter().try_for_each(Append::execute)));
        Ok(())
    }

    /// Whether there is nothing to wait for.
    pub fn is_done(&self) -> bool {
        self.0.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Waits until everything is on the disk.
    ///
    /// # Errors
    /// There is no room, or the disk does not work. Said once.
    pub fn wait(&mut self) -> Result<(), RecordingError> {
        let thread = self.0.take();
        thread.map_or(Ok(()), |thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)))
    }
}

impl Drop for Writing {
    fn drop(&mut self) {
        // Whoever wants to know has waited for it.
        let _ignored = self.wait();
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

#[cfg(all(test, unix))]
mod tests {
    use std::io::Read;
    use std::os::fd::OwnedFd;

    use super::*;

    /// A pipe takes 64 KiB, and the rest when somebody reads: a disk that is as slow as the test wants.
    #[test]
    fn nobody_waits_for_a_slow_disk_and_its_error_is_reported_once() {
        const BYTES: usize = 1 << 20;
        let (mut reader, writer) = std::io::pipe().unwrap();
        let file = File::from(OwnedFd::from(writer));
        let piece = Append { path: "slow".into(), file, contents: vec![7; BYTES] };
        let mut writing = Writing::default();
        writing.begin(vec![piece]).unwrap();
        assert!(!writing.is_done());
        let mut read = vec![0; BYTES];
        reader.read_exact(&mut read).unwrap();
        // A pipe is on no disk.
        assert!(writing.wait().unwrap_err().to_string().starts_with("slow: "));
        assert!(writing.wait().is_ok());
        assert_eq!(read, vec![7; BYTES]);
    }
}
