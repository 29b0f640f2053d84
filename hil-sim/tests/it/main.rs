//! The `hil-sim` command as a user meets it.

mod cli;
mod course;
mod encodings;
mod infrared;
mod roughness;
mod serve;
mod thesis;

use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn hil_sim(arguments: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_hil-sim"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("hil-sim starts");
    // A command that reads nothing closes the pipe.
    let _ = child.stdin.take().expect("a pipe").write_all(input.as_bytes());
    child.wait_with_output().expect("hil-sim ends")
}

fn good(arguments: &[&str], input: &str) -> String {
    let output = hil_sim(arguments, input);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// Exit status 2, nothing on standard output, and the message.
fn refused(arguments: &[&str]) -> String {
    let output = hil_sim(arguments, "");
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
    assert!(output.stdout.is_empty(), "{arguments:?} started something");
    String::from_utf8(output.stderr).expect("text")
}

/// A file or folder of a test's own.
fn temporary(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

type Row = HashMap<String, String>;

/// A golden table, by its path from the package.
fn rows(path: &str) -> Vec<Row> {
    let rows = csv::Reader::from_path(Path::new(env!("CARGO_MANIFEST_DIR")).join(path))
        .expect("golden table")
        .into_deserialize();
    rows.collect::<Result<_, _>>().expect("golden row")
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

/// Status, standard output and standard error.
fn command(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = hil_sim(arguments, "");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code(), text(output.stdout), text(output.stderr))
}
