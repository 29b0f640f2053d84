//! Codes of participants that are taken, or look like ones that are.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use super::folder::participant_folders;
use super::read::read_info;
use super::recorder::INFO;
use super::{Folder, RecordingError, is_there, unreadable};

/// A participant of a data set whose code looks like another one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KnownCode {
    /// The code that looks alike: the participant's, or one that it had before it was renamed.
    pub alike: String,
    /// The participant's code.
    pub code: String,
}

/// The participants of a data set whose codes, or former ones, look like a code that has no data yet: the same after letters
/// that look like digits are read as these and leading zeros are dropped, such as `1`, `01` and `O1`. Codes that differ in case
/// only are not among them; they are refused when a session is recorded.
///
/// # Errors
/// The data set cannot be read.
pub fn alike_codes(root: &Path, code: &str) -> Result<Vec<KnownCode>, RecordingError> {
    let known = participant_folders(root)?;
    let mut alike = Vec::new();
    if known.iter().any(|known| known == code) {
        return Ok(alike);
    }
    for participant in known {
        let mut names = vec![participant.clone()];
        for folder in Folder::all_of(root, &participant)? {
            // A session that cannot be read is no reason not to record another one.
            let renamed = read_info(&folder).map_or(Vec::new(), |info| info.renamed);
            names.extend(renamed.into_iter().map(|renamed| renamed.from));
        }
        let found = names.into_iter().find(|name| name == code || looks_like(name, code));
        alike.extend(found.map(|alike| KnownCode { alike, code: participant }));
    }
    Ok(alike)
}

/// Whether people may take one code for another, but for case alone.
fn looks_like(one: &str, other: &str) -> bool {
    let is_same = |letters_are_digits: bool| {
        shape(one, letters_are_digits) == shape(other, letters_are_digits)
    };
    !one.eq_ignore_ascii_case(other) && (is_same(false) || is_same(true))
}

/// A code as it looks: in capital letters, those that look like digits replaced by these, and without the leading zeros of its
/// numbers. Whether a zero leads depends on what stands before it: the S of `S01` is a letter, or a 5.
fn shape(code: &str, letters_are_digits: bool) -> String {
    let mut shape = String::new();
    let mut is_in_number = false;
    let mut rest = code.chars().peekable();
    while let Some(written) = rest.next() {
        let seen = seen_as(written);
        let leads = seen == '0' && !is_in_number;
        let goes_on = rest.peek().is_some_and(|next| seen_as(*next).is_ascii_digit());
        if leads && goes_on {
            continue;
        }
        shape.push(seen);
        is_in_number = if letters_are_digits { seen } else { written }.is_ascii_digit();
    }
    shape
}

/// The digit that a letter looks like; other letters as capitals.
fn seen_as(letter: char) -> char {
    match letter.to_ascii_uppercase() {
        'O' | 'Q' => '0',
        'I' | 'L' => '1',
        'Z' => '2',
        'S' => '5',
        'G' => '6',
        'B' => '8',
        other => other,
    }
}

impl Folder {
    /// Refuses a code that differs from one with data in capital letters only; `except` is a code that does not count.
    ///
    /// # Errors
    /// There is such a code.
    pub(super) fn check_code(&self, except: Option<&str>) -> Result<(), RecordingError> {
        let given = self.participant();
        let is_alike = |code: &String| {
            code != given && Some(&**code) != except && code.eq_ignore_ascii_case(given)
        };
        match participant_folders(self.root())?.into_iter().find(is_alike) {
            Some(known) => Err(RecordingError::AlikeCode { given: given.into(), known }),
            None => Ok(()),
        }
    }

    /// The code with which the plan of a session was drawn: that which the participant had when it was begun.
    ///
    /// # Errors
    /// The description of the session cannot be read.
    pub fn plan_code(&self) -> Result<String, RecordingError> {
        Ok(match self.renamings()?.first() {
            Some(first) => first.from.clone(),
            None => self.participant().into(),
        })
    }

    /// How the participant of a session was renamed; not at all if the session has no description.
    pub(super) fn renamings(&self) -> Result<Vec<super::Renaming>, RecordingError> {
        Ok(if is_there(&self.source(INFO))? { read_info(self)?.renamed } else { Vec::new() })
    }
}

/// Names in a folder that begin with a word, without it; none if there is no folder.
pub(super) fn names_in(folder: &Path, word: &str) -> Result<Vec<String>, RecordingError> {
    let entries = match fs::read_dir(folder) {
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return Ok(Vec::new());
        }
        entries => entries.map_err(unreadable(folder))?,
    };
    let mut names = Vec::new();
    for entry in entries {
        let name = entry.map_err(unreadable(folder))?.file_name();
        names.extend(name.to_str().and_then(|name| name.strip_prefix(word)).map(str::to_owned));
    }
    names.sort_unstable();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::looks_like;

    #[test]
    fn codes_look_alike_by_letters_that_look_like_digits_and_by_leading_zeros() {
        let alike = [
            ("1", "01"),
            ("1", "001"),
            ("1", "O1"),
            ("1", "o1"),
            ("01", "O1"),
            ("l1", "I1"),
            ("l1", "11"),
            ("P1", "P01"),
            ("P01", "PO1"),
            ("P10", "P1O"),
            ("P10", "PlO"),
            ("p1", "P01"),
            ("S01", "501"),
            ("S01", "S1"),
            ("SO1", "S1"),
            ("B12", "812"),
            ("A2x", "Azx"),
            ("0", "00"),
            ("A1B01", "A01B1"),
        ];
        for (one, other) in alike {
            assert!(looks_like(one, other) && looks_like(other, one), "{one} {other}");
        }
        let distinct = [
            ("1", "2"),
            ("1", "10"),
            ("1", "11"),
            ("1", "100"),
            ("10", "100"),
            ("P1", "R1"),
            ("P1", "1"),
            ("P10", "P01"),
            ("P101", "P11"),
            ("A1", "A1x"),
            // Refused as codes that differ in case only.
            ("p03", "P03"),
            ("p03", "p03"),
        ];
        for (one, other) in distinct {
            assert!(!looks_like(one, other) && !looks_like(other, one), "{one} {other}");
        }
    }
}
