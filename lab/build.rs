//! Tells the program from which commit it is built, so that data sets can say it.

use std::process::Command;

/// What the program is made of; a change of it may make the working tree differ from the commit.
const SOURCES: [&str; 5] = [".", "../model", "../src", "../hil-sim", "../Cargo.lock"];

fn main() {
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
    }
    // Sources without git, as of a package, have no commit.
    for file in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&["rev-parse", "--git-path", file]) {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    let commit = git(&["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]);
    println!("cargo::rustc-env=THERMAL_LAB_COMMIT={}", commit.unwrap_or_default());
}

/// What git prints.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
