//! Fuzz targets: every interface of the product that takes bytes, text or samples from outside.
//!
//! | target     | input                                                      | property that is checked                                     |
//! |------------|------------------------------------------------------------|--------------------------------------------------------------|
//! | `wire`     | bytes to the line reader, with ticks and touches between   | the checks of `device.rs` on answers, outputs and states     |
//! | `station`  | samples, lines, faults                                     | the same, on every tick                                      |
//! | `settings` | values of `set` lines, then samples                        | they read back; no reading errs by more than 2.8 K           |
//! | `flash`    | damage, records and interrupted saves in settings' sectors | only what was written is read; a save always succeeds again  |
//! | `scene`    | text of a scene                                            | an error names file and line; an accepted scene has a plant  |
//!
//! In all of them a panic, an integer overflow or a hang is a failure. `cargo xtask fuzz` runs them. [`Target::run`] is a
//! pure function, so that a recorded input replays exactly.

mod device;
mod flash;
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
pub const TARGETS: [Target; 5] = [
    Target {
        name: "wire",
        run: wire::run,
        show: wire::show,
    },
    Target {
        name: "station",
        run: station::run,
        show: station::show,
    },
    Target {
        name: "settings",
        run: settings::run,
        show: settings::show,
    },
    Target {
        name: "flash",
        run: flash::run,
        show: flash::show,
    },
    Target {
        name: "scene",
        run: scene::run,
        show: scene::show,
    },
];
