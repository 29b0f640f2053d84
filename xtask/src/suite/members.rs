//! Packages of the workspace, and which of them the suite builds without the emulator.
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::licences;
use crate::auxiliary_image;
use crate::process::{Invocation, workspace};
use crate::setup::TARGET;

/// The emulator's package of other authors, which needs cmake and libclang.
const EMULATOR: &str = "unicorn-engine";
/// Packages that may depend on it; every other member of the workspace may not. A build of the whole workspace would not
/// notice if one did.
const WITH_EMULATOR: [&str; 5] =
    ["stm32-emulator", "hil-sim", "image-proof", "image-tests", "model-bench"];

/// A package of the workspace.
#[derive(Clone, Debug)]
pub struct Member {
    name: String,
    /// Its folder, relative to the root.
    folder: PathBuf,
}

/// All members.
pub fn all() -> Result<Vec<Member>> {
    let tree = Invocation::cargo("tree --workspace --depth 0 --prefix none".split(' '));
    let tree = tree.answer().context("cargo cannot list the workspace's members")?;
    let lines = tree.lines().filter(|line| !line.is_empty());
    lines.map(member).collect()
}

/// Reads `NAME vVERSION (FOLDER)`, perhaps with a remark such as `(proc-macro)` before the folder.
fn member(line: &str) -> Result<Member> {
    let parts = line.split_once(' ').zip(line.rsplit_once('('));
    let ((name, _), (_, folder)) = parts.with_context(|| format!("no member: {line}"))?;
    let folder = Path::new(folder.trim_end_matches([')', '*', ' ']));
    let folder = folder.strip_prefix(workspace()).context(line.to_owned())?;
    Ok(Member { name: name.into(), folder: folder.into() })
}

impl Member {
    /// Whether it must build without the emulator.
    pub fn is_native(&self) -> bool {
        !WITH_EMULATOR.contains(&self.name.as_str())
    }

    /// Whether it belongs to the model, the firmware or xtask, which compile within seconds.
    pub fn is_small(&self) -> bool {
        let root = Path::new("");
        self.folder == root
            || ["model", "src", "xtask"]
                .map(Path::new)
                .iter()
                .any(|room| self.folder.starts_with(room))
    }
}

/// Cargo's options that choose members.
pub fn options(members: &[Member], chosen: fn(&Member) -> bool) -> String {
    let chosen = members.iter().filter(|member| chosen(member));
    let options: Vec<_> = chosen.map(|member| format!("-p {}", member.name)).collect();
    options.join(" ")
}

/// Checks the dependencies of all members, and their licences; of the command without the emulator, too. An error names a
/// dependency of native members on the emulator, or one whose licence is not allowed.
pub fn check_dependencies(members: &[Member]) -> Result<()> {
    let native = options(members, Member::is_native);
    check_packages(&format!("{native} --all-features"), true)?;
    let emulated = options(members, |member| !member.is_native());
    check_packages(&format!("{emulated} --all-features"), false)?;
    check_packages("--package hil-sim --no-default-features", true)?;
    auxiliary_image::fetch_foreign()?;
    let foreign = auxiliary_image::FOREIGN;
    check_packages(&format!("--manifest-path {foreign} --workspace --all-features"), true)
}

/// Checks the dependencies of the packages that these options of cargo name, for this computer and for the microcontroller.
fn check_packages(options: &str, is_native: bool) -> Result<()> {
    let line = format!(
        "tree {options} --prefix none --edges normal,build,dev --format {} --target host-tuple --target {TARGET}",
        licences::TREE_FORMAT
    );
    let tree = Invocation::cargo(line.split(' ')).answer();
    let tree = tree.with_context(|| format!("`cargo {line}` failed"))?;
    ensure!(
        !is_native || !tree.lines().any(|line| line.starts_with(EMULATOR)),
        "what cargo selects by {options} must not depend on {EMULATOR}: cargo tree {options} -i {EMULATOR}"
    );
    licences::check(&tree, !is_native).with_context(|| format!("cargo tree {options}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the dependencies that this workspace has.
    #[test]
    fn the_licences_of_all_dependencies_are_allowed_and_that_of_the_emulator_is_found() {
        check_dependencies(&all().unwrap()).unwrap();
        let emulator = "--package stm32-emulator";
        assert!(check_packages(emulator, false).is_ok());
        let error = format!("{:#}", check_packages(emulator, true).unwrap_err());
        assert!(error.contains(EMULATOR), "{error}");
    }

    #[test]
    fn members_are_sorted_by_size_and_need_of_the_emulator() {
        let members = all().unwrap();
        let find = |name: &str| members.iter().find(|member| member.name == name).unwrap();
        assert!(find("contact-model").is_small() && find("contact-model").is_native());
        assert!(find("thermal-display").is_small() && find("thermal-display").is_native());
        assert!(!find("system-tests").is_small() && find("system-tests").is_native());
        for name in WITH_EMULATOR {
            assert!(!find(name).is_small() && !find(name).is_native(), "{name}");
        }
    }
}
