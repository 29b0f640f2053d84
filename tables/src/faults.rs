//! The kinds of faults that a scene may inject.

use thermal_sim::scene::{fault_names, fault_table};

use crate::part::Part;

/// Their table in the manual, and their names for the fuzzer of scenes.
pub fn parts() -> Vec<Part> {
    let words = fault_names().map(|name| format!("\"{name}\"\n"));
    let part = |file, text| Part { file, name: "faults", text };
    vec![
        part("docs/scenes.md", format!("\n{}", fault_table())),
        part("tests/fuzz/scene.dict", words.collect()),
    ]
}
