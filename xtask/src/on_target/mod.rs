//! `cargo xtask on-target`: builds the tests of `tests/on-target`, runs them on a board or on the emulated one, and writes the
//! figures that they print into the documentation.
mod page;

use std::ffi::OsString;
use std::io::{IsTerminal, Write};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;

use crate::firmware;
use crate::process::{Invocation, SUITE, VIEWS, on_path, target_folder, workspace};
use crate::setup::{self, Needs, Permission, Toolchain};
use page::Column;

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// On the emulated board, unattended
    #[arg(long)]
    emulated: bool,
    /// Leave the documentation as it is
    #[arg(long)]
    check: bool,
    /// Build the tests and run none
    #[arg(long)]
    no_run: bool,
    /// Run the tests whose name contains this; the documentation stays as it is
    filter: Option<String>,
}

/// What a person must know before the tests run.
const WARNING: &str = "\
The tests drive pins and watchdogs, and replace the stored settings by factory defaults. They are for a bare NUCLEO-F446RE: disconnect
everything from its headers, tile and power stage first.";

/// `cargo xtask on-target`
pub fn run(permission: Permission, options: &Options) -> Result<()> {
    let needs = if options.emulated { Needs::EMULATOR } else { Needs::default() };
    let toolchain = setup::prepare(needs, permission)?;
    if options.no_run {
        println!("{}", build(&toolchain)?);
        return Ok(());
    }
    let filter = options.filter.iter().map(OsString::from);
    let tests = if options.emulated {
        let elf = build(&toolchain)?;
        // The whole workspace is selected for the features of the dependencies, with which the suite has compiled them.
        let line =
            ["build", "--profile", SUITE, "--workspace", "--bin", "hil-sim", "--features", VIEWS];
        Invocation::cargo(line).run_to_stderr()?;
        let hil_sim = target_folder().join(SUITE).join("hil-sim");
        Invocation::new(&hil_sim.to_string_lossy(), ["embedded-tests", &elf]).args(filter)
    } else {
        find_board(permission)?;
        firmware::tests(&toolchain, "test").args(["--"]).args(filter)
    };
    let mut figures = Vec::new();
    tests.run_line_by_line(|line| {
        println!("{line}");
        figures.extend(page::figure(line));
    })?;
    if options.check || options.filter.is_some() {
        return Ok(());
    }
    let column = if options.emulated { Column::Emulated } else { Column::Board };
    let path = workspace().join(page::PATH);
    let text = std::fs::read_to_string(&path).with_context(|| page::PATH.to_owned())?;
    let filled = page::fill(&text, column, &figures, &origin(&toolchain))?;
    std::fs::write(&path, filled).with_context(|| page::PATH.to_owned())?;
    println!("{} figures written to {}", figures.len(), page::PATH);
    Ok(())
}

/// Builds the tests; the path of their image.
fn build(toolchain: &Toolchain) -> Result<String> {
    let mut elf = None;
    firmware::tests(toolchain, "test")
        .args(["--no-run", "--message-format", "json-render-diagnostics"])
        .run_line_by_line(|message| {
            let path = message.split_once("\"executable\":\"");
            elf =
                path.and_then(|(_, rest)| Some(rest.split_once('"')?.0.to_owned())).or(elf.take());
        })?;
    elf.context("cargo names no test program")
}

/// Checks that a board is there, and that its owner agrees.
fn find_board(permission: Permission) -> Result<()> {
    ensure!(
        on_path("probe-rs").is_some(),
        "probe-rs is not installed: cargo install --locked probe-rs-tools; without a board, --emulated runs the same tests"
    );
    let probes = Invocation::new("probe-rs", ["list"]).answer().unwrap_or_default();
    ensure!(
        probes.to_lowercase().contains("st-link"),
        "probe-rs finds no ST-LINK; `probe-rs list` prints: {probes}\nWithout a board, --emulated runs the same tests"
    );
    eprintln!("{WARNING}");
    if permission.yes {
        return Ok(());
    }
    ensure!(std::io::stdin().is_terminal(), "there is no terminal to ask on; --yes agrees");
    eprint!("Is it bare? [y/N] ");
    std::io::stderr().flush()?;
    let mut answer = String::new();
    std::io::stdin().read_line(&mut answer)?;
    if !matches!(answer.trim().to_ascii_lowercase().as_str(), "y" | "yes") {
        bail!("not run");
    }
    Ok(())
}

/// Commit and compiler of the tests.
fn origin(toolchain: &Toolchain) -> String {
    let answer = |invocation: Invocation| invocation.answer().unwrap_or_default().trim().to_owned();
    let commit = answer(Invocation::new("git", ["rev-parse", "--short", "HEAD"]));
    let changed = !answer(Invocation::new("git", ["status", "--porcelain", "-uno"])).is_empty();
    let compiler = answer(toolchain.rustc_version());
    format!("{compiler}, commit {commit}{}", if changed { " with changes" } else { "" })
}
