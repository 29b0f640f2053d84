//! What is fuzzed: everything that takes bytes, text or samples from outside.
//!
//! | target     | input                                                    | what must hold                                        |
//! |------------|----------------------------------------------------------|-------------------------------------------------------|
//! | `wire`     | bytes to the line reader, with ticks and touches between | what `device.rs` says of answers, outputs and states  |
//! | `station`  | samples, lines, reasons to trip                          | the same, on every tick                               |
//! | `settings` | values of `set` lines, then samples                      | they read back; no reading is off by more than 2.8 K  |
//! | `flash`    | damage, records and cut saves in the settings' sectors    | nothing is read but what was written; a save mends it |
//! | `scene`    | a scene's text                                           | an error names file and line, a scene has a plant     |
//!
//! And in all: no panic, no overflow of an integer, no hang. `cargo xtask fuzz` runs them; replaying one input is a call of
//! [`Target::run`], a pure function.

mod device;
mod flash;
mod scene;
mod settings;
mod start;
mod station;
mod tile;
mod wire;

/// One thing that is fuzzed.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name on the command line, and that of its corpus.
    pub name: &'static str,
    /// Runs one input; panics if what must hold does not. Returns whether the input is worth keeping.
    pub run: fn(&[u8]) -> bool,
    /// Writes what the input means.
    pub show: fn(&[u8]) -> String,
}

/// All of them.
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
