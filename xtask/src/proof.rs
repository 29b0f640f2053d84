//! Checks of the image's machine code.
use anyhow::Result;

use crate::firmware::Fingers;
use crate::process::Invocation;
use crate::setup::{self, Needs, Permission};

/// `cargo xtask proof`
pub fn run(permission: Permission, fingers: Fingers, code_only: bool) -> Result<()> {
    setup::prepare(Needs::EMULATOR, permission)?;
    let mut proof = Invocation::run_package("image-proof", ["--fingers", fingers.name()]);
    if code_only {
        proof = proof.args(["--code-only"]);
    }
    permission.choice.handed_to(proof).run()
}
