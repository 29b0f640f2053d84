//! The whole test suite.
use anyhow::{Result, anyhow};

use crate::firmware::{self, Fingers};
use crate::process::Invocation;
use crate::setup::{self, Choice, Lints, Needs, Permission, Toolchain};
use crate::step::Steps;

/// One check of the suite: a command, or why there is none.
struct Check {
    title: &'static str,
    hint: &'static str,
    command: Result<Invocation, &'static str>,
}

/// The checks in their order: cheap ones first. Whatever compiles the emulator does so in the release profile, and
/// so once.
fn checks(toolchain: &Toolchain, choice: Choice, lints: Lints) -> Vec<Check> {
    let cargo = |line: &str| Invocation::cargo(line.split(' '));
    let only = |there: bool, command: Invocation, why| if there { Ok(command) } else { Err(why) };
    let no_clippy = "the active toolchain has no clippy";
    let clippy_for_firmware = lints.clippy || matches!(toolchain, Toolchain::Distribution(_));
    vec![
        Check {
            title: "formatting",
            hint: "",
            command: only(
                lints.rustfmt,
                cargo("fmt --all --check"),
                "the active toolchain has no rustfmt",
            ),
        },
        Check {
            title: "contact model, with overflow checks",
            hint: "",
            command: Ok(cargo("test --package contact-model")),
        },
        Check {
            title: "firmware's units, with overflow checks",
            hint: "",
            command: Ok(cargo("test --package thermal-display --lib")),
        },
        Check {
            title: "firmware image",
            hint: "about 1 min the first time",
            command: Ok(firmware::build(toolchain, Fingers::One)),
        },
        Check {
            title: "firmware image for five fingers",
            hint: "about 1 min the first time",
            command: Ok(firmware::build(toolchain, Fingers::Five)),
        },
        Check {
            title: "lints of the firmware",
            hint: "",
            command: only(
                clippy_for_firmware,
                firmware::clippy(toolchain, Fingers::One),
                no_clippy,
            ),
        },
        Check {
            title: "lints of the firmware for five fingers",
            hint: "",
            command: only(
                clippy_for_firmware,
                firmware::clippy(toolchain, Fingers::Five),
                no_clippy,
            ),
        },
        Check {
            title: "lints of the host's code",
            hint: "compiles the emulator: about 2 min the first time",
            command: only(
                lints.clippy,
                cargo("clippy --release --workspace --all-targets -- -Dwarnings"),
                no_clippy,
            ),
        },
        Check {
            title: "documentation",
            hint: "",
            command: Ok(
                cargo("doc --release --workspace --no-deps").env("RUSTDOCFLAGS", "-Dwarnings")
            ),
        },
        Check {
            title: "fuzzing, all inputs of the repository and 15 s a target",
            hint: "instruments the product's crates: 3 min",
            command: Ok(cargo("xtask fuzz --seconds 15")),
        },
        Check {
            title: "whole system, the image on the plant",
            hint: "several minutes",
            command: Ok(choice.handed_to(cargo("test --release --workspace"))),
        },
    ]
}

/// `cargo xtask test`
pub fn run(permission: Permission) -> Result<()> {
    let count = 1 + checks(
        &Toolchain::Active,
        permission.choice,
        Lints {
            rustfmt: true,
            clippy: true,
        },
    )
    .len();
    let mut steps = Steps::new(count);
    let result = run_steps(&mut steps, permission);
    println!("\n{steps}");
    result
}

fn run_steps(steps: &mut Steps, permission: Permission) -> Result<()> {
    let needs = Needs {
        emulator: true,
        fuzzer: true,
        lints: true,
    };
    let (toolchain, lints) = steps.run("set-up", "", || {
        Ok((setup::prepare(needs, permission)?, setup::lints()?))
    })?;
    for Check {
        title,
        hint,
        command,
    } in checks(&toolchain, permission.choice, lints)
    {
        match command {
            Ok(command) => steps.run(title, hint, || command.run()).map_err(|error| {
                anyhow!("{title}: {error}; to repeat this step, run that command")
            })?,
            Err(why) => steps.skip(title, why),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: Lints = Lints {
        rustfmt: true,
        clippy: true,
    };

    fn lines(toolchain: &Toolchain, lints: Lints) -> Vec<Option<String>> {
        let checks = checks(toolchain, Choice::Auto, lints);
        checks
            .into_iter()
            .map(|check| check.command.ok().map(|command| command.to_string()))
            .collect()
    }

    /// Compiling it takes more than a minute for each profile.
    #[test]
    fn nothing_compiles_the_emulator_in_the_dev_profile() {
        for line in lines(&Toolchain::Active, ALL)
            .into_iter()
            .flatten()
            .filter(|line| line.contains("--workspace"))
        {
            assert!(line.contains("--release"), "{line}");
        }
    }

    #[test]
    fn missing_tools_leave_out_their_own_checks_only() {
        let skipped = |lints| {
            lines(&Toolchain::Active, lints)
                .iter()
                .filter(|line| line.is_none())
                .count()
        };
        assert_eq!(skipped(ALL), 0);
        assert_eq!(
            skipped(Lints {
                rustfmt: false,
                ..ALL
            }),
            1
        );
        assert_eq!(
            skipped(Lints {
                clippy: false,
                ..ALL
            }),
            3
        );
    }
}
