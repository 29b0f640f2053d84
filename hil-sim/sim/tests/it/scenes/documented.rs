//! The table of faults in the README.

use thermal_sim::scene::{FaultKind, ProcessorKind};

#[test]
fn table_has_every_kind_with_unit_and_range() {
    let readme = include_str!("../../../../../README.md");
    for kind in FaultKind::ALL {
        let expected = kind.value().map_or_else(
            || format!("| `{}` | | | ", kind.name()),
            |value| {
                let meant = value
                    .unless_given
                    .map_or(String::new(), |meant| format!(", else {meant}"));
                let range = format!("{} to {}{meant}", value.least, value.most);
                format!("| `{}` | {} | {range} | ", kind.name(), value.unit)
            },
        );
        assert!(
            readme.lines().any(|line| line.starts_with(&expected)),
            "{expected}"
        );
    }
}

#[test]
fn table_has_every_fault_of_the_processor_with_its_keys() {
    let readme = include_str!("../../../../../README.md");
    for kind in ProcessorKind::ALL {
        let keys: Vec<_> = kind
            .keys
            .iter()
            .map(|key| format!("`{}`", key.name()))
            .collect();
        let keys = keys.join(", ");
        let keys = if keys.is_empty() { keys } else { keys + " " };
        let expected = format!("| `{}` | | {keys}| ", kind.name);
        assert!(
            readme.lines().any(|line| line.starts_with(&expected)),
            "{expected}"
        );
    }
}
