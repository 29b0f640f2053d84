//! Programs of `foreign/`: those that others wrote for the chip, and ours on others' drivers. None shares code with the firmware.
//! `cargo xtask soak` runs them, because compiling their drivers takes minutes; the suite runs one of them.

mod embassy;
mod hal_examples;
#[path = "../support/mod.rs"]
mod support;

use std::path::PathBuf;
use std::sync::LazyLock;

use stm32_emulator::{Firmware, Machine};

use support::{Bench, build};

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| build(&["foreign", "--all"]));

/// A machine about to run a program.
fn machine(name: &str) -> Machine<Bench> {
    let firmware = Firmware::from_file(&FOLDER.join(name)).expect("the program is an image");
    Machine::new(&firmware, Bench::default()).expect("the machine powers up")
}

/// Runs to a time since power-up.
fn run_until_ms(machine: &mut Machine<Bench>, ms: u64) {
    let result = machine.run_until_ps(ms * 1_000_000_000);
    result.unwrap_or_else(|stop| panic!("{stop}"));
}

/// Changes of a pin that is an output, with their times in ms; without that which made it an output.
fn edges(machine: &Machine<Bench>, port: u8, bit: u8) -> Vec<(bool, f64)> {
    let changes = machine.wiring().outputs.iter();
    let changes = changes.filter(|(p, b, ..)| (*p, *b) == (port, bit));
    changes
        .skip(1)
        .map(|(.., level, at)| (level.expect("driven"), machine.ps_at(*at) as f64 / 1e9))
        .collect()
}

/// Whether levels alternate.
fn alternate(edges: &[(bool, f64)]) -> bool {
    edges.windows(2).all(|pair| pair[0].0 != pair[1].0)
}

/// Times between edges, ms.
fn intervals(edges: &[(bool, f64)]) -> Vec<f64> {
    edges.windows(2).map(|pair| pair[1].1 - pair[0].1).collect()
}

/// Panics if a time in ms differs from the expected one by more than the instructions around it take.
fn assert_near(what: &str, ms: f64, expected_ms: f64) {
    assert!((ms - expected_ms).abs() < 0.1, "{what}: {ms} ms instead of {expected_ms} ms");
}
