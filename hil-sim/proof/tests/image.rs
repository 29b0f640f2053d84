//! Properties of the release images, and tests that the checks find what they are meant to find.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use image_proof::allowed::{CONTROL, HOST, LEARN, TICK};
use image_proof::compiler::recorded_with;
use image_proof::{Proof, Section, measure, panics};

/// The image of the current sources for one finger, built once.
fn one() -> &'static Path {
    static IMAGE: OnceLock<PathBuf> = OnceLock::new();
    IMAGE.get_or_init(|| stm32_emulator::build(1).expect("the image builds"))
}

/// The same for five.
fn five() -> &'static Path {
    static IMAGE: OnceLock<PathBuf> = OnceLock::new();
    IMAGE.get_or_init(|| stm32_emulator::build(5).expect("the image builds"))
}

fn proof(elf: &Path) -> Proof {
    Proof::read(elf).expect("an image with symbols")
}

fn assert_clean(sections: &[Section]) {
    for section in sections {
        println!("{section}");
    }
    let violations: Vec<&String> =
        sections.iter().flat_map(|section| &section.violations).collect();
    assert!(violations.is_empty(), "{violations:#?}");
}

#[test]
fn the_code_for_one_finger_has_no_violation() {
    assert_clean(&proof(one()).check().expect("all handlers are there"));
}

#[test]
fn the_code_for_five_fingers_has_no_violation() {
    assert_clean(&proof(five()).check().expect("all handlers are there"));
}

#[test]
fn ticks_and_stack_of_one_finger_stay_within_their_bounds() {
    let proof = proof(one());
    assert_clean(&[measure::check(&proof, one(), 1).expect("the scenes run")]);
}

#[test]
fn ticks_and_stack_of_five_fingers_stay_within_their_bounds() {
    let proof = proof(five());
    assert_clean(&[measure::check(&proof, five(), 5).expect("the scenes run")]);
}

/// Panics, calls and floating point that the image is known to contain are found, so that an empty list of violations is
/// evidence.
#[test]
fn the_checks_find_what_the_image_is_known_to_have() {
    let proof = proof(one());
    let reached = |tree: &str| proof.graph.reached(proof.root(tree).expect("a handler"));
    let calls = |tree: &str, part: &str| {
        reached(tree).iter().any(|start| proof.image.name(*start).contains(part))
    };
    // The host's task calculates in `f64`, formats text and fits calibrations; the tick calls the identification.
    let known = [
        (HOST, "__aeabi_dmul"),
        (HOST, "libm::"),
        (HOST, "core::fmt::"),
        (HOST, "heapless::"),
        (HOST, "CommissioningSession::add_point_and_refit"),
        (TICK, "Station::valid_readings_or_fault"),
    ];
    let inlined: Vec<String> = known
        .iter()
        .filter(|(tree, part)| !calls(tree, part))
        .map(|(tree, part)| format!("{tree} calls no {part}"))
        .collect();
    assert!(inlined.is_empty() || !recorded_with(&proof.compiler, &inlined), "{inlined:?}");
    // The learner calculates in `f32`.
    let float: usize = (reached(LEARN).iter())
        .filter_map(|start| proof.graph.flow(*start))
        .map(|flow| flow.float.len())
        .sum();
    assert!(float > 100, "{float} instructions of floating point");
    // Panics are recognised as functions that never return; the functions named as panics are among them.
    let panicking =
        |name: &str| name.starts_with("core::panicking::") || name.ends_with("unwrap_failed");
    for function in proof.image.functions().filter(|function| panicking(&function.name)) {
        assert!(!proof.graph.returns(function.start), "{}", function.name);
    }
    // Each handler returns and uses stack.
    for tree in CONTROL.into_iter().chain([LEARN]) {
        let root = proof.root(tree).expect("a handler");
        assert!(proof.graph.returns(root), "{tree}");
        assert!(proof.graph.flow(root).expect("followed").stack >= 8, "{tree}");
    }
    // The start-up may panic, as it is no part of the control path.
    let main = proof.image.functions().find(|function| function.name == "main").expect("main");
    let sites = panics::sites(&proof.image, &proof.graph, &proof.names, main.start);
    assert!(sites.iter().any(|site| site.ours), "{sites:#?}");
}
