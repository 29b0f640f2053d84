//! libFuzzer on one of the targets: the one that `FUZZ_TARGET` names.
#![no_main]

use std::sync::OnceLock;

use fuzz::{TARGETS, Target};
use libfuzzer_sys::{Corpus, fuzz_target};

static CHOSEN: OnceLock<Target> = OnceLock::new();

/// Ends the process if there is no such target. With `FUZZ_SHOW` every input is told before it is run.
fn chosen() -> &'static Target {
    CHOSEN.get_or_init(|| {
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
    let target = chosen();
    if std::env::var_os("FUZZ_SHOW").is_some() {
        eprintln!("{}", (target.show)(input));
    }
    if (target.run)(input) {
        Corpus::Keep
    } else {
        Corpus::Reject
    }
});
