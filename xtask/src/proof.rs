//! Checks of the image's machine code.
use anyhow::Result;

use crate::firmware::Fingers;
use crate::process::Invocation;
use crate::setup::{self, Needs, Permission};

/// `cargo xtask proof`
pub fn run(permission: Permission, fingers: Fingers, code_only: bool) -> Result<()> {
    let needs = Needs {
        emulator: true,
        ..Needs::default()
    };
    setup::prepare(needs, permission)?;
    let mut line = vec![
        "run",
        "--release",
        "--package",
        "image-proof",
        "--",
        "--fingers",
        fingers.name(),
    ];
    if code_only {
        line.push("--code-only");
    }
    permission.choice.handed_to(Invocation::cargo(line)).run()
}
