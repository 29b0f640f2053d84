//! Python: with mpmath, which the generators of golden data need; with what the package of `python/` and its tests need.
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result};
use documented_figures::{VIRTUAL_ENVIRONMENT, python_with_mpmath};

use super::{Missing, Permission, apt};
use crate::process::{Invocation, workspace};

/// Time limit of each command that installs mpmath; pip can hang where the network is filtered.
const LIMIT: Duration = Duration::from_secs(120);

/// Time limit of each command that installs what the package needs: numpy and mypy have 15 MB each.
const PACKAGE_LIMIT: Duration = Duration::from_secs(300);
/// Below the workspace's root: the virtual environment in which the package of `python/` is tested.
const PACKAGE_ENVIRONMENT: &str = "target/python-package";
/// What the package needs, below the workspace's root. The copy in the environment says for which one it was made.
const PACKAGE_NEEDS: &str = "python/pyproject.toml";

const VENV: Missing = Missing {
    what: "Python 3.10 or later with its module venv",
    apt: &["python3-venv"],
    elsewhere: &["dnf install python3", "pacman -S python", "brew install python"],
};

/// Installs mpmath in a virtual environment, unless there is a Python that has it. Where that fails, as without a network,
/// says so: all but the generators can be tested without it.
pub fn install_mpmath() {
    if python_with_mpmath().is_some() {
        return;
    }
    let limit_s = LIMIT.as_secs();
    let install = |command: &Invocation| {
        eprintln!("mpmath for the generators of golden data: {command} (at most {limit_s} s)");
        command.run_bounded(LIMIT)
    };
    if let Err(error) = commands().iter().try_for_each(install) {
        eprintln!(
            "warning: no Python with mpmath; golden data are not compared with their generators\n{error:#}"
        );
    }
}

/// The commands that make the virtual environment anew and install mpmath in it.
fn commands() -> [Invocation; 2] {
    let python = workspace().join(VIRTUAL_ENVIRONMENT).join("bin/python3");
    let pip = "-m pip install --disable-pip-version-check mpmath==1.3.0";
    [
        Invocation::new("python3", ["-m", "venv", "--clear", VIRTUAL_ENVIRONMENT]),
        Invocation::new(&python.to_string_lossy(), pip.split(' ')),
    ]
}

/// Makes the virtual environment for the package of `python/`, unless it is there. Where that fails, as without a network, says
/// so: the package is then not tested.
pub fn install_package_needs(permission: Permission) {
    if package_python().is_some() {
        return;
    }
    if let Err(error) = make_package_environment(permission) {
        println!("skipped python/: its virtual environment cannot be made\n{error:#}");
    }
}

fn make_package_environment(permission: Permission) -> Result<()> {
    if !has_venv() {
        apt::install(&[VENV], permission.yes)?;
    }
    for command in package_commands() {
        let limit_s = PACKAGE_LIMIT.as_secs();
        eprintln!("for the package of python/: {command} (at most {limit_s} s)");
        command.run_bounded(PACKAGE_LIMIT)?;
    }
    let copy = made_for();
    fs::copy(workspace().join(PACKAGE_NEEDS), &copy).with_context(|| copy.display().to_string())?;
    Ok(())
}

/// Whether `python3` is new enough and can make virtual environments; Debian has the module of its own package for that.
fn has_venv() -> bool {
    let check = "import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 10))";
    Invocation::new("python3", ["-c", check]).answer().is_some()
}

/// The commands that make the environment anew and install in it what the package needs to be built, used and tested.
fn package_commands() -> [Invocation; 3] {
    let python = package_interpreter().to_string_lossy().into_owned();
    let pip = |arguments: &str| {
        let line = format!("-m pip install --disable-pip-version-check --quiet {arguments}");
        Invocation::new(&python, line.split(' ').map(String::from))
    };
    [
        Invocation::new("python3", ["-m", "venv", "--clear", PACKAGE_ENVIRONMENT]),
        pip("hatchling"),
        pip("--no-build-isolation ./python[test]"),
    ]
}

fn package_interpreter() -> PathBuf {
    environment().join("bin/python3")
}

fn environment() -> PathBuf {
    workspace().join(PACKAGE_ENVIRONMENT)
}

fn made_for() -> PathBuf {
    environment().join("made-for.toml")
}

/// The interpreter of the virtual environment that has what the package of `python/` needs now.
pub fn package_python() -> Option<String> {
    let needs = |path: &Path| fs::read(path).ok();
    let made_for = needs(&made_for())?;
    let current = needs(&workspace().join(PACKAGE_NEEDS))? == made_for;
    let python = package_interpreter();
    (current && python.is_file()).then(|| python.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mpmath_is_installed_below_target_and_not_in_the_systems_python() {
        let [venv, pip] = commands().map(|command| command.to_string());
        assert_eq!(venv, "python3 -m venv --clear target/python");
        assert!(pip.contains("/target/python/bin/python3 -m pip"), "{pip}");
    }

    #[test]
    fn what_the_package_needs_is_installed_below_target() {
        let [venv, build, needs] = package_commands().map(|command| command.to_string());
        assert_eq!(venv, "python3 -m venv --clear target/python-package");
        for pip in [build, needs] {
            assert!(pip.contains("/target/python-package/bin/python3 -m pip"), "{pip}");
        }
    }
}
