//! Kinds of faults in `docs/scenes.md` and in the dictionary of the fuzzer of scenes.

use thermal_sim::scene::{fault_names, fault_table};

#[test]
fn the_page_has_the_table_of_all_kinds() {
    let page = include_str!("../../../../../docs/scenes.md");
    let table = fault_table();
    assert!(page.contains(&table), "not in docs/scenes.md:\n{table}");
}

#[test]
fn the_dictionary_has_every_kind() {
    let dictionary = include_str!("../../../../../tests/fuzz/scene.dict");
    for name in fault_names() {
        let word = format!("\"{name}\"");
        assert!(dictionary.lines().any(|line| line == word), "{word}");
    }
}
