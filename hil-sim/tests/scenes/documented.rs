//! The table of faults in the README.

use hil_sim::scene::FaultKind;

#[test]
fn table_has_every_kind_with_unit_and_range() {
    let readme = include_str!("../../../README.md");
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
