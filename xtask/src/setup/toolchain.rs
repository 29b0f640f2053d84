//! The cross toolchains, and how their cargo is called.
use std::fmt;
use std::path::PathBuf;

use super::CHOICE_VARIABLE;
use crate::process::Invocation;

/// The microcontroller's target: Cortex-M4 with FPU.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The compiler of the distribution's packages.
pub const RUSTC: &str = "/usr/bin/rustc";
/// The distribution's cargo.
pub const CARGO: &str = "/usr/bin/cargo";
/// The distribution's clippy, a package of its own.
pub const CARGO_CLIPPY: &str = "/usr/bin/cargo-clippy";

/// Which cross toolchain to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Choice {
    /// The active toolchain if it has the target or rustup can add it, else the distribution's.
    #[default]
    Auto,
    /// The active toolchain only, its target added by rustup if need be.
    Rustup,
    /// The distribution's compiler only, with the core library built from its source.
    Distribution,
}

impl Choice {
    /// Passes the choice on to the calls of `cargo xtask firmware` that `invocation` makes.
    pub fn handed_to(self, invocation: Invocation) -> Invocation {
        let inherited = std::env::var(CHOICE_VARIABLE).unwrap_or(Self::Auto.to_string());
        if inherited == self.to_string() {
            invocation
        } else {
            invocation.env(CHOICE_VARIABLE, self.to_string())
        }
    }
}

/// As the command line takes it.
impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Rustup => "rustup",
            Self::Distribution => "distribution",
        })
    }
}

/// An installed cross toolchain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Toolchain {
    /// The toolchain that runs this program has the target installed.
    Active,
    /// The distribution's compiler.
    Distribution(Distribution),
}

impl Toolchain {
    /// `cargo SUBCOMMAND` with this compiler.
    pub fn cargo(&self, subcommand: &str) -> Invocation {
        match self {
            Self::Active => Invocation::cargo([subcommand]),
            Self::Distribution(distribution) => distribution.cargo(subcommand),
        }
    }

    /// Asks the compiler for its version.
    pub fn rustc_version(&self) -> Invocation {
        let rustc = match self {
            Self::Active => "rustc",
            Self::Distribution(_) => RUSTC,
        };
        Invocation::new(rustc, ["--version"])
    }
}

/// The distribution's compiler, and a linker, which its packages lack.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Distribution {
    /// A linker for the target: the host toolchain's `rust-lld`, or `ld.lld`.
    pub linker: PathBuf,
}

impl Distribution {
    /// The distribution's `cargo SUBCOMMAND` for the target, undisturbed by the toolchain that runs this program.
    pub fn cargo(&self, subcommand: &str) -> Invocation {
        let (program, args) = match subcommand {
            // Called directly: cargo would prefer a clippy in the user's own folder of cargo programs.
            "clippy" => (CARGO_CLIPPY, ["clippy", "-Zbuild-std=core,compiler_builtins"]),
            _ => (CARGO, [subcommand, "-Zbuild-std=core,compiler_builtins"]),
        };
        Invocation::new(program, args)
            .env("RUSTC", RUSTC)
            .env("RUSTC_BOOTSTRAP", "1")
            .env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER", self.linker.to_string_lossy())
            .without(&[
                "RUSTUP_TOOLCHAIN",
                "RUSTDOC",
                "RUSTC_WRAPPER",
                "RUSTC_WORKSPACE_WRAPPER",
                "LD_LIBRARY_PATH",
            ])
            .without(&[
                "CARGO_BUILD_RUSTC",
                "CARGO_BUILD_RUSTC_WRAPPER",
                "CARGO_BUILD_RUSTC_WORKSPACE_WRAPPER",
            ])
            .env("CARGO", CARGO)
    }
}

impl fmt::Display for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Active => write!(f, "the active toolchain with {TARGET}"),
            Self::Distribution(_) => {
                write!(f, "the distribution's {RUSTC}, core library built for {TARGET}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distributions_tools_are_called_by_absolute_paths() {
        let line = Distribution { linker: "/lib/rust-lld".into() }.cargo("build").to_string();
        assert!(line.contains("RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 "), "{line}");
        assert!(
            line.ends_with(" /usr/bin/cargo build -Zbuild-std=core,compiler_builtins"),
            "{line}"
        );
    }
}
