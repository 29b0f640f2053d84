//! What tests of several kinds of programs share.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use stm32_emulator::{LegState, Wiring};

/// Builds images for the microcontroller by a command of `cargo xtask`, which prints a path; cargo decides what is stale.
pub fn build(command: &[&str]) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .expect("hil-sim/emulator lies in the repository");
    let built = Command::new("cargo")
        .arg("xtask")
        .args(command)
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .expect("cargo runs");
    assert!(built.status.success(), "cargo xtask {}", command.join(" "));
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
