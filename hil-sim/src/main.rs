//! The `hil-sim` command.
fn main() {}
