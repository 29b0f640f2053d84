//! The committed tables of the fixed-point path against their generator.

use crate::fit;

#[test]
fn committed_tables_are_those_that_the_generator_writes() {
    let again = "run `cargo run --release -p contact-model --example tables`";
    assert!(include_str!("../src/fixed_point/kernel_table.rs") == fit::kernel::table(), "{again}");
    assert!(include_str!("../src/fixed_point/log_table.rs") == fit::log_table(), "{again}");
}
