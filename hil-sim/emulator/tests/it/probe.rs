//! Builds the test images of `probe/` once and runs the cases of the first.
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use stm32_emulator::{Firmware, LegState, Machine, Reset, Wiring};

static FIRMWARE: LazyLock<Firmware> =
    LazyLock::new(|| Firmware::from_file(&PROBE).expect("the probe is an image"));

static PROBE: LazyLock<PathBuf> = LazyLock::new(|| build("probe"));

/// Another program of the probe.
pub fn program(name: &str) -> Firmware {
    Firmware::from_file(&PROBE.with_file_name(name)).expect("the program is an image")
}

/// Builds images for the microcontroller by a command of `cargo xtask`, which prints a path; cargo decides what is stale.
pub fn build(command: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .expect("hil-sim/emulator lies in the repository");
    let built = Command::new("cargo")
        .args(["xtask", command])
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .expect("cargo runs");
    assert!(built.status.success(), "cargo xtask {command}");
    PathBuf::from(String::from_utf8_lossy(&built.stdout).trim())
}

/// The circuit at the pins, which records what the image does.
#[derive(Debug, Default)]
pub struct Bench {
    /// Level of port C, which selects the case.
    pub case: u8,
    /// Level of PA6, the break input.
    pub break_pin: Option<bool>,
    /// Level of PA0.
    pub button: Option<bool>,
    /// Bytes received from the image, with their times.
    pub sent: Vec<(u8, u64)>,
    /// Rate of the last byte.
    pub baud: u32,
    /// Channels and times of all conversions.
    pub conversions: Vec<(u8, u64)>,
    /// Changes of general-purpose outputs: port, bit, level, time.
    pub outputs: Vec<(u8, u8, Option<bool>, u64)>,
    /// Changes of the bridge legs.
    pub bridge: Vec<([LegState; 2], u64)>,
}

impl Wiring for Bench {
    fn adc(&mut self, channel: u8, now: u64) -> u16 {
        self.conversions.push((channel, now));
        100 * u16::from(channel) + 7
    }

    fn pin(&self, port: u8, bit: u8) -> Option<bool> {
        match (port, bit) {
            (0, 0) => self.button,
            (0, 6) => self.break_pin,
            (2, 0..8) => Some(self.case >> bit & 1 != 0),
            _ => None,
        }
    }

    fn uart_tx(&mut self, byte: u8, at: u64, baud: u32) {
        self.sent.push((byte, at));
        self.baud = baud;
    }

    fn output(&mut self, port: u8, bit: u8, level: Option<bool>, at: u64) {
        self.outputs.push((port, bit, level, at));
    }

    fn bridge(&mut self, legs: [LegState; 2], at: u64) {
        self.bridge.push((legs, at));
    }
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
