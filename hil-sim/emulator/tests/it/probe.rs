//! Builds the test images of `probe/` once and runs the cases of the first.
use std::path::PathBuf;
use std::sync::LazyLock;

use stm32_emulator::{Firmware, Machine, Reset, Wiring};

pub use crate::support::Bench;
use crate::support::build;

static FIRMWARE: LazyLock<Firmware> =
    LazyLock::new(|| Firmware::from_file(&PROBE).expect("the probe is an image"));

static PROBE: LazyLock<PathBuf> = LazyLock::new(|| build(&["probe"]));

/// Another program of the probe.
pub fn program(name: &str) -> Firmware {
    Firmware::from_file(&PROBE.with_file_name(name)).expect("the program is an image")
}

/// A machine about to run a case.
pub fn machine(case: u8) -> Machine<Bench> {
    let bench = Bench { case, ..Bench::default() };
    Machine::new(&FIRMWARE, bench).expect("the machine powers up")
}

/// The only reset after power-up.
pub fn only_reset(machine: &Machine<Bench>) -> Reset {
    let [_, reset] = machine.resets() else { panic!("{:?}", machine.resets()) };
    *reset
}

/// The image.
pub fn firmware() -> &'static Firmware {
    &FIRMWARE
}

/// Words at the image's static `name`.
pub fn words<W: Wiring + 'static>(machine: &Machine<W>, name: &str, count: usize) -> Vec<u32> {
    words_of(&FIRMWARE, machine, name, count)
}

/// Words at the static `name` of another image.
pub fn words_of<W: Wiring + 'static>(
    firmware: &Firmware,
    machine: &Machine<W>,
    name: &str,
    count: usize,
) -> Vec<u32> {
    let address = firmware.symbol(name).expect("the image has the symbol");
    let bytes = machine.memory(address, 4 * count).expect("it lies in memory");
    let (words, _) = bytes.as_chunks();
    words.iter().copied().map(u32::from_le_bytes).collect()
}

/// The log of the image.
pub fn log<W: Wiring + 'static>(machine: &Machine<W>) -> Vec<u32> {
    let used = words(machine, "LOG", 1)[0] as usize;
    words(machine, "LOG", used + 1)[1..].to_vec()
}

/// Runs a case for `cycles` and returns its log.
pub fn run(case: u8, cycles: u64) -> (Machine<Bench>, Vec<u32>) {
    let mut machine = machine(case);
    machine.run_until(cycles).unwrap_or_else(|stop| panic!("case {case}: {stop}"));
    let log = log(&machine);
    (machine, log)
}
