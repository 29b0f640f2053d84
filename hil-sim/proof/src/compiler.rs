//! Figures that depend on the compiler: instruction counts, sizes, names of functions in the machine code.
//!
//! They were recorded with one compiler. With another one a difference is a warning, because the program may be the same.
use std::fmt::Display;

use anyhow::{Context, Result};
use object::{Object, ObjectSection};

/// Version of rustc that the figures in this repository were recorded with.
pub const RECORDED_WITH: &str = "1.95.0";

/// The compiler's name and version in an ELF file: `rustc version 1.95.0 (…)`.
///
/// # Errors
/// The file is no ELF file, or rustc did not compile it.
pub fn of_elf(elf: &[u8]) -> Result<String> {
    let file = object::File::parse(elf)?;
    let section = file.section_by_name(".comment");
    let section = section.context("the image names no compiler")?;
    let comments = String::from_utf8_lossy(section.data()?).into_owned();
    let mut names = comments.split('\0');
    let name = names.find(|name| name.starts_with("rustc"));
    Ok(name.context("rustc did not compile the image")?.into())
}

/// Whether differences from recorded figures are failures for an image of this compiler; if not, prints them as warnings.
pub fn recorded_with(compiler: &str, differences: &[impl Display]) -> bool {
    let same = compiler.split(' ').any(|word| word == RECORDED_WITH);
    if !same {
        for difference in differences {
            eprintln!(
                "warning: {difference}; recorded with rustc {RECORDED_WITH}, the image is of {compiler}"
            );
        }
    }
    same
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_fails_with_the_recorded_compiler_only() {
        let difference = ["2 bytes more"];
        let recorded = "rustc version 1.95.0 (59807616e 2026-04-14)";
        assert!(recorded_with(recorded, &difference));
        assert!(!recorded_with(
            "rustc version 1.96.0 (ac68faa20 2026-05-25)",
            &difference
        ));
    }
}
