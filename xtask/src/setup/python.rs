//! Python with mpmath, which the generators of golden data need.
use std::time::Duration;

use documented_figures::{VIRTUAL_ENVIRONMENT, python_with_mpmath};

use crate::process::{Invocation, workspace};

/// Time limit of each command that installs mpmath; pip can hang where the network is filtered.
const LIMIT: Duration = Duration::from_secs(120);

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
