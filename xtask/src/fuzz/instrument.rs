//! Builds the fuzzers with only the product's own crates instrumented.
//!
//! Cargo's `RUSTC_WORKSPACE_WRAPPER` is a program that is called in place of the compiler for members of the workspace, and the
//! artifacts get other names for each path of that program. Here it is this program under another name, which calls the
//! compiler with additional flags. So dependencies are compiled once for both kinds of build, and a stable compiler suffices.
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result};

use super::{create, folder};
use crate::process::{Invocation, SUITE, VIEWS, workspace};

/// Kind of instrumentation that is added to cargo's flags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instrumented {
    /// Counters on the edges of the control flow, for libFuzzer, and every check that a debug build has.
    Fuzzing,
    /// LLVM's source-based coverage.
    Coverage,
}

/// Whether a crate is one of the product's, which are instrumented.
fn is_product(name: &str) -> bool {
    name.starts_with("thermal_") || name == "contact_model"
}

/// Crates with the scene parser, whose comparisons are instrumented, too: that helps to find the keywords of a scene. In the
/// device's crates it would double the time of a tick.
const COMPARED: [&str; 2] = ["thermal_sim", "thermal_plant"];

/// The crate of the fuzzers themselves.
const FUZZERS: &str = "fuzz";

const EDGES: [&str; 4] = [
    "-Cpasses=sancov-module",
    "-Cllvm-args=-sanitizer-coverage-level=4",
    "-Cllvm-args=-sanitizer-coverage-inline-8bit-counters",
    "-Cllvm-args=-sanitizer-coverage-pc-table",
];
const COMPARISONS: &str = "-Cllvm-args=-sanitizer-coverage-trace-compares";
const CHECKS: [&str; 2] = ["-Coverflow-checks=on", "-Cdebug-assertions=on"];
const COVERAGE: &str = "-Cinstrument-coverage";

impl Instrumented {
    const ALL: [Self; 2] = [Self::Fuzzing, Self::Coverage];

    /// Additional flags for a crate; none if it is not instrumented.
    fn flags(self, name: &str) -> Vec<&'static str> {
        match self {
            // The linked program contains the run-time library that writes the counts.
            Self::Coverage if is_product(name) || name == FUZZERS => vec![COVERAGE],
            Self::Fuzzing if is_product(name) => {
                let mut flags = [EDGES.as_slice(), &CHECKS].concat();
                if COMPARED.contains(&name) {
                    flags.push(COMPARISONS);
                }
                flags
            }
            _ => Vec::new(),
        }
    }

    /// The name under which this program acts as the compiler. It contains a hash of the flags, so that cargo rebuilds when
    /// they change.
    fn program(self) -> String {
        let mut hasher = DefaultHasher::new();
        for name in ["thermal_display", COMPARED[0], FUZZERS] {
            self.flags(name).hash(&mut hasher);
        }
        let word = match self {
            Self::Fuzzing => "fuzzing",
            Self::Coverage => "coverage",
        };
        format!("rustc-for-{word}-{:08x}", hasher.finish() as u32)
    }

    /// Builds the fuzzers and returns the path of the program.
    pub fn build(self) -> Result<PathBuf> {
        let wrapper = folder().join(self.program());
        create(&folder())?;
        // This program may have been rebuilt since.
        let _ = std::fs::remove_file(&wrapper);
        let this = std::env::current_exe().context("this program's own path")?;
        std::fs::hard_link(&this, &wrapper)
            .or_else(|_| std::fs::copy(&this, &wrapper).map(|_| ()))
            .with_context(|| format!("{}: cannot be made", wrapper.display()))?;
        // The whole workspace is selected for the features of the dependencies, with which all other programs compile them.
        let features = format!("fuzz/libfuzzer,{VIEWS}");
        let line = ["build", "--profile", SUITE, "--workspace", "--bin", "fuzz", "--features"];
        Invocation::cargo(line)
            .args([features])
            .env("RUSTC_WORKSPACE_WRAPPER", wrapper.to_string_lossy())
            .run_to_stderr()?;
        Ok(workspace().join("target/suite/fuzz"))
    }
}

/// Calls the compiler and returns its status, if this program was started under the name of an instrumenting compiler.
pub fn compile_if_called_as_compiler() -> Option<ExitCode> {
    let mut args = std::env::args_os();
    let name = PathBuf::from(args.next()?);
    let name = Path::new(name.file_name()?).to_string_lossy().into_owned();
    let kind = Instrumented::ALL.into_iter().find(|kind| kind.program() == name)?;
    let compiler = args.next()?;
    let args: Vec<_> = args.collect();
    let place = args.iter().position(|arg| arg == "--crate-name");
    let crate_name = place.and_then(|place| args.get(place + 1)).cloned();
    let flags = kind.flags(&crate_name.unwrap_or_default().to_string_lossy());
    let status = Command::new(&compiler).args(&args).args(flags).status();
    Some(match status {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{}: {error}", compiler.display());
            ExitCode::FAILURE
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_products_crates_are_instrumented() {
        assert!(Instrumented::Fuzzing.flags(FUZZERS).is_empty());
        for kind in Instrumented::ALL {
            assert!(kind.flags("build_script_build").is_empty());
            assert!(!kind.flags("thermal_display").is_empty());
        }
        assert_ne!(Instrumented::Fuzzing.program(), Instrumented::Coverage.program());
    }
}
