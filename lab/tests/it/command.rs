//! The command `thermal-lab`, as a shell runs it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The command without words.
pub fn thermal_lab() -> Command {
    Command::new(env!("CARGO_BIN_EXE_thermal-lab"))
}

/// What the command with these words has printed; there is no input.
pub fn run(words: &[&str]) -> Output {
    let output = thermal_lab().args(words).stdin(Stdio::null()).output();
    output.unwrap()
}

pub fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// A scene file of a layered finger on a nominal device, with or without a heat-flux sensor, before an object; `plant` has keys
/// of `[plant]`.
pub fn scene_file(name: &str, material: &str, sensor: bool, plant: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let scene = format!(
        "duration_s = 60.0\nskin_c = 34.0\nroom_c = 24.0\n[object]\nmaterial = \"{material}\"\nstart_c = 24.0\n[device]\n\
         flux_sensor = {sensor}\n[finger]\ntissue = \"layered\"\n[plant]\n{plant}\n"
    );
    fs::write(&path, scene).unwrap();
    path
}
