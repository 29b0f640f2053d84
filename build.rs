//! Passes the folder of `memory.x` to the linker if the firmware is built; host builds need no
//! linker script.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=memory.x");
    if var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "none")
        && let Ok(root) = var("CARGO_MANIFEST_DIR")
    {
        println!("cargo::rustc-link-search={root}");
    }
}
