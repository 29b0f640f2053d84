//! `hil-sim embedded-tests`: the tests of an image on an emulated board without wiring, as `probe-rs run` runs them on a real one.

use std::path::PathBuf;

use anyhow::{Context, anyhow};
use clap::Args;
use stm32_emulator::{EmbeddedTest, EmbeddedTests, Machine, Wiring};

use super::Failure;

#[derive(Args)]
pub struct Arguments {
    /// The image, an ELF file built with embedded-test 0.7
    elf: PathBuf,
    /// Run the tests whose name contains this; all if absent
    filter: Option<String>,
    /// The filter is a test's whole name
    #[arg(long)]
    exact: bool,
    /// Print the names and run nothing
    #[arg(long)]
    list: bool,
    /// Run the tests that need a wire or a person, too
    #[arg(long)]
    include_ignored: bool,
}

/// A NUCLEO without anything at its headers, and a host that sends nothing.
struct BareBoard;

impl Wiring for BareBoard {
    fn adc(&mut self, _channel: u8, _now: u64) -> u16 {
        0
    }
    fn pin(&self, _port: u8, _bit: u8) -> Option<bool> {
        None
    }
    fn uart_tx(&mut self, _byte: u8, _at: u64, _baud: u32) {}
}

/// Runs the tests one after the other on the same board; its flash keeps what one of them writes.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let image = EmbeddedTests::from_file(&arguments.elf)
        .with_context(|| arguments.elf.display().to_string())
        .map_err(Failure::input)?;
    let chosen = |test: &&EmbeddedTest| match &arguments.filter {
        Some(name) if arguments.exact => test.name == *name,
        Some(part) => test.name.contains(part),
        None => true,
    };
    let tests: Vec<_> = image.tests.iter().filter(chosen).collect();
    if arguments.list {
        tests.iter().for_each(|test| println!("{}: test", test.name));
        return Ok(());
    }
    let mut machine = Machine::new(&image.firmware, BareBoard).map_err(Failure::run)?;
    let mut failed = Vec::new();
    for test in tests {
        if test.ignored && !arguments.include_ignored {
            println!("test {} ... ignored", test.name);
            continue;
        }
        match test.run(&mut machine, &mut |text| print!("{text}")) {
            Ok(()) => println!("test {} ... ok", test.name),
            Err(why) => {
                println!("test {} ... FAILED: {why}", test.name);
                failed.push(test.name.as_str());
                // A stopped machine does not run on.
                machine = Machine::new(&image.firmware, BareBoard).map_err(Failure::run)?;
            }
        }
    }
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::run(anyhow!("failed: {}", failed.join(", "))))
}
