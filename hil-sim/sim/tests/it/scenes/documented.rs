//! The table of faults in `docs/scenes.md`.

use thermal_sim::scene::{FaultKind, ProcessorKind};

#[test]
fn table_has_every_kind_with_unit_and_range() {
    let page = include_str!("../../../../../docs/scenes.md");
    for kind in FaultKind::ALL {
        let expected = kind.value().map_or_else(
            || format!("| `{}` | | | ", kind.name()),
            |value| {
                let meant = value.default.map_or(String::new(), |meant| format!(", else {meant}"));
                let range = format!("{} to {}{meant}", value.min, value.max);
                format!("| `{}` | {} | {range} | ", kind.name(), value.unit)
            },
        );
        assert!(page.lines().any(|line| line.starts_with(&expected)), "{expected}");
    }
}

#[test]
fn table_has_every_fault_of_the_processor_with_its_keys() {
    let page = include_str!("../../../../../docs/scenes.md");
    for kind in ProcessorKind::ALL {
        let keys: Vec<_> = kind.keys.iter().map(|key| format!("`{}`", key.name())).collect();
        let keys = keys.join(", ");
        let keys = if keys.is_empty() { keys } else { keys + " " };
        let expected = format!("| `{}` | | {keys}| ", kind.name);
        assert!(page.lines().any(|line| line.starts_with(&expected)), "{expected}");
    }
}
