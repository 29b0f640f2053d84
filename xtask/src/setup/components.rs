//! rustfmt and clippy of the active toolchain.
use anyhow::{Result, bail};

use super::target::RUSTUP_LIMIT;
use crate::process::{Invocation, on_path};

/// The available linting tools.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lints {
    /// `cargo fmt`
    pub rustfmt: bool,
    /// `cargo clippy`
    pub clippy: bool,
}

impl Lints {
    /// Both tools.
    pub const ALL: Self = Self { rustfmt: true, clippy: true };

    fn probe() -> Self {
        let runs = |tool: &str| Invocation::cargo([tool, "--version"]).answer().is_some();
        Self { rustfmt: runs("fmt"), clippy: runs("clippy") }
    }

    /// `command`, such as `cargo doc`, with the environment of `cargo clippy -- -Dwarnings`: it finds the workspace's crates
    /// checked by that, and does not check them again.
    pub fn share_with(self, command: Invocation) -> Invocation {
        let sysroot = Invocation::new("rustc", ["--print", "sysroot"]).answer();
        match sysroot {
            Some(sysroot) if self.clippy => command
                .env("RUSTC_WORKSPACE_WRAPPER", format!("{}/bin/clippy-driver", sysroot.trim()))
                // Clippy's own separator of its arguments, of which the compiler remembers the value.
                .env("CLIPPY_ARGS", "-Dwarnings__CLIPPY_HACKERY__"),
            _ => command,
        }
    }

    fn missing(self) -> Vec<&'static str> {
        let tools = [(self.rustfmt, "rustfmt"), (self.clippy, "clippy")];
        let missing = tools.into_iter().filter(|(there, _)| !there);
        missing.map(|(_, name)| name).collect()
    }

    /// An error if a tool is missing in continuous integration; a developer's machine may lack it.
    fn accept(self, ci: bool) -> Result<Self> {
        let missing = self.missing();
        if ci && !missing.is_empty() {
            bail!("CI is set, and {0} missing: rustup component add {0}", missing.join(" "));
        }
        Ok(self)
    }
}

/// Adds missing tools by rustup. Without them their checks are skipped, except in continuous integration.
pub fn prepare(ci: bool) -> Result<Lints> {
    let found = Lints::probe();
    let missing = found.missing();
    if missing.is_empty() || on_path("rustup").is_none() {
        return found.accept(ci);
    }
    let add = Invocation::new("rustup", ["component", "add"].iter().chain(&missing).copied());
    eprintln!("fetching: {add} (at most {} s)", RUSTUP_LIMIT.as_secs());
    if let Err(error) = add.run_bounded(RUSTUP_LIMIT) {
        eprintln!("{error}");
    }
    Lints::probe().accept(ci)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_tool_is_an_error_in_continuous_integration_only() {
        let no_clippy = Lints { clippy: false, ..Lints::ALL };
        assert_eq!(Lints::ALL.accept(true).unwrap(), Lints::ALL);
        assert_eq!(no_clippy.accept(false).unwrap(), no_clippy);
        let error = no_clippy.accept(true).unwrap_err().to_string();
        assert!(error.contains("rustup component add clippy"), "{error}");
    }
}
