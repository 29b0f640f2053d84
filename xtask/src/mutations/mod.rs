//! Mutation testing of the fault detectors: each is disabled in turn, and the fault matrix must then fail.
//!
//! `table.txt` lists the detectors. One replaced text disables a detector in a copy of the sources, which is built and runs the
//! faults that the detector is for. A mutation that no fault reveals is a gap in the matrix. Bounds that no line and no fault can
//! reach are for unit tests, which run instead.
use std::ffi::OsString;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

use crate::process::{Invocation, SUITE, workspace};

/// How one detector is disabled.
#[derive(Debug, Default)]
struct Mutation {
    detector: &'static str,
    /// Path of the source file in the workspace.
    file: &'static str,
    /// Text that occurs once in the file.
    before: &'static str,
    /// Its replacement.
    after: &'static str,
    /// Kinds of faults that the detector is for.
    faults: Vec<&'static str>,
    /// Engine that runs the faults; detectors in the board's code are in the image only.
    engine: &'static str,
    /// Number of fingers of the device that runs the faults; empty for 1.
    fingers: &'static str,
    /// Instead of faults and engine: package and name of unit tests.
    tests: Option<(&'static str, &'static str)>,
}

impl Mutation {
    fn fingers(&self) -> &'static str {
        if self.fingers.is_empty() { "1" } else { self.fingers }
    }

    fn apply(&self, text: &str) -> Result<String> {
        let Self { detector, file, before, after, .. } = self;
        let count = text.matches(before).count();
        ensure!(
            count == 1,
            "{detector}: `{before}` occurs {count} times in {file} and must occur once; see {TABLE}"
        );
        Ok(text.replacen(before, after, 1))
    }
}

const TABLE: &str = "xtask/src/mutations/table.txt";
const UNCHANGED: &str = "the unchanged sources must pass";
/// Folder of the copied sources and of their builds.
const FOLDER: &str = "target/mutations";
/// Builds that are quick to link, as each runs a few faults only.
const INCREMENTAL: &str = "profile.suite.incremental = true";

/// The mutations of the table.
fn mutations() -> Result<Vec<Mutation>> {
    let mut all = Vec::<Mutation>::new();
    for line in include_str!("table.txt").lines() {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if let Some(name) = line.strip_prefix('[') {
            all.push(Mutation { detector: name.trim_end_matches(']'), ..Mutation::default() });
            continue;
        }
        let last = all.last_mut().context("a line before the first detector")?;
        let (key, value) = line.split_once(' ').context(line)?;
        let value = value.trim();
        match key {
            "file" => last.file = value,
            "before" => last.before = value,
            "after" => last.after = value,
            "faults" => last.faults = value.split(' ').collect(),
            "engine" => last.engine = value,
            "fingers" => last.fingers = value,
            "tests" => last.tests = value.split_once(' '),
            _ => bail!("{TABLE}: unknown key in `{line}`"),
        }
    }
    Ok(all)
}

/// `cargo xtask faults --mutations`, of detectors whose name contains one of these texts, or of all without texts; an error names
/// the mutations that nothing reveals.
pub fn run(names: &[String]) -> Result<()> {
    let mut mutations = mutations()?;
    mutations.retain(|one| names.is_empty() || names.iter().any(|it| one.detector.contains(it)));
    ensure!(!mutations.is_empty(), "no detector has such a name");
    let copy = workspace().join(FOLDER).join("sources");
    copy_sources(&copy)?;
    for (engine, fingers) in [("native", "1"), ("image", "1"), ("image", "5")] {
        let of_device =
            (mutations.iter()).filter(|one| (one.engine, one.fingers()) == (engine, fingers));
        let mut faults: Vec<_> = of_device.flat_map(|one| &one.faults).copied().collect();
        faults.sort_unstable();
        faults.dedup();
        if !faults.is_empty() {
            matrix(&copy, (engine, fingers), &faults).run_to_stderr().context(UNCHANGED)?;
        }
    }
    let mut tests: Vec<_> = mutations.iter().filter_map(|one| one.tests).collect();
    tests.sort_unstable();
    tests.dedup();
    for tests in tests {
        unit_tests(&copy, tests, &[]).run_to_stderr().context(UNCHANGED)?;
    }
    let mut unrevealed = Vec::new();
    for (number, mutation) in mutations.iter().enumerate() {
        eprintln!("mutation {} of {}: {}", number + 1, mutations.len(), mutation.detector);
        let path = copy.join(mutation.file);
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        fs::write(&path, mutation.apply(&text)?)?;
        // A mutation that does not compile would fail the matrix as well, and prove nothing.
        match mutation.tests {
            Some(tests) => unit_tests(&copy, tests, &["--no-run"]),
            None => Invocation::cargo(hil_sim(&copy, "build")),
        }
        .run_to_stderr()?;
        if mutation.engine == "image" {
            let manifest = copy.join("Cargo.toml").into();
            let line = ["run", "--package", "xtask", "--manifest-path"].map(OsString::from);
            let firmware = ["--", "firmware", "--fingers", mutation.fingers()];
            let firmware = firmware.map(OsString::from);
            let line = line.into_iter().chain([manifest]).chain(firmware);
            Invocation::cargo(line).run_to_stderr()?;
        }
        let revealed = match mutation.tests {
            Some(tests) => unit_tests(&copy, tests, &[]),
            None => {
                let device = (mutation.engine, mutation.fingers());
                matrix(&copy, device, &mutation.faults)
            }
        }
        .run_to_stderr()
        .is_err();
        fs::write(&path, text)?;
        println!("{:20} {}", mutation.detector, if revealed { "revealed" } else { "NOT revealed" });
        if !revealed {
            unrevealed.push(mutation.detector);
        }
    }
    ensure!(
        unrevealed.is_empty(),
        "nothing reveals that these are disabled: {}",
        unrevealed.join(", ")
    );
    println!("all {} mutations are revealed", mutations.len());
    Ok(())
}

/// Copies all files that git tracks or would track, but for `.cargo`: cargo also reads the configuration of the folders above
/// the copy, and would apply its flags twice.
fn copy_sources(copy: &Path) -> Result<()> {
    if copy.exists() {
        fs::remove_dir_all(copy).with_context(|| copy.display().to_string())?;
    }
    let list = ["ls-files", "--cached", "--others", "--exclude-standard"];
    let files = Invocation::new("git", list).answer();
    for name in files.context("git cannot list the sources")?.lines() {
        let (from, to) = (workspace().join(name), copy.join(name));
        if name.starts_with(".cargo/") || !from.is_file() {
            continue;
        }
        fs::create_dir_all(to.parent().context("a file has a folder")?)?;
        fs::copy(&from, &to).with_context(|| name.to_owned())?;
    }
    Ok(())
}

/// `cargo COMMAND` for `hil-sim` of the copy.
fn hil_sim(copy: &Path, command: &str) -> Vec<OsString> {
    let options = ["--profile", SUITE, "--package", "hil-sim", "--config", INCREMENTAL];
    let mut line = vec![OsString::from(command)];
    line.extend(options.map(OsString::from));
    line.extend(["--manifest-path".into(), copy.join("Cargo.toml").into()]);
    let target = workspace().join(FOLDER).join("target");
    line.extend(["--target-dir".into(), target.into()]);
    line
}

/// Unit tests of the copy, by package and name, with the overflow checks of their profile.
fn unit_tests(copy: &Path, (package, name): (&str, &str), options: &[&str]) -> Invocation {
    // The tests of the image, which link the emulator, and of the whole system are no unit tests.
    let kind: &[&str] = match package {
        "image-tests" => &["--profile", SUITE, "--test", "image"],
        "system-tests" => &["--profile", SUITE, "--test", "native"],
        _ => &["--lib"],
    };
    let target = workspace().join(FOLDER).join("target");
    if package == "on-target-tests" {
        let line = ["run", "--package", "xtask", "--manifest-path"].map(OsString::from);
        return Invocation::cargo(line)
            .args([copy.join("Cargo.toml")])
            .args(["--", "on-target", "--emulated", "--check", name])
            .args(options.iter().map(OsString::from))
            .env("CARGO_TARGET_DIR", target.to_string_lossy());
    }
    let mut line: Vec<_> =
        [&["test", "--package", package], kind].concat().into_iter().map(OsString::from).collect();
    line.extend(["--manifest-path".into(), copy.join("Cargo.toml").into()]);
    line.extend(["--target-dir".into(), target.into()]);
    line.extend(options.iter().map(OsString::from));
    line.push(name.into());
    Invocation::cargo(line)
}

/// `hil-sim faults` of the copy, with these kinds of faults.
fn matrix(copy: &Path, (engine, fingers): (&str, &str), faults: &[&str]) -> Invocation {
    let mut line = hil_sim(copy, "run");
    let options = ["--", "faults", "--engine", engine, "--moments", "4"];
    line.extend(options.into_iter().chain(["--fingers", fingers]).map(OsString::from));
    line.push("--only".into());
    line.extend(faults.iter().map(OsString::from));
    Invocation::cargo(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_of_every_mutation_occurs_once_in_its_file() {
        let mutations = mutations().unwrap();
        assert!(mutations.len() >= 42, "{}", mutations.len());
        for mutation in mutations {
            let text = fs::read_to_string(workspace().join(mutation.file)).expect(mutation.file);
            let changed = mutation.apply(&text).unwrap();
            assert_ne!(changed, text, "{}", mutation.detector);
            let by_faults =
                ["native", "image"].contains(&mutation.engine) && !mutation.faults.is_empty();
            assert_ne!(by_faults, mutation.tests.is_some(), "{}", mutation.detector);
        }
    }
}
