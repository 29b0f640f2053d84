//! A serial port for this program alone.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use serial2::SerialPort;

/// The ports that this program has open. The operating system's locks tell a program itself from others by no error.
static OPEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A serial port that no other program that asks first opens too: two that read it would get parts of the lines each.
#[derive(Debug)]
pub struct OwnPort {
    port: SerialPort,
    _claim: Claim,
}

/// A name in [`OPEN`], as long as this value lives.
#[derive(Debug)]
struct Claim(PathBuf);

impl Claim {
    fn new(name: &Path) -> io::Result<Self> {
        let name = fs::canonicalize(name)?;
        let is_new = OPEN.lock().unwrap_or_else(PoisonError::into_inner).insert(name.clone());
        if is_new {
            Ok(Self(name))
        } else {
            Err(io::Error::new(io::ErrorKind::ResourceBusy, "already open in this program"))
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        OPEN.lock().unwrap_or_else(PoisonError::into_inner).remove(&self.0);
    }
}

impl OwnPort {
    /// Opens a port at a baud rate and locks it.
    ///
    /// # Errors
    /// There is no such port, it is in use, or it does not know the baud rate.
    pub fn open(name: &Path, baud: u32) -> io::Result<Self> {
        // A name that has no path in the file system, as on Windows, cannot be opened twice there.
        let claim = if cfg!(unix) { Claim::new(name)? } else { Claim(name.into()) };
        let port = SerialPort::open(name, baud).map_err(busy_in_words)?;
        lock(&port).map_err(busy_in_words)?;
        Ok(Self { port, _claim: claim })
    }

    /// Sets how long a write waits for the port to take bytes.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn set_write_timeout(&mut self, timeout: Duration) -> io::Result<()> {
        self.port.set_write_timeout(timeout)
    }

    /// Sets how long a read waits for the first byte.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn set_read_timeout(&mut self, timeout: Duration) -> io::Result<()> {
        self.port.set_read_timeout(timeout)
    }

    /// Discards what has been received and not read yet, and what has not been sent.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn discard_buffers(&self) -> io::Result<()> {
        self.port.discard_buffers()
    }
}

impl Read for OwnPort {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.port.read(bytes)
    }
}

impl Write for OwnPort {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.port.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.port.flush()
    }
}

/// Takes the lock that pyserial takes, too, and lets no program open the port that does not ask for the lock; only one of the
/// superuser is let through. Both end when the port is closed.
#[cfg(unix)]
fn lock(port: &SerialPort) -> io::Result<()> {
    rustix::fs::flock(port, rustix::fs::FlockOperation::NonBlockingLockExclusive)?;
    rustix::termios::ioctl_tiocexcl(port)?;
    Ok(())
}

/// Other operating systems open a serial port for one program only.
#[cfg(not(unix))]
fn lock(_port: &SerialPort) -> io::Result<()> {
    Ok(())
}

/// The error of a port that another program has, in words; any other error as it is.
fn busy_in_words(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::WouldBlock | io::ErrorKind::ResourceBusy => {
            io::Error::new(io::ErrorKind::ResourceBusy, "in use by another program")
        }
        _ => error,
    }
}
