//! Floating point: the control path has none, so neither NaN nor infinity can occur there. The learner has that of the
//! processor's floating-point unit only, which takes bounded time.
use anyhow::Result;

use crate::allowed::{CONTROL, LEARN};
use crate::{Proof, Section};

/// Whether a function is software floating-point arithmetic.
fn is_software(name: &str) -> bool {
    let helper = name.strip_prefix("__aeabi_").is_some_and(|rest| {
        ["d", "f", "cd", "cf", "h2", "i2", "ui2", "l2", "ul2"]
            .iter()
            .any(|kind| rest.starts_with(kind))
    });
    helper
        || ["libm::", "compiler_builtins::float::"].iter().any(|library| name.starts_with(library))
}

/// Checks that no instruction and no function of the control path is floating-point arithmetic, and no function of the learner.
///
/// # Errors
/// A handler is missing.
pub fn check(proof: &Proof) -> Result<Section> {
    let mut section = Section { title: "floating point".into(), ..Section::default() };
    for tree in CONTROL.into_iter().chain([LEARN]) {
        let (mut instructions, mut functions) = (0, 0);
        for function in &proof.graph.reached(proof.root(tree)?) {
            let name = proof.image.name(*function);
            if is_software(name) {
                functions += 1;
                section.violations.push(format!("{tree} calls {name}"));
            }
            for at in proof.graph.flow(*function).into_iter().flat_map(|flow| &flow.float) {
                instructions += 1;
                if tree == LEARN {
                    continue;
                }
                section
                    .violations
                    .push(format!("{tree} calculates at {at:#010x}: {}", proof.names.chain(*at)));
            }
        }
        section.lines.push(format!("{tree}: {instructions} instructions, {functions} functions"));
    }
    Ok(section)
}

#[cfg(test)]
mod tests {
    use super::is_software;

    /// Names from the Arm run-time ABI (IHI 0043), section 4.1.2, and names that must not match.
    #[test]
    fn floating_point_helpers_are_distinguished_from_integer_helpers() {
        for name in [
            "__aeabi_dadd",
            "__aeabi_fmul",
            "__aeabi_cdcmple",
            "__aeabi_i2d",
            "__aeabi_ul2f",
            "libm::math::exp::exp",
        ] {
            assert!(is_software(name), "{name}");
        }
        for name in [
            "__aeabi_memcpy",
            "__aeabi_uldivmod",
            "__aeabi_uidiv",
            "__aeabi_lmul",
            "contact_model::erfcx",
        ] {
            assert!(!is_software(name), "{name}");
        }
    }
}
