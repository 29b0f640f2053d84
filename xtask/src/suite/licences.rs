//! Licences of dependencies: all are permissive, except that of the emulator in packages that link it.
use std::iter::Peekable;
use std::str::SplitAsciiWhitespace;

use anyhow::{Context, Result, ensure};

/// Licences that a dependency may have, by their SPDX identifiers. A program that contains the dependency may be passed on under
/// MIT or Apache-2.0, with the notices of these licences.
/// OFL-1.1 and Ubuntu-font-1.0 are those of the fonts that windows contain; programs may contain them.
const ALLOWED: [&str; 11] = [
    "0BSD",
    "Apache-2.0",
    "BSD-3-Clause",
    "CC0-1.0",
    "ISC",
    "MIT",
    "NCSA",
    "OFL-1.1",
    "Ubuntu-font-1.0",
    "Unicode-3.0",
    "Zlib",
];
/// Licence of the emulator.
pub const OF_EMULATOR: &str = "GPL-2.0";

/// Options of `cargo tree` for the lines that [`check`] reads.
pub const TREE_FORMAT: &str = "{p}|{l}";

/// Checks the lines `NAME vVERSION …|LICENCE` of a package's dependencies; `with_emulator` allows its licence, too. An error
/// names the dependency and what is allowed.
pub fn check(tree: &str, with_emulator: bool) -> Result<()> {
    let allowed =
        |licence: &str| ALLOWED.contains(&licence) || (with_emulator && licence == OF_EMULATOR);
    for line in tree.lines().filter(|line| !line.is_empty()) {
        let (package, licence) = line.split_once('|').context(line.to_owned())?;
        // Cargo's mark of a dependency that it has listed before.
        let licence = licence.trim_end_matches(" (*)");
        ensure!(
            permits(licence, &allowed).unwrap_or(false),
            "{package} has the licence '{licence}'; allowed are {}",
            ALLOWED.join(", ")
        );
    }
    Ok(())
}

/// Whether allowed licences are enough for an SPDX expression; `None` if it is none. Its older form has `/` for `OR`.
fn permits(expression: &str, allowed: &dyn Fn(&str) -> bool) -> Option<bool> {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let mut words = spaced.split_ascii_whitespace().peekable();
    let permitted = any_of(&mut words, allowed)?;
    words.next().is_none().then_some(permitted)
}

type Words<'a> = Peekable<SplitAsciiWhitespace<'a>>;

fn any_of(words: &mut Words<'_>, allowed: &dyn Fn(&str) -> bool) -> Option<bool> {
    let mut any = all_of(words, allowed)?;
    while words.next_if_eq(&"OR").is_some() {
        any |= all_of(words, allowed)?;
    }
    Some(any)
}

fn all_of(words: &mut Words<'_>, allowed: &dyn Fn(&str) -> bool) -> Option<bool> {
    let mut all = one(words, allowed)?;
    while words.next_if_eq(&"AND").is_some() {
        all &= one(words, allowed)?;
    }
    Some(all)
}

fn one(words: &mut Words<'_>, allowed: &dyn Fn(&str) -> bool) -> Option<bool> {
    let word = words.next()?;
    if word == "(" {
        let inner = any_of(words, allowed)?;
        return words.next_if_eq(&")").map(|_| inner);
    }
    if words.next_if_eq(&"WITH").is_some() {
        // An exception permits more than the licence does.
        words.next()?;
    }
    Some(allowed(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_forbidden_licence_is_found_and_named() {
        let tree = "hil-sim v0.2.0 (/home/me/hil-sim)|MIT OR Apache-2.0\n\
                    libc v0.2.1|MIT/Apache-2.0 (*)\n\
                    \n\
                    unicorn-engine v2.1.5|GPL-2.0\n";
        assert!(check(tree, true).is_ok());
        assert_eq!(
            check(tree, false).unwrap_err().to_string(),
            format!(
                "unicorn-engine v2.1.5 has the licence 'GPL-2.0'; allowed are {}",
                ALLOWED.join(", ")
            )
        );
        for forbidden in ["LGPL-2.1-or-later", "GPL-3.0-only", "MPL-2.0", "", "MIT AND GPL-2.0"] {
            assert!(check(&format!("x v1.0.0|{forbidden}"), false).is_err(), "{forbidden}");
        }
        assert!(check("a line without a licence", true).is_err());
    }

    #[test]
    fn an_expression_is_permitted_if_allowed_licences_are_enough_for_it() {
        for (expression, permitted) in [
            ("MIT", Some(true)),
            ("GPL-2.0", Some(false)),
            ("GPL-2.0 OR MIT", Some(true)),
            ("GPL-2.0/MIT", Some(true)),
            ("GPL-2.0 AND MIT", Some(false)),
            ("(GPL-2.0 OR MIT) AND NCSA", Some(true)),
            ("MIT AND (GPL-2.0 OR LGPL-3.0)", Some(false)),
            // AND binds more tightly than OR.
            ("MIT OR GPL-2.0 AND LGPL-3.0", Some(true)),
            ("GPL-2.0 AND LGPL-3.0 OR MIT", Some(true)),
            ("Apache-2.0 WITH LLVM-exception", Some(true)),
            ("GPL-2.0 WITH Classpath-exception-2.0", Some(false)),
            ("", None),
            ("MIT OR", None),
            ("(MIT", None),
            ("MIT)", None),
            ("MIT Apache-2.0", None),
        ] {
            let allowed = |licence: &str| ALLOWED.contains(&licence);
            assert_eq!(permits(expression, &allowed), permitted, "{expression}");
        }
    }
}
