//! Coverage of the sources by the inputs, by LLVM's source-based coverage.
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use super::instrument::Instrumented;
use super::{Target, create, folder, found};
use crate::process::{Invocation, workspace};

/// Folders of the sources under test.
const SOURCES: [&str; 3] = ["src", "model/src", "hil-sim/sim/src/scene"];

/// Runs all inputs and prints the coverage of each source file.
pub fn report(targets: &[Target]) -> Result<()> {
    let tools = tools()?;
    let program = Instrumented::Coverage.build()?;
    let profiles = folder().join("profiles");
    let _ = std::fs::remove_dir_all(&profiles);
    create(&profiles)?;
    let mut raw = Vec::new();
    for target in targets {
        let profile = profiles.join(format!("{}.profraw", target.name()));
        let status = Command::new(&program)
            .current_dir(workspace())
            .env("FUZZ_TARGET", target.name())
            .env("LLVM_PROFILE_FILE", &profile)
            .arg("-runs=0")
            .arg(found(*target)?)
            .args(target.seeds())
            .status()
            .context("the fuzzer did not start")?;
        if !status.success() {
            bail!("{}: an input fails ({status})", target.name());
        }
        raw.push(profile);
    }
    let merged = profiles.join("all.profdata");
    let mut merge = Command::new(tools.join("llvm-profdata"));
    run(merge.args(["merge", "-o"]).arg(&merged).args(&raw))?;
    let mut show = Command::new(tools.join("llvm-cov"));
    show.current_dir(workspace())
        .args(["report", "-show-functions=false", "-instr-profile"])
        .arg(&merged)
        .arg(&program)
        .args(SOURCES.map(|folder| workspace().join(folder)));
    run(&mut show)
}

fn run(command: &mut Command) -> Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().with_context(|| format!("{name}: did not start"))?;
    if !status.success() {
        bail!("{name} failed ({status})");
    }
    Ok(())
}

/// The folder of the LLVM tools of this compiler; tools of another version cannot read its profiles.
fn tools() -> Result<PathBuf> {
    let ask = |args: &[&'static str]| Invocation::new("rustc", args.iter().copied()).answer();
    let root = ask(&["--print", "sysroot"]).context("rustc --print sysroot")?;
    let host = ask(&["--print", "host-tuple"]).context("rustc --print host-tuple")?;
    let folder = Path::new(root.trim()).join("lib/rustlib").join(host.trim()).join("bin");
    if !folder.join("llvm-cov").is_file() {
        bail!("{}: no llvm-cov there; rustup component add llvm-tools", folder.display());
    }
    Ok(folder)
}
