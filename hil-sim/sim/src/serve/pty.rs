//! A served device's line as a pseudo-terminal, which programs open as a serial port.

use std::ffi::OsStr;
use std::fs::File;
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;
use std::time::Duration;

use rustix::fs::{Mode, OFlags, fcntl_setfl, open};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use super::ClientLine;
use super::client::{IncomingBytes, OutgoingBytes};

/// The end of a pseudo-terminal that no program opens.
#[derive(Debug)]
pub struct PtyLine {
    file: File,
    incoming: IncomingBytes,
    /// Programs that have opened it so far, and whether one has it open.
    clients: u64,
    connected: bool,
    outgoing: OutgoingBytes,
}

impl PtyLine {
    /// Opens a pseudo-terminal; also returns the path of the end for programs.
    ///
    /// # Errors
    /// The operating system has no pseudo-terminal.
    pub fn open() -> io::Result<(Self, PathBuf)> {
        let file = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&file)?;
        unlockpt(&file)?;
        let path = ptsname(&file, Vec::new())?;
        // A program that does not set the terminal up, as `cat`, shall read the bytes as they are and without an echo. The
        // settings stay after this end is closed.
        let programs_end = open(path.as_c_str(), OFlags::RDWR | OFlags::NOCTTY, Mode::empty())?;
        let mut settings = tcgetattr(&programs_end)?;
        settings.make_raw();
        tcsetattr(&programs_end, OptionalActions::Now, &settings)?;
        fcntl_setfl(&file, OFlags::RDWR | OFlags::NONBLOCK)?;
        let line = Self {
            file: file.into(),
            incoming: IncomingBytes::default(),
            clients: 0,
            connected: false,
            outgoing: OutgoingBytes::default(),
        };
        Ok((line, PathBuf::from(OsStr::from_bytes(path.as_bytes()))))
    }
}

impl ClientLine for PtyLine {
    fn poll(&mut self) -> Option<u64> {
        // Reading fails while no program has the other end open.
        let connected = self.incoming.receive(&mut self.file);
        if connected && !self.connected {
            self.outgoing = OutgoingBytes::default();
            self.clients += 1;
        }
        if connected {
            self.outgoing.flush(&mut self.file);
        }
        self.connected = connected;
        connected.then_some(self.clients)
    }

    fn read(&mut self, limit: usize) -> Vec<u8> {
        self.incoming.take(limit)
    }

    fn write(&mut self, bytes: &[u8], patience: Duration) -> usize {
        if !self.connected {
            // The terminal would keep them for the next program.
            return 0;
        }
        self.outgoing.send(&mut self.file, bytes, patience)
    }
}
