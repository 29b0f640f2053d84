#![doc = include_str!("../README.md")]

mod device;
mod expected_lines;
mod flash;
mod lines;
mod scene;
mod settings;
mod start;
mod station;
mod tile;
mod wire;

/// A fuzz target.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Name on the command line and of the corpus.
    pub name: &'static str,
    /// Runs one input and panics if a checked property is violated. Returns whether the input is valid, and so may be kept.
    pub run: fn(&[u8]) -> bool,
    /// Describes the input.
    pub show: fn(&[u8]) -> String,
}

/// All targets.
pub const TARGETS: [Target; 6] = [
    Target { name: "wire", run: wire::run, show: wire::show },
    Target { name: "lines", run: lines::run, show: lines::show },
    Target { name: "station", run: station::run, show: station::show },
    Target { name: "settings", run: settings::run, show: settings::show },
    Target { name: "flash", run: flash::run, show: flash::show },
    Target { name: "scene", run: scene::run, show: scene::show },
];
