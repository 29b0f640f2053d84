//! Finds the tools that a command needs, and installs missing ones where that is allowed.
mod apt;
mod compilers;
mod components;
mod ngspice;
mod python;
mod target;
mod toolchain;

use anyhow::{Result, bail};

pub use components::Lints;
pub use ngspice::install_ngspice;
pub use python::package_python;
pub use toolchain::{Choice, TARGET, Toolchain};

/// The environment variable with the choice of the cross toolchain, inherited by calls of `cargo xtask firmware` from
/// other programs.
pub const CHOICE_VARIABLE: &str = "THERMAL_DISPLAY_TOOLCHAIN";

/// What the user allows the set-up to do.
#[derive(Clone, Copy, Debug)]
pub struct Permission {
    /// Install system packages without asking (`--yes`, or continuous integration).
    pub yes: bool,
    /// Which cross toolchain to use.
    pub choice: Choice,
}

/// Tools that a command needs besides the cross target.
#[derive(Clone, Copy, Debug, Default)]
pub struct Needs {
    /// cmake, a C compiler and libclang, to compile the emulator.
    pub emulator: bool,
    /// A C++ compiler, for libFuzzer.
    pub fuzzer: bool,
    /// clippy for the cross target.
    pub lints: bool,
    /// Python with mpmath, for the generators of golden data.
    pub generators: bool,
    /// ngspice, for the simulated circuits.
    pub circuits: bool,
    /// A virtual environment for the package of `python/`.
    pub package: bool,
}

impl Needs {
    /// The emulator only.
    pub const EMULATOR: Self = Self {
        emulator: true,
        fuzzer: false,
        lints: false,
        generators: false,
        circuits: false,
        package: false,
    };
}

/// A missing tool, and the packages that provide it in common package managers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Missing {
    what: &'static str,
    apt: &'static [&'static str],
    /// Other commands that install it, each with one argument.
    elsewhere: &'static [&'static str],
}

/// The tools of a list that are not there.
fn missing(tools: &[(bool, Missing)]) -> Vec<Missing> {
    let missing = tools.iter().filter(|(there, _)| !there);
    missing.map(|(_, tool)| *tool).collect()
}

/// Whether this is continuous integration, where nobody can be asked.
pub fn in_ci() -> bool {
    std::env::var("CI").is_ok_and(|value| !matches!(value.as_str(), "" | "0" | "false"))
}

/// Provides the cross target and the other tools, or fails with what is missing and how to install it.
///
/// Each installation is tried at most once: rustup without asking, because it needs no root; then all missing packages of the
/// distribution together.
pub fn prepare(needs: Needs, permission: Permission) -> Result<Toolchain> {
    let mut rustup_tried = false;
    let mut packages_tried = false;
    loop {
        let found = target::probe();
        let decision = target::decide(permission.choice, &found, needs.lints, rustup_tried);
        if decision == target::Decision::AddWithRustup {
            rustup_tried = true;
            if let Err(error) = target::add_with_rustup() {
                eprintln!("{error}");
            }
            continue;
        }
        let mut missing = compilers::missing(needs);
        let ready = match decision {
            target::Decision::Use(toolchain) => Some(toolchain),
            target::Decision::Lacks(lacks) => {
                missing.extend(lacks);
                None
            }
            target::Decision::AddWithRustup => None,
        };
        match (ready, missing.is_empty()) {
            (Some(toolchain), true) => {
                if needs.generators {
                    python::install_mpmath();
                }
                if needs.circuits {
                    install_ngspice(permission);
                }
                if needs.package {
                    python::install_package_needs(permission);
                }
                eprintln!("cross compiler: {toolchain}");
                return Ok(toolchain);
            }
            _ if packages_tried => {
                bail!("still missing after the installation:\n{}", apt::advice(&missing))
            }
            _ => apt::install(&missing, permission.yes)?,
        }
        packages_tried = true;
    }
}

/// rustfmt and clippy for the host, installed by rustup where it can.
pub fn lints() -> Result<Lints> {
    components::prepare(in_ci())
}
