//! The infrared instrument against golden values, golden values against their generator, and a finger alone against closed forms.

mod infrared;
mod lone_finger;

use documented_figures::run_generator;

#[test]
fn committed_golden_values_are_those_that_the_generator_writes() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/generate.py");
    run_generator(script, &["--check"]);
}
