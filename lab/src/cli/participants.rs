//! `thermal-lab rename` and `exclude`: participants of a data set, and codes that look alike.

use std::io::{IsTerminal, Write, stderr, stdin};
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use thermal_session::dataset::{ChangeError, alike_codes, exclude, rename};

use super::{Failure, print, run::refused};

/// The data set.
#[derive(Args)]
struct DataSet {
    /// Folder of the data set, as `run` has written it
    #[arg(long = "data", visible_alias = "out", value_name = "DIR", default_value = "data")]
    folder: PathBuf,
}

#[derive(Args)]
pub struct Rename {
    /// Code of the participant
    old: String,
    /// New code, of letters and digits; never a name
    new: String,
    #[command(flatten)]
    data: DataSet,
    #[command(flatten)]
    new_person: NewPerson,
}

#[derive(Args)]
pub struct Exclude {
    /// Code of the participant
    code: String,
    /// Why, in one line; without names, because whoever has the data set reads it
    #[arg(long, value_name = "TEXT")]
    reason: String,
    #[command(flatten)]
    data: DataSet,
}

pub fn run_rename(arguments: &Rename) -> Result<(), Failure> {
    let Rename { old, new, data, new_person } = arguments;
    new_person.check(&data.folder, new, Some(old))?;
    let sessions = rename(&data.folder, old, new).map_err(failure)?;
    print(&format!("participant {old} is {new} now, in {sessions} session(s)"))
}

pub fn run_exclude(arguments: &Exclude) -> Result<(), Failure> {
    let Exclude { code, reason, data } = arguments;
    exclude(&data.folder, code, reason).map_err(failure)?;
    print(&format!("participant {code} is left out of the analyses from now on"))
}

fn failure(error: ChangeError) -> Failure {
    match error {
        ChangeError::File(error) => refused(error),
        error => Failure::input(error),
    }
}

/// Whether a code that looks like another one is that of another person.
#[derive(Args)]
pub struct NewPerson {
    /// The code is that of another person, although it looks like one with data
    #[arg(long)]
    new_person: bool,
}

impl NewPerson {
    /// Asks whether the code is that of another person than those whose codes look like it; `except` does not count.
    pub fn check(&self, data: &Path, code: &str, except: Option<&str>) -> Result<(), Failure> {
        let mut alike = alike_codes(data, code).map_err(refused)?;
        alike.retain(|known| Some(&*known.code) != except);
        if alike.is_empty() || self.new_person {
            return Ok(());
        }
        let names = alike.iter().map(|known| {
            if known.alike == known.code {
                known.code.clone()
            } else {
                format!("{}, whose code was {}", known.code, known.alike)
            }
        });
        let names = names.collect::<Vec<_>>().join("; of ");
        let found = format!(
            "{}: there are data of participant {names}; {code} looks alike",
            data.display()
        );
        let is_another = stdin().is_terminal() && stderr().is_terminal() && {
            asked(&format!("{found}. Is this a new person? [y/n] "))
                .context("standard input")
                .map_err(Failure::run)?
        };
        if is_another {
            return Ok(());
        }
        Err(Failure::input(anyhow!(
            "{found}. The same person needs the same code; --new-person says that it is another person"
        )))
    }
}

/// Asks until the answer is yes or no; no if there is none.
fn asked(question: &str) -> std::io::Result<bool> {
    loop {
        write!(stderr(), "{question}")?;
        let mut answer = String::new();
        if stdin().read_line(&mut answer)? == 0 {
            return Ok(false);
        }
        match answer.trim().to_ascii_lowercase().as_str() {
            "y" | "yes" => return Ok(true),
            "n" | "no" => return Ok(false),
            _ => {}
        }
    }
}
