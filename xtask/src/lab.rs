//! `cargo xtask lab`: a whole experiment on a simulated device with a simulated participant, from the session file to the page
//! of its analysis.
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};

use crate::process::{Invocation, workspace};
use crate::step::Steps;

/// The session, and its line for the number of trials in each cell with the one of this demonstration.
const SESSION: &str = "lab/sessions/p5-real-and-simulated.toml";
const REPEAT: (&str, &str) = ("repeat = 4", "repeat = 2");
const OUT: &str = "target/lab";

/// `cargo xtask lab`
pub fn run() -> Result<()> {
    let out = workspace().join(OUT);
    let mut steps = Steps::new(3);
    steps.run("building thermal-lab", "about 2 min the first time", || {
        Invocation::cargo(["build", "--release", "-p", "thermal-lab"]).run_to_stderr()
    })?;
    let session = format!("{OUT}/p5.toml");
    steps.run("running the session with a simulated participant", "", || {
        prepare(&out)?;
        let line = format!(
            "run {session} --simulated --participant 01 --seed 1 --headless --out {OUT}/data"
        );
        Invocation::run_package("thermal-lab", line.split(' ')).run()
    })?;
    steps.run("analysing it", "", || {
        let line = format!("analyse {OUT}/data --out {OUT}/analysis");
        Invocation::run_package("thermal-lab", line.split(' ')).run()
    })?;
    println!("session file: {}", workspace().join(&session).display());
    println!("data set: {}", out.join("data").display());
    println!("page: {}", out.join("analysis/analysis.html").display());
    Ok(())
}

/// An empty folder for the data, and the session with fewer trials. Data of participants whom this program has not simulated
/// stay: then there is no empty folder.
fn prepare(out: &Path) -> Result<()> {
    let others = other_participants(&out.join("data"))?;
    ensure!(
        others.is_empty(),
        "{OUT}/data has data of others than the simulated participant: {}; move or remove that folder",
        others.join(", ")
    );
    for folder in ["data", "analysis"] {
        let folder = out.join(folder);
        if folder.exists() {
            fs::remove_dir_all(&folder).with_context(|| folder.display().to_string())?;
        }
    }
    fs::create_dir_all(out).with_context(|| out.display().to_string())?;
    let path = workspace().join(SESSION);
    let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let (from, to) = REPEAT;
    ensure!(text.contains(from), "{SESSION} has no line '{from}'");
    let file = out.join("p5.toml");
    fs::write(&file, text.replace(from, to)).with_context(|| file.display().to_string())
}

/// The folders of a data set that do not belong to the simulated participant.
fn other_participants(data: &Path) -> Result<Vec<String>> {
    let mut others = Vec::new();
    for folder in [data.to_owned(), data.join("sourcedata")] {
        if !folder.is_dir() {
            continue;
        }
        for entry in fs::read_dir(&folder).with_context(|| folder.display().to_string())? {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if name.starts_with("sub-") && name != "sub-01" && !others.contains(&name) {
                others.push(name);
            }
        }
    }
    others.sort();
    Ok(others)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_of_other_participants_are_named_and_kept() {
        let out = std::env::temp_dir().join(format!("xtask-lab-{}", std::process::id()));
        let own = out.join("data/sourcedata/sub-01");
        fs::create_dir_all(&own).unwrap();
        assert_eq!(other_participants(&out.join("data")).unwrap(), [""; 0]);
        let others = out.join("data/sourcedata/sub-p7/task-p5");
        fs::create_dir_all(&others).unwrap();
        let refused = prepare(&out).unwrap_err().to_string();
        assert!(refused.contains("sub-p7") && own.exists() && others.exists(), "{refused}");
        fs::remove_dir_all(&out).unwrap();
    }
}
