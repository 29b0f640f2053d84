//! Whether what was recorded at a commit is older than the code that it speaks of.

use std::collections::BTreeMap;
use std::process::Command;

use anyhow::{Result, ensure};

use crate::process::workspace;

/// Begin and end of the note that the code has changed since.
const NOTE: (&str, &str) = (" (before later changes of ", ")");

/// What a command measures, as folders. The first row that names a part of the command counts.
const MEASURED: [(&str, &[&str]); 16] = [
    ("hil-sim thesis", &["hil-sim/thesis", "model"]),
    ("contact-law-fit", &["lab/contact-law", "src", "model", "hil-sim"]),
    ("measure_line", &["python", "lab", "src", "hil-sim"]),
    ("thermal-learner", &["src/learner"]),
    ("xtask hardware", &["hardware"]),
    ("contact-model", &["model"]),
    ("xtask firmware", &["src", "model"]),
    ("xtask fuzz", &["src", "tests/fuzz"]),
    ("thermal-lab predict", &["lab/participant", "lab/statistics", "lab/sessions"]),
    ("thermal-lab", &["lab", "src", "model", "hil-sim"]),
    ("statistics", &["lab/statistics"]),
    ("--only hostile-line", &["python", "lab", "src", "model", "hil-sim"]),
    ("--only sessions", &["lab", "src", "model", "hil-sim"]),
    ("--only windows", &["lab", "src", "model", "hil-sim"]),
    ("--only cases", &["lab", "hardware", "src", "model", "hil-sim"]),
    ("", &["src", "model", "hil-sim"]),
];

/// What git knows of the age of records.
#[derive(Default)]
pub struct History {
    /// Whether a folder differs between a commit and the present one; `None` if git does not know.
    differs: BTreeMap<(String, &'static str), Option<bool>>,
    /// Whether git did not know a commit.
    pub is_incomplete: bool,
}

impl History {
    /// `COMMIT`, with a note if the files that the command measures are others now. Without the commit, as in a shallow clone, there
    /// is no telling, and no note.
    ///
    /// # Errors
    /// The commit is none.
    pub fn commit_with_note(&mut self, commit: &str, command: &str) -> Result<String> {
        ensure!(
            (7..=40).contains(&commit.len())
                && commit.chars().all(|digit| digit.is_ascii_hexdigit()),
            "'{commit}' is no commit; allowed are 7 to 40 hexadecimal digits"
        );
        let folders = MEASURED.iter().find(|(part, _)| command.contains(part));
        let mut changed = Vec::new();
        for folder in folders.map_or(&[] as &[&str], |(_, folders)| folders) {
            let known = self.differs.entry((commit.to_owned(), folder));
            match known.or_insert_with(|| differs(commit, folder)) {
                Some(true) => changed.push(format!("{folder}/")),
                Some(false) => (),
                None => self.is_incomplete = true,
            }
        }
        if changed.is_empty() || self.is_incomplete {
            return Ok(commit.to_owned());
        }
        let (begin, end) = NOTE;
        Ok(format!("{commit}{begin}{}{end}", changed.join(", ")))
    }
}

/// Whether what is no page in a folder differs between a commit and the present one; `None` if git does not know.
fn differs(commit: &str, folder: &str) -> Option<bool> {
    let diff = Command::new("git")
        .args(["diff", "--quiet", commit, "HEAD", "--", folder, ":(exclude,glob)**/*.md"])
        .current_dir(workspace())
        .stderr(std::process::Stdio::null())
        .status();
    match diff.ok()?.code()? {
        0 => Some(false),
        1 => Some(true),
        _ => None,
    }
}

/// A page without the notes, which say what later commits have changed: a page is not wrong because of these.
pub fn without_notes(page: &str) -> String {
    let mut parts = page.split(NOTE.0);
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + part.split_once(NOTE.1).map_or(part, |(_, rest)| rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_that_differ_by_the_age_of_a_record_are_equal() {
        let old = "at 27fc65d (before later changes of src/, model/) by `x` (simulated)";
        assert_eq!(without_notes(old), "at 27fc65d by `x` (simulated)");
        assert_eq!(without_notes("(at 27fc65d)"), "(at 27fc65d)");
    }

    #[test]
    fn what_is_no_commit_is_refused_and_an_unknown_one_has_no_note() {
        let mut history = History::default();
        assert!(history.commit_with_note("today", "cargo run").is_err());
        assert!(!history.is_incomplete);
        let unknown = history.commit_with_note("0000000", "cargo run").expect("a commit");
        assert_eq!(unknown, "0000000");
        assert!(history.is_incomplete);
    }
}
