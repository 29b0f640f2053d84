//! libFuzzer on the target that `FUZZ_TARGET` names.
#![no_main]

use std::sync::OnceLock;

use fuzz::{TARGETS, Target};
use libfuzzer_sys::{Corpus, fuzz_target};

static TARGET: OnceLock<Target> = OnceLock::new();

/// The target that `FUZZ_TARGET` names. Ends the process if there is none.
fn target() -> &'static Target {
    TARGET.get_or_init(|| {
        let name = std::env::var("FUZZ_TARGET").unwrap_or_default();
        let known = TARGETS.iter().find(|target| target.name == name);
        *known.unwrap_or_else(|| {
            let names: Vec<_> = TARGETS.iter().map(|target| target.name).collect();
            eprintln!("FUZZ_TARGET = {name:?}; known are {}", names.join(", "));
            std::process::exit(2)
        })
    })
}

fuzz_target!(|input: &[u8]| -> Corpus {
    let target = target();
    // Describes every input before it is run.
    if std::env::var_os("FUZZ_SHOW").is_some() {
        eprintln!("{}", (target.show)(input));
    }
    if (target.run)(input) { Corpus::Keep } else { Corpus::Reject }
});
