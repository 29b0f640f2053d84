//! Python with mpmath, which the generators of golden data need.
use std::time::Duration;

use anyhow::Result;
use documented_figures::{VIRTUAL_ENVIRONMENT, python_with_mpmath};

use super::Missing;
use crate::process::{Invocation, workspace};

/// Time limit of each command that installs mpmath; pip can hang where the network is filtered.
const LIMIT: Duration = Duration::from_secs(120);

const VENV: Missing = Missing {
    what: "Python 3 with its venv module",
    apt: &["python3", "python3-venv"],
    elsewhere: &[
        "dnf install python3",
        "pacman -S python",
        "brew install python",
    ],
};

/// What [`install_mpmath`] lacks. Debian's Python has no ensurepip without the package of its venv module.
pub fn missing() -> Vec<Missing> {
    let venv = Invocation::new("python3", ["-c", "import ensurepip, venv"]);
    let there = python_with_mpmath().is_some() || venv.answer().is_some();
    super::missing(&[(there, VENV)])
}

/// Installs mpmath in a virtual environment, unless there is a Python that has it.
pub fn install_mpmath() -> Result<()> {
    if python_with_mpmath().is_some() {
        return Ok(());
    }
    let limit_s = LIMIT.as_secs();
    let install = |command: &Invocation| {
        eprintln!("mpmath for the generators of golden data: {command} (at most {limit_s} s)");
        command.run_bounded(LIMIT)
    };
    commands().iter().try_for_each(install)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mpmath_is_installed_below_target_and_not_in_the_systems_python() {
        let [venv, pip] = commands().map(|command| command.to_string());
        assert_eq!(venv, "python3 -m venv --clear target/python");
        assert!(pip.contains("/target/python/bin/python3 -m pip"), "{pip}");
    }
}
