//! Installs packages of the distribution by apt after asking, or names them for the user to install.
use std::io::{IsTerminal, Write};

use anyhow::{Result, bail};

use super::Missing;
use crate::process::{Invocation, on_path};

/// Time limit of one run of apt-get, s, kept by `timeout`, which also ends its children.
const APT_LIMIT_S: &str = "900";

/// Whether the user may install packages, and whether a person can be asked.
#[derive(Clone, Copy, Debug)]
struct Situation {
    apt: bool,
    root: bool,
    sudo: bool,
    /// `--yes`, or continuous integration.
    agreed: bool,
    terminal: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Consent {
    Given,
    Ask,
    /// Why nothing is installed.
    Refused(&'static str),
}

fn consent(situation: &Situation) -> Consent {
    match situation {
        Situation { apt: false, .. } => Consent::Refused("there is no apt-get to install it with"),
        Situation { root: false, sudo: false, .. } => {
            Consent::Refused("installing needs root, and there is no sudo")
        }
        Situation { agreed: true, .. } => Consent::Given,
        Situation { terminal: true, .. } => Consent::Ask,
        _ => Consent::Refused(
            "installing needs root, and there is no terminal to ask on; --yes allows it",
        ),
    }
}

/// Installs the missing packages, after asking if necessary; an error names the commands to run.
pub fn install(missing: &[Missing], yes: bool) -> Result<()> {
    let root = Invocation::new("id", ["-u"]).answer().is_some_and(|uid| uid.trim() == "0");
    let situation = Situation {
        apt: on_path("apt-get").is_some(),
        root,
        sudo: on_path("sudo").is_some(),
        agreed: yes,
        terminal: std::io::stdin().is_terminal() && std::io::stderr().is_terminal(),
    };
    let packages = packages(missing);
    if packages.is_empty() {
        bail!("missing:\n{}", advice(missing));
    }
    let [update, install] = commands(&packages, root);
    match consent(&situation) {
        Consent::Given => {}
        Consent::Refused(why) => bail!("missing, and {why}:\n{}", advice(missing)),
        Consent::Ask => {
            eprint!(
                "missing: {}\nTo be run as root:\n  {update}\n  {install}\nRun this now? [y/N] ",
                names(missing)
            );
            std::io::stderr().flush()?;
            let mut answer = String::new();
            std::io::stdin().read_line(&mut answer)?;
            if !matches!(answer.trim().to_ascii_lowercase().as_str(), "y" | "yes") {
                bail!("not installed:\n{}", advice(missing));
            }
        }
    }
    eprintln!("{update}");
    if let Err(error) = update.run_to_stderr() {
        // The lists of an earlier update may suffice; if not, the installation fails with its own message.
        eprintln!("{error}; going on with the package lists at hand");
    }
    eprintln!("{install}");
    install
        .run_to_stderr()
        .map_err(|error| error.context(format!("could not install:\n{}", advice(missing))))
}

/// The missing tools and the commands that install them, indented for the end of a message.
pub fn advice(missing: &[Missing]) -> String {
    let mut lines: Vec<String> =
        missing.iter().map(|missing| format!("  {}", missing.what)).collect();
    // One line for each command, in the order of first use.
    let apt = "apt-get update && apt-get install -y --no-install-recommends";
    let mut ways: Vec<(&str, Vec<&str>)> = vec![(apt, packages(missing))];
    let elsewhere = missing.iter().flat_map(|missing| missing.elsewhere);
    for (command, operand) in elsewhere.filter_map(|way| way.rsplit_once(' ')) {
        match ways.iter_mut().find(|(known, _)| *known == command) {
            Some((_, operands)) if operands.contains(&operand) => {}
            Some((_, operands)) => operands.push(operand),
            None => ways.push((command, vec![operand])),
        }
    }
    ways.retain(|(_, operands)| !operands.is_empty());
    lines.push("provided by (whichever your system has)".into());
    lines.extend(
        ways.iter().map(|(command, operands)| format!("  {command} {}", operands.join(" "))),
    );
    lines.join("\n")
}

fn names(missing: &[Missing]) -> String {
    missing.iter().map(|missing| missing.what).collect::<Vec<_>>().join(", ")
}

fn packages(missing: &[Missing]) -> Vec<&'static str> {
    missing.iter().flat_map(|missing| missing.apt).copied().collect()
}

/// The commands that update the package lists and install, each with a time limit.
fn commands(packages: &[&str], root: bool) -> [Invocation; 2] {
    let bounded = [
        "env",
        "DEBIAN_FRONTEND=noninteractive",
        "timeout",
        "--foreground",
        APT_LIMIT_S,
        "apt-get",
    ];
    let options = ["-o", "Acquire::http::Timeout=30", "-o", "DPkg::Lock::Timeout=120"];
    [&["update"][..], &[&["install", "-y", "--no-install-recommends"], packages].concat()].map(
        |verb| {
            let mut words = [&bounded[..], &options, verb].concat();
            if !root {
                words.insert(0, "sudo");
            }
            Invocation::new(words[0], words[1..].iter().copied())
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_installed_as_root_only_with_consent() {
        let situation = |there: &str| Situation {
            apt: there.contains("apt"),
            root: there.contains("root"),
            sudo: there.contains("sudo"),
            agreed: there.contains("--yes"),
            terminal: there.contains("terminal"),
        };
        for (there, expected) in [
            ("apt sudo terminal", Consent::Ask),
            ("apt root terminal", Consent::Ask),
            ("apt sudo --yes", Consent::Given),
            ("apt root --yes", Consent::Given),
        ] {
            assert_eq!(consent(&situation(there)), expected, "{there}");
        }
        for (there, lacking) in [
            ("apt root", "--yes"),
            ("apt --yes terminal", "sudo"),
            ("root --yes terminal", "apt-get"),
        ] {
            let Consent::Refused(why) = consent(&situation(there)) else {
                panic!("{there}: not refused")
            };
            assert!(why.contains(lacking), "{why}");
        }
    }

    #[test]
    fn sudo_is_used_unless_the_user_is_root() {
        let install = |root| commands(&["cmake"], root)[1].to_string();
        let (user, root) = (install(false), install(true));
        assert!(user.starts_with("sudo env "), "{user}");
        assert!(root.starts_with("env "), "{root}");
        assert!(root.ends_with(" install -y --no-install-recommends cmake"), "{root}");
    }

    #[test]
    fn advice_names_the_tool_and_each_command_once() {
        let one = Missing {
            what: "a",
            apt: &["a-dev", "b"],
            elsewhere: &["dnf install a", "xcode-select --install"],
        };
        let two = Missing {
            what: "c",
            apt: &["c"],
            elsewhere: &["dnf install c", "xcode-select --install"],
        };
        let advice = advice(&[one, two]);
        assert!(advice.contains("install -y --no-install-recommends a-dev b c\n"), "{advice}");
        assert_eq!(advice.matches("xcode-select").count(), 1, "{advice}");
        assert!(advice.contains("\n  dnf install a c"), "{advice}");
    }
}
