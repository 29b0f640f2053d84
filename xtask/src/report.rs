//! Commands of other packages that measure and write a report.
use std::ffi::OsString;
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::process::Invocation;
use crate::setup::{self, Needs, Permission};

/// Runs a command of a package; a relative `out` is relative to the caller's folder.
pub fn run(
    permission: Permission,
    (package, command): (&str, &str),
    json: bool,
    out: Option<PathBuf>,
    rest: Vec<OsString>,
) -> Result<()> {
    let out = out.map(|folder| {
        // Commands run in the workspace's root.
        std::path::absolute(&folder).with_context(|| format!("--out {}", folder.display()))
    });
    let out = out.transpose()?;
    let needs = Needs {
        emulator: true,
        fuzzer: false,
        lints: false,
    };
    setup::prepare(needs, permission)?;
    let mut line: Vec<OsString> = ["run", "--release", "--package", package, "--", command]
        .map(OsString::from)
        .into();
    if json {
        line.push("--json".into());
    }
    if let Some(folder) = out {
        line.extend(["--out".into(), folder.into()]);
    }
    line.extend(rest);
    permission.choice.handed_to(Invocation::cargo(line)).run()
}
