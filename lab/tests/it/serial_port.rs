//! A serial port that two want to open; a pseudo-terminal stands in for it.
#![cfg(unix)]

use std::path::PathBuf;

use rustix::fs::{FlockOperation, flock};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use thermal_lab::link::serial;

use crate::command::{self, text};

/// Both ends of a pseudo-terminal: the open one, and the name of the other.
fn pseudo_terminal() -> (std::os::fd::OwnedFd, PathBuf) {
    let end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&end).unwrap();
    unlockpt(&end).unwrap();
    let name = ptsname(&end, Vec::new()).unwrap();
    (end, PathBuf::from(name.to_str().unwrap()))
}

#[test]
fn a_port_is_open_once_in_a_program_and_once_on_a_computer() {
    let (_end, name) = pseudo_terminal();
    let first = serial(&name).unwrap();
    assert_eq!(serial(&name).unwrap_err().to_string(), "already open in this program");
    for line in ["send --port NAME state", "monitor --headless --port NAME", "info --port NAME"] {
        let word = |word| if word == "NAME" { name.to_str().unwrap() } else { word };
        let words: Vec<_> = line.split(' ').map(word).collect();
        let second = command::run(&words);
        assert_eq!(second.status.code(), Some(2), "{line}");
        let said = text(&second.stderr);
        assert!(said.contains("in use by another program"), "{line}: {said}");
    }
    drop(first);
    drop(serial(&name).expect("a port that was closed can be opened again"));
}

/// The lock is the one that pyserial takes with `exclusive=True`: a lock of `flock` on the open file.
#[test]
fn a_port_that_a_python_program_has_locked_is_in_use() {
    let (_end, name) = pseudo_terminal();
    let of_other = std::fs::File::options().read(true).write(true).open(&name).unwrap();
    flock(&of_other, FlockOperation::NonBlockingLockExclusive).unwrap();
    assert_eq!(serial(&name).unwrap_err().to_string(), "in use by another program");
    drop(of_other);
    drop(serial(&name).unwrap());
}
