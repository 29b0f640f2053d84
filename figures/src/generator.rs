//! Generators of committed data: small Python scripts that need mpmath.

use std::process::Command;

/// Runs a generator and returns what it prints. Where Python or mpmath is missing it prints so and returns nothing.
///
/// # Panics
/// The generator fails; with `--check`, because the committed data are not what it writes.
#[track_caller]
pub fn run_generator(script: &str, arguments: &[&str]) -> Option<String> {
    let python = |arguments: &[&str]| Command::new("python3").arg("-B").args(arguments).output();
    if !python(&["-c", "import mpmath"]).is_ok_and(|output| output.status.success()) {
        println!("skipped: {script} needs python3 with mpmath");
        return None;
    }
    let output = python(&[&[script], arguments].concat()).expect("python3");
    assert!(output.status.success(), "{output:#?}");
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}
