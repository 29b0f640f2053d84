//! `image-proof`: checks the machine code of the release image. Exit status 1 means a violation, or a failed check.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, bail};
use clap::{Parser, ValueEnum};
use image_proof::{Proof, measure};

/// Checks the release image's machine code: panics, stack, loops, floating point; and measures its ticks and its stack
/// in the emulated machine.
#[derive(Parser)]
#[command(name = "image-proof", max_term_width = 100)]
struct Cli {
    /// Number of fingers of the image
    #[arg(long, value_enum, default_value = "1")]
    fingers: Fingers,
    /// Image to check instead of that of the current sources; it must contain its symbols
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Leave out the measurements in the emulator
    #[arg(long)]
    code_only: bool,
}

/// The numbers of fingers for which there is an image.
#[derive(Clone, Copy, ValueEnum)]
enum Fingers {
    #[value(name = "1")]
    One = 1,
    #[value(name = "5")]
    Five = 5,
}

fn main() -> ExitCode {
    match run(&Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("\nerror: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(cli: &Cli) -> Result<()> {
    let fingers = cli.fingers as usize;
    let elf = match &cli.elf {
        Some(elf) => elf.clone(),
        None => stm32_emulator::build(fingers)?,
    };
    let proof = Proof::read(&elf)?;
    let mut sections = proof.check()?;
    if !cli.code_only {
        sections.push(measure::check(&proof, &elf, fingers)?);
    }
    for section in &sections {
        println!("{section}");
    }
    match sections.iter().map(|section| section.violations.len()).sum() {
        0 => Ok(()),
        count => bail!("{count} violations in {}", elf.display()),
    }
}
