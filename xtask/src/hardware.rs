//! Simulated circuits.
use std::ffi::OsString;

use anyhow::Result;

use crate::process::Invocation;
use crate::setup::{self, Permission};

/// `cargo xtask hardware`
pub fn run(permission: Permission, json: bool, rest: Vec<OsString>) -> Result<()> {
    setup::install_ngspice(permission);
    let mut benches = Invocation::run_package("hardware-benches", rest);
    if json {
        benches = benches.args(["--json"]);
    }
    benches.run()
}
