//! The infrared instrument against golden values, and golden values against their generator.

mod infrared;

use documented_figures::run_generator;

#[test]
fn committed_golden_values_are_those_that_the_generator_writes() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/generate.py");
    run_generator(script, &["--check"]);
}
