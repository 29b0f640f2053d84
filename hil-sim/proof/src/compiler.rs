//! Figures that depend on the build: instruction counts, sizes, names of functions in the machine code.
//!
//! They were recorded with one compiler and the settings of the workspace. With another one, or with more codegen units, a
//! difference is a warning, because the program may be the same.
use std::collections::BTreeSet;
use std::fmt::Display;

use anyhow::{Context, Result};
use object::{Object, ObjectSection};

/// Version of rustc that the figures in this repository were recorded with.
pub const RECORDED_WITH: &str = "1.95.0";

/// The compiler's name and version in an ELF file, `rustc version 1.95.0 (…)`, or, if the firmware's crates were not compiled
/// as one codegen unit each, `16 codegen units of rustc version 1.95.0 (…)`.
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
    let name = name.context("rustc did not compile the image")?;
    let strings = match file.section_by_name(".debug_str") {
        Some(section) => section.uncompressed_data()?.into_owned(),
        None => Vec::new(),
    };
    Ok(match codegen_units(&strings) {
        0 | 1 => name.into(),
        units => format!("{units} codegen units of {name}"),
    })
}

/// Most codegen units of a crate of the firmware, by the names of the units in the debug information:
/// `src/device/src/lib.rs/@/thermal_device.e1642a0247e64de2-cgu.0`.
fn codegen_units(debug_strings: &[u8]) -> usize {
    let mut units = BTreeSet::new();
    for name in debug_strings.split(|byte| *byte == 0) {
        let Ok(name) = str::from_utf8(name) else {
            continue;
        };
        let unit = name.split_once("/@/").and_then(|(_, unit)| unit.split_once("-cgu."));
        if let Some((crate_name, number)) = unit
            && (crate_name.starts_with("thermal_") || crate_name.starts_with("contact_model"))
        {
            units.insert((crate_name, number));
        }
    }
    let crates: BTreeSet<&str> = units.iter().map(|(crate_name, _)| *crate_name).collect();
    let count = |of: &&str| units.iter().filter(|(crate_name, _)| crate_name == of).count();
    crates.iter().map(count).max().unwrap_or(0)
}

/// Whether differences from recorded figures are failures for an image of this compiler; if not, prints them as warnings.
pub fn recorded_with(compiler: &str, differences: &[impl Display]) -> bool {
    let same = compiler.starts_with(&format!("rustc version {RECORDED_WITH} "));
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
        for other in [
            "rustc version 1.96.0 (ac68faa20 2026-05-25)",
            "16 codegen units of rustc version 1.95.0 (59807616e 2026-04-14)",
        ] {
            assert!(!recorded_with(other, &difference), "{other}");
        }
    }

    #[test]
    fn codegen_units_are_counted_for_each_crate_of_the_firmware() {
        let one = b"src/lib.rs/@/thermal_device.12-cgu.0\0model/src/lib.rs/@/contact_model.34-cgu.0\0core/@/core.5-cgu.7";
        let two = [one.as_slice(), b"\0src/lib.rs/@/thermal_device.12-cgu.1"].concat();
        assert_eq!(codegen_units(one), 1);
        assert_eq!(codegen_units(&two), 2);
        assert_eq!(codegen_units(b""), 0);
    }
}
