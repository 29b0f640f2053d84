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

const JOBS: [Job; 13] = [
    Job {
        name: "kernel",
        title: "kernel at every input",
        line: "run --release -p contact-model --example verify",
    },
    Job {
        name: "fuzz",
        title: "a million executions of each fuzz target",
        line: "xtask fuzz --runs 1000000",
    },
    Job {
        name: "faults",
        title: "every single fault at 8 moments",
        line: "hil-sim faults --moments 8",
    },
    Job {
        name: "campaigns",
        title: "1000 random fault campaigns on the image",
        line: "hil-sim faults --campaign 1000 --seed 102",
    },
    Job {
        name: "campaigns-native",
        title: "9000 random fault campaigns, native",
        line: "hil-sim faults --campaign 9000 --engine native --seed 101",
    },
    Job {
        name: "campaigns-other-seed",
        title: "1000 random fault campaigns of another seed, native",
        line: "hil-sim faults --campaign 1000 --engine native --seed 104",
    },
    Job {
        name: "use",
        title: "2 hours of use without a fault on the image",
        line: "hil-sim faults --normal 2 --seed 103",
    },
    Job {
        name: "use-native",
        title: "100 hours of use without a fault, native",
        line: "hil-sim faults --normal 100 --engine native --seed 103",
    },
    Job {
        name: "pairs",
        title: "pairs of faults, native",
        line: "hil-sim faults --pairs --engine native",
    },
    Job {
        name: "flips",
        title: "1000 bit flips of the running image",
        line: "hil-sim faults --flips 1000 --seed 1",
    },
    Job {
        name: "commissioning",
        title: "commissioning of 200 devices of the parameter box",
        line: "hil-sim commission --box 200",
    },
    Job {
        name: "fidelity",
        title: "fidelity of 1000 plants of the parameter box, native",
        line: "hil-sim fidelity --box 1000",
    },
    Job {
        name: "mutations",
        title: "each fault detector disabled in turn",
        line: "xtask faults --mutations",
    },
];

/// Runs the jobs of these names, or all, and prints a Markdown table of their results; each one's output goes to
/// `target/soak/NAME.txt`. An error names the jobs that failed.
pub fn run(permission: Permission, only: &[String]) -> Result<()> {
    if let Some(name) = only.iter().find(|name| find(name).is_none()) {
        let known = JOBS.map(|job| job.name).join(", ");
        bail!("--only {name}; known are {known}");
    }
    let needs = Needs {
        emulator: true,
        fuzzer: true,
        lints: false,
    };
    setup::prepare(needs, permission)?;
    let folder = workspace().join("target/soak");
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let chosen = JOBS
        .iter()
        .filter(|job| only.is_empty() || only.iter().any(|name| name == job.name));
    let chosen: Vec<_> = chosen.collect();
    let mut table = heading();
    let mut failed = Vec::new();
    for (number, job) in chosen.iter().enumerate() {
        let command = permission
            .choice
            .handed_to(Invocation::cargo(job.line.split(' ')));
        eprintln!(
            "\n[{}/{}] {}: {command}",
            number + 1,
            chosen.len(),
            job.title
        );
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
    for Job { name, title, line } in JOBS {
        println!("{name:22}{title}: cargo {line}");
    }
}

fn find(name: &str) -> Option<&'static Job> {
    JOBS.iter().find(|job| job.name == name)
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
    use super::*;

    #[test]
    fn every_job_has_a_name_of_its_own() {
        for job in &JOBS {
            let same = JOBS.iter().filter(|other| other.name == job.name);
            assert_eq!(same.count(), 1, "{}", job.name);
        }
    }
}
