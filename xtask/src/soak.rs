//! `cargo xtask soak`: work that takes minutes to hours each, whose results are documented with command and commit.
use std::fmt::Write as _;
use std::fs;
use std::time::Instant;

use anyhow::{Context, Result, bail};

use crate::process::{Invocation, workspace};
use crate::setup::{self, Needs, Permission};

/// One long job.
struct Job {
    name: &'static str,
    /// What it shows.
    title: &'static str,
    /// Arguments of cargo.
    line: &'static str,
}

/// The jobs of `soak_jobs.txt`.
fn jobs() -> Vec<Job> {
    let lines = include_str!("soak_jobs.txt").lines();
    let jobs = lines.filter(|line| !line.starts_with('#'));
    let job = |line: &'static str| {
        let mut fields = line.split(" | ");
        Some(Job { name: fields.next()?, title: fields.next()?, line: fields.next()? })
    };
    jobs.filter_map(job).collect()
}

/// Runs the jobs of these names, or all, and prints a Markdown table of their results; each one's output goes to
/// `target/soak/NAME.txt`. An error names the jobs that failed.
pub fn run(permission: Permission, only: &[String]) -> Result<()> {
    let mut chosen = jobs();
    let known: Vec<_> = chosen.iter().map(|job| job.name).collect();
    if let Some(name) = only.iter().find(|name| !known.contains(&name.as_str())) {
        bail!("--only {name}; known are {}", known.join(", "));
    }
    chosen.retain(|job| only.is_empty() || only.iter().any(|name| name == job.name));
    let needs = Needs { fuzzer: true, ..Needs::EMULATOR };
    setup::prepare(needs, permission)?;
    let folder = workspace().join("target/soak");
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let mut table = heading();
    let mut failed = Vec::new();
    for (number, job) in chosen.iter().enumerate() {
        let command = permission.choice.handed_to(Invocation::cargo(job.line.split(' ')));
        eprintln!("\n[{}/{}] {}: {command}", number + 1, chosen.len(), job.title);
        let path = folder.join(job.name).with_extension("txt");
        let start = Instant::now();
        let done = command.run_with_stdout_in(&path);
        let minutes = start.elapsed().as_secs_f64() / 60.0;
        let text = fs::read_to_string(&path).unwrap_or_default();
        let last = text.lines().rfind(|line| !line.trim().is_empty());
        let last = last.unwrap_or_default().trim().replace('|', "\\|");
        let result = match &done {
            Ok(()) => last,
            Err(error) => format!("**failed**: {error}; {last}"),
        };
        eprintln!("{result}");
        let title = job.title;
        writeln!(table, "| {title} | {result} | {minutes:.1} | `{command}` |")?;
        if done.is_err() {
            failed.push(job.name);
        }
    }
    println!("{table}");
    if !failed.is_empty() {
        bail!("failed: {}", failed.join(", "));
    }
    Ok(())
}

/// `--list`
pub fn list() {
    for Job { name, title, line } in jobs() {
        println!("{name:22}{title}: cargo {line}");
    }
}

/// Commit, compiler and number of cores, and the head of the table.
fn heading() -> String {
    let answer = |program: &str, args: &[&'static str]| {
        let answer = Invocation::new(program, args.iter().copied()).answer();
        answer.map_or_else(|| "unknown".into(), |text| text.trim().to_owned())
    };
    let commit = answer("git", &["describe", "--always", "--dirty", "--abbrev=12"]);
    let compiler = answer("rustc", &["--version"]);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "Commit {commit}, {compiler}, {cores} cores.\n\n\
         | what | result | minutes | command |\n|---|---|---|---|\n"
    )
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_job_has_a_name_of_its_own() {
        let names: BTreeSet<_> = jobs().iter().map(|job| job.name).collect();
        let lines = include_str!("soak_jobs.txt").lines();
        assert_eq!(names.len(), lines.filter(|line| !line.starts_with('#')).count());
    }
}
