//! Chooses the compiler for the microcontroller: the active toolchain with rustup's target, else the distribution's.
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Result;

use super::Missing;
use super::toolchain::{CARGO, CARGO_CLIPPY, Choice, Distribution, RUSTC, TARGET, Toolchain};
use crate::process::{Invocation, on_path};

/// Time limit for rustup to fetch a target or component; it can hang where the network is filtered.
pub const RUSTUP_LIMIT: Duration = Duration::from_secs(60);

/// Compilers and tools found on the machine.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// The active toolchain has the target's core library.
    active_has_target: bool,
    /// rustup is on the search path.
    rustup: bool,
    /// Version (major, minor) of the distribution's rustc and cargo, if there.
    rustc: Option<(u32, u32)>,
    cargo: Option<(u32, u32)>,
    /// The distribution's compiler has the source of its core library.
    source: bool,
    /// The distribution's clippy is there.
    clippy: bool,
    /// A linker for the target outside the distribution's compiler.
    linker: Option<PathBuf>,
}

/// The next step of the set-up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Decision {
    Use(Toolchain),
    AddWithRustup,
    Lacks(Vec<Missing>),
}

const COMPILER: Missing = Missing {
    what: "a Rust compiler for thumbv7em-none-eabihf",
    apt: &["rustc-web", "cargo-web", "rust-web-src"],
    elsewhere: &["rustup target add thumbv7em-none-eabihf"],
};
const RUSTUP_TARGET: Missing = Missing {
    what: "the Rust target thumbv7em-none-eabihf",
    apt: &[],
    elsewhere: COMPILER.elsewhere,
};
const LINKER: Missing = Missing {
    what: "a linker for thumbv7em-none-eabihf",
    apt: &["lld"],
    elsewhere: &["dnf install lld", "pacman -S lld", "brew install lld"],
};
const CLIPPY: Missing = Missing {
    what: "clippy of the distribution's Rust",
    apt: &["rust-web-clippy"],
    elsewhere: &["rustup target add thumbv7em-none-eabihf"],
};

/// The next step. A complete toolchain of the distribution comes before rustup's download, so that a machine that
/// cannot download waits once and not at every build.
pub fn decide(choice: Choice, found: &Found, lints: bool, rustup_tried: bool) -> Decision {
    if choice != Choice::Distribution && found.active_has_target {
        return Decision::Use(Toolchain::Active);
    }
    if choice == Choice::Rustup {
        let can_add = found.rustup && !rustup_tried;
        return if can_add {
            Decision::AddWithRustup
        } else {
            Decision::Lacks(vec![RUSTUP_TARGET])
        };
    }
    let needed = needed_version();
    let new_enough = |version: Option<(u32, u32)>| version.is_some_and(|version| version >= needed);
    let compiles = new_enough(found.rustc) && new_enough(found.cargo) && found.source;
    let lacks =
        [(compiles, COMPILER), (found.linker.is_some(), LINKER), (found.clippy || !lints, CLIPPY)];
    match &found.linker {
        Some(linker) if lacks.iter().all(|(there, _)| *there) => {
            Decision::Use(Toolchain::Distribution(Distribution { linker: linker.clone() }))
        }
        _ if choice == Choice::Auto && found.rustup && !rustup_tried => Decision::AddWithRustup,
        _ => Decision::Lacks(super::missing(&lacks)),
    }
}

/// Looks for compilers and tools.
pub fn probe() -> Found {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let print =
        |program: &str, args: &[&str]| Invocation::new(program, args.iter().copied()).answer();
    let folder = |text: Option<String>| text.map(|text| PathBuf::from(text.trim()));
    let target_libraries = folder(print(&rustc, &["--print", "target-libdir", "--target", TARGET]));
    let distribution_root = folder(print(RUSTC, &["--print", "sysroot"]));
    Found {
        active_has_target: target_libraries.is_some_and(|path| path.is_dir()),
        rustup: on_path("rustup").is_some(),
        rustc: print(RUSTC, &["--version"]).as_deref().and_then(version),
        cargo: print(CARGO, &["--version"]).as_deref().and_then(version),
        source: distribution_root
            .is_some_and(|root| root.join("lib/rustlib/src/rust/library/Cargo.toml").is_file()),
        clippy: Path::new(CARGO_CLIPPY).is_file(),
        linker: folder(print(&rustc, &["--print", "target-libdir"]))
            .and_then(|libraries| Some(libraries.parent()?.join("bin/rust-lld")))
            .filter(|linker| linker.is_file())
            .or_else(|| on_path("ld.lld")),
    }
}

/// Has rustup fetch the target for the active toolchain.
pub fn add_with_rustup() -> Result<()> {
    let add = Invocation::new("rustup", ["target", "add", TARGET]);
    eprintln!("fetching the target: {add} (at most {} s)", RUSTUP_LIMIT.as_secs());
    add.run_bounded(RUSTUP_LIMIT)
}

/// The oldest Rust (major, minor) that compiles this workspace, from its manifest.
fn needed_version() -> (u32, u32) {
    major_minor(env!("CARGO_PKG_RUST_VERSION")).unwrap_or_default()
}

/// The version in the answer of `rustc --version` or `cargo --version`.
fn version(answer: &str) -> Option<(u32, u32)> {
    major_minor(answer.split_whitespace().nth(1)?)
}

fn major_minor(version: &str) -> Option<(u32, u32)> {
    let mut numbers = version.split(['.', '-']);
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complete() -> Found {
        Found {
            active_has_target: false,
            rustup: false,
            rustc: Some((1, 96)),
            cargo: Some((1, 96)),
            source: true,
            clippy: true,
            linker: Some("/lib/rust-lld".into()),
        }
    }

    fn distribution() -> Decision {
        Decision::Use(Toolchain::Distribution(Distribution { linker: "/lib/rust-lld".into() }))
    }

    #[test]
    fn the_tools_found_decide_the_next_step() {
        use Choice::{Auto, Distribution, Rustup};
        use Decision::{AddWithRustup, Lacks, Use};
        let nothing = Found::default();
        let mut bare = nothing.clone();
        (bare.rustup, bare.linker) = (true, complete().linker);
        let (mut has_target, mut with_rustup) = (complete(), complete());
        (has_target.active_has_target, with_rustup.rustup) = (true, true);
        let (mut debian_12, mut no_source) = (complete(), complete());
        (debian_12.rustc, no_source.source) = (Some((1, 63)), false);
        let step = |choice, found, tried| decide(choice, found, false, tried);
        assert_eq!(step(Auto, &has_target, false), Use(Toolchain::Active));
        assert_eq!(step(Distribution, &has_target, false), distribution());
        // rustup comes first on a bare machine; packages follow if it failed, unless rustup was requested.
        assert_eq!(step(Auto, &bare, false), AddWithRustup);
        assert_eq!(step(Auto, &bare, true), Lacks(vec![COMPILER]));
        assert_eq!(step(Rustup, &bare, true), Lacks(vec![RUSTUP_TARGET]));
        assert_eq!(step(Auto, &nothing, false), Lacks(vec![COMPILER, LINKER]));
        // Complete packages save the download, unless rustup was requested.
        assert_eq!(step(Auto, &with_rustup, false), distribution());
        assert_eq!(step(Rustup, &with_rustup, false), AddWithRustup);
        assert_eq!(step(Auto, &debian_12, true), Lacks(vec![COMPILER]));
        assert_eq!(step(Distribution, &no_source, false), Lacks(vec![COMPILER]));
    }

    #[test]
    fn clippy_is_required_only_for_lints() {
        let found = Found { clippy: false, ..complete() };
        assert_eq!(decide(Choice::Auto, &found, false, true), distribution());
        assert_eq!(decide(Choice::Auto, &found, true, true), Decision::Lacks(vec![CLIPPY]));
    }

    #[test]
    fn versions_are_parsed_from_the_tools_output() {
        let cases = [
            ("rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball)", Some((1, 96))),
            ("cargo 1.98.0-nightly (f298b8c82 2026-05-22)", Some((1, 98))),
            ("rustc 2.0", Some((2, 0))),
            ("rustc", None),
            ("rustc unknown", None),
        ];
        for (answer, expected) in cases {
            assert_eq!(version(answer), expected, "{answer}");
        }
        assert!(needed_version() > (1, 85), "the 2024 edition needs 1.85 at least");
    }
}
