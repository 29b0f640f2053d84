//! Generators of committed data: small Python scripts that need mpmath.

use std::process::Command;

/// The environment variable that makes a missing mpmath an error. `cargo xtask test`, whose set-up provides it, sets this.
pub const GENERATORS_REQUIRED: &str = "THERMAL_DISPLAY_GENERATORS_REQUIRED";

/// Below the workspace's root: the virtual environment that the set-up of `cargo xtask test` makes where `python3` lacks mpmath.
pub const VIRTUAL_ENVIRONMENT: &str = "target/python";

/// The interpreter with mpmath: `python3`, else that of the virtual environment.
pub fn python_with_mpmath() -> Option<String> {
    let figures = env!("CARGO_MANIFEST_DIR");
    let installed = format!("{figures}/../{VIRTUAL_ENVIRONMENT}/bin/python3");
    let has_mpmath = |python: &String| {
        let import = Command::new(python).args(["-c", "import mpmath"]).output();
        import.is_ok_and(|output| output.status.success())
    };
    ["python3".into(), installed].into_iter().find(has_mpmath)
}

/// Runs a generator and returns what it prints. Where Python or mpmath is missing it prints so and returns nothing.
///
/// # Panics
/// The generator fails; with `--check`, because the committed data are not what it writes. Or Python or mpmath is missing
/// and [`GENERATORS_REQUIRED`] is set.
#[track_caller]
pub fn run_generator(script: &str, arguments: &[&str]) -> Option<String> {
    let Some(python) = python_with_mpmath() else {
        skip(script, std::env::var_os(GENERATORS_REQUIRED).is_some());
        return None;
    };
    let arguments = [&["-B", script], arguments].concat();
    let output = Command::new(python).args(arguments).output();
    let output = output.expect("python3");
    assert!(output.status.success(), "{output:#?}");
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[track_caller]
fn skip(script: &str, required: bool) {
    let why = "it needs python3 with mpmath, which `cargo xtask test` provides";
    assert!(!required, "{script} must run: {why}");
    println!("skipped {script}: {why}");
}

#[cfg(test)]
mod tests {
    #[test]
    #[should_panic = "generate.py must run: it needs python3 with mpmath"]
    fn a_generator_that_is_required_is_not_skipped() {
        super::skip("generate.py", true);
    }
}
