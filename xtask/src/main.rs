//! The front door: set-up, build, demo, test.
fn main() {}
