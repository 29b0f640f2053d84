//! `cargo xtask test`: the whole test suite, or the part that is quick enough to run before each commit.
mod lanes;
mod licences;
mod members;

use anyhow::Result;
use documented_figures::{GENERATORS_REQUIRED, python_with_mpmath};

use crate::auxiliary_image;
use crate::firmware::{self, Fingers};
use crate::process::{Invocation, VIEWS, workspace};
use crate::setup::{self, Choice, Lints, Needs, Permission, Toolchain};
use crate::step::Steps;
use lanes::{Check, Lane};
use members::Member;

const NO_CLIPPY: &str = "the active toolchain has no clippy";

/// A check by command lines of cargo.
fn check<const N: usize>(title: &'static str, lines: [&str; N]) -> Check {
    Check { title, commands: Ok(lines.map(cargo).into()) }
}

/// A command line of cargo. Where it runs tests and the set-up has found or installed mpmath, the generators of golden
/// data must run as well.
fn cargo(line: &str) -> Invocation {
    if let Some(line) = line.strip_prefix("xtask ") {
        return Invocation::xtask(line.split(' '));
    }
    let cargo = Invocation::cargo(line.split(' '));
    if line.starts_with("test ") && python_with_mpmath().is_some() {
        cargo.env(GENERATORS_REQUIRED, "1")
    } else {
        cargo
    }
}

/// `check`, or why it is left out.
fn only_if(there: bool, why: &'static str, check: Check) -> Check {
    let commands = if there { check.commands } else { Err(why) };
    Check { commands, ..check }
}

fn formatting(lints: Lints) -> Check {
    let why = "the active toolchain has no rustfmt";
    only_if(lints.rustfmt, why, check("formatting", ["fmt --all --check"]))
}

/// Figures in the documents are those of `docs/figures.toml`, and tests assert them.
fn figures() -> Check {
    check("figures of the documentation", ["xtask docs --check"])
}

/// The package of `python/`, with the interpreter of its virtual environment, at simulated devices of the program that the tests
/// of the workspace have built.
fn package(python: Option<&str>) -> Check {
    let why = "python/ has no virtual environment; the set-up has said why";
    let commands = python.ok_or(why).map(|python| {
        let run = |line: &str| {
            let words = line.split(' ').map(String::from);
            // Nothing but the sources stays in the folder.
            Invocation::new(python, words).env("PYTHONDONTWRITEBYTECODE", "1")
        };
        let hil_sim = workspace().join("target/suite/hil-sim");
        let tests = run("-m pytest -q -c python/pyproject.toml --rootdir python python/tests");
        vec![
            run("-m pip install --disable-pip-version-check --quiet --no-index --no-deps --no-build-isolation \
                 --force-reinstall ./python"),
            run("-m mypy --config-file python/pyproject.toml --cache-dir target/python-package/mypy \
                 python/src python/tests python/examples"),
            tests.env("THERMAL_DISPLAY_HIL_SIM", hil_sim.to_string_lossy()),
        ]
    });
    Check { title: "package for Python", commands }
}

fn units(members: &[Member]) -> Check {
    let small = members::options(members, Member::is_small);
    let line = format!("test --profile suite --quiet {small} --lib --bins --tests");
    check("units of model, firmware and xtask", [&line])
}

/// What a person runs before each commit.
fn quick(members: &[Member], lints: Lints) -> Vec<Vec<Lane>> {
    let small = members::options(members, Member::is_small);
    let clippy = format!("clippy --profile suite {small} --all-targets -- -Dwarnings");
    let small = vec![
        formatting(lints),
        figures(),
        only_if(lints.clippy, NO_CLIPPY, check("lints of model, firmware and xtask", [&clippy])),
        units(members),
    ];
    // The power cuts and flipped bits of stored settings are left out for the sake of the quick suite's time.
    let native = format!(
        "test --profile suite --quiet --workspace --features {VIEWS} --bin generated-tables --test native -- --skip settings_storage"
    );
    vec![vec![
        small,
        vec![check("generated tables, and the native device on the simulated plant", [&native])],
    ]]
}

/// All checks: phases, in each of which lanes run side by side. Programs of the host are compiled in the profile `suite` only,
/// in which integer overflow panics, too.
fn whole(
    toolchain: &Toolchain,
    choice: Choice,
    lints: Lints,
    python: Option<&str>,
) -> Vec<Vec<Lane>> {
    let firmware_lints = lints.clippy || matches!(toolchain, Toolchain::Distribution(_));
    let image = |title, line| Check { title, commands: Ok(vec![choice.handed_to(cargo(line))]) };
    let images = vec![
        image("image for one finger", "xtask firmware"),
        image("image for five fingers", "xtask firmware --fingers 5"),
        image("test image of the emulator", "xtask probe"),
        image("program of others for the emulator", "xtask foreign"),
        image("image of the benchmark", "xtask bench-image"),
        only_if(
            firmware_lints,
            NO_CLIPPY,
            Check {
                title: "lints of the firmware",
                commands: Ok(vec![
                    firmware::clippy(toolchain, Fingers::One),
                    firmware::clippy(toolchain, Fingers::Five),
                    firmware::clippy_of_tests(toolchain),
                    auxiliary_image::clippy_of_probe(toolchain),
                ]),
            },
        ),
    ];
    // The test target of programs of others is not one of `--all-targets`, because the suite does not run it.
    let lints_of_all = [
        "clippy --profile suite --workspace --all-targets -- -Dwarnings",
        "clippy --profile suite --workspace --test foreign -- -Dwarnings",
    ];
    // The whole workspace is selected for the sake of the dependencies' features, and the lints for what they have checked.
    let without_emulator = if lints.clippy {
        "clippy --profile suite --workspace --no-default-features -- -Dwarnings"
    } else {
        "check --profile suite --workspace --no-default-features"
    };
    let documentation = cargo("doc --profile suite --workspace --no-deps");
    let documentation = documentation.env("RUSTDOCFLAGS", "-Dwarnings");
    let host = vec![
        formatting(lints),
        figures(),
        only_if(lints.clippy, NO_CLIPPY, check("lints of the host's code", lints_of_all)),
        check("hil-sim without the emulator", [without_emulator]),
        Check { title: "documentation", commands: Ok(vec![lints.share_with(documentation)]) },
        check(
            "test programs",
            [&format!(
                "test --profile suite --no-run --quiet --workspace --tests --features {VIEWS}"
            )],
        ),
    ];
    let tests = |which: &str| {
        let line = format!("test --profile suite --no-fail-fast {which} --features {VIEWS}");
        Ok(vec![choice.handed_to(cargo(&line))])
    };
    // `hil-sim` and the windows are selected, too, so that cargo unifies features as for the workspace and compiles no dependency
    // again.
    let on_image = "-p image-tests -p hil-sim -p thermal-window --test image";
    let circuits =
        "-p hardware-benches -p hil-sim -p thermal-window --lib --bins --test benches --test bom";
    let others = "--workspace --exclude image-tests --exclude hardware-benches --tests";
    let on_target = choice.handed_to(cargo("xtask on-target --emulated --check"));
    vec![
        vec![host, images],
        vec![
            vec![Check {
                title: "units, windows without a display, and the whole system natively",
                commands: tests(others),
            }],
            vec![
                Check { title: "image on the emulated microcontroller", commands: tests(on_image) },
                // It waits for devices in real time, so while the other lane has enough to do.
                package(python),
                Check { title: "circuits", commands: tests(circuits) },
                Check {
                    title: "tests for a bare board, on the emulated one",
                    commands: Ok(vec![on_target]),
                },
                Check {
                    title: "examples of the documentation",
                    commands: tests("--workspace --doc"),
                },
            ],
        ],
    ]
}

/// `cargo xtask test`
pub fn run(permission: Permission, quick_only: bool) -> Result<()> {
    let members = members::all()?;
    let phases = |toolchain: &Toolchain, lints| {
        if quick_only {
            quick(&members, lints)
        } else {
            let python = setup::package_python();
            whole(toolchain, permission.choice, lints, python.as_deref())
        }
    };
    let all = phases(&Toolchain::Active, Lints::ALL);
    let mut steps = Steps::new(2 + all.iter().flatten().flatten().count());
    let result = (|| {
        let (toolchain, lints) = steps.run("set-up", "", || {
            let needs = Needs {
                emulator: !quick_only,
                fuzzer: false,
                lints: true,
                generators: true,
                circuits: !quick_only,
                package: !quick_only,
            };
            Ok((setup::prepare(needs, permission)?, setup::lints()?))
        })?;
        steps
            .run("dependencies and their licences", "", || members::check_dependencies(&members))?;
        let mut phases = phases(&toolchain, lints).into_iter();
        phases.try_for_each(|lanes| lanes::run(&lanes, &mut steps))
    })();
    println!("\n{steps}");
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::SUITE;

    fn checks(lints: Lints, python: Option<&str>) -> Vec<Check> {
        let phases = whole(&Toolchain::Active, Choice::Auto, lints, python);
        phases.into_iter().flatten().flatten().collect()
    }

    /// Compiling it takes more than a minute for each profile.
    #[test]
    fn the_emulator_is_compiled_in_the_profile_of_the_suite_only() {
        for check in checks(Lints::ALL, Some("python3")) {
            for line in check.commands.unwrap() {
                let line = line.to_string();
                assert!(!line.contains("--workspace") || line.contains("--profile suite"));
            }
        }
    }

    #[test]
    fn the_alias_for_single_tests_compiles_as_the_suite_does() {
        let config = include_str!("../../../.cargo/config.toml");
        let alias =
            format!("suite-test = \"test --profile {SUITE} --workspace --features {VIEWS}\"");
        assert!(config.contains(&alias), "{alias}");
    }

    #[test]
    fn a_missing_tool_leaves_out_its_own_checks_only() {
        let skipped = |rustfmt, clippy, python| {
            let checks = checks(Lints { rustfmt, clippy }, python);
            checks.iter().filter(|check| check.commands.is_err()).count()
        };
        let python = Some("python3");
        assert_eq!(skipped(true, true, python), 0);
        assert_eq!(skipped(false, true, python), 1);
        assert_eq!(skipped(true, false, python), 2);
        assert_eq!(skipped(true, true, None), 1);
    }
}
