//! The emulated microcontroller against its reference manuals, under the test image of `probe/`.

mod answers;
mod core;
mod devices;
mod faults;
mod files;
mod foreign;
mod probe;
mod published_cycles;
#[path = "../support/mod.rs"]
mod support;

use documented_figures::run_generator;

#[test]
fn the_table_of_registers_is_what_its_generator_writes() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/src/chip/register_table/generate.py");
    run_generator(script, &["--check"]);
}
