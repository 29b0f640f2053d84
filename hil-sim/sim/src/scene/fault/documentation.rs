//! The kinds of faults as `docs/scenes.md` and the dictionary of the fuzzer list them.

use super::row::Part;
use super::{FaultKind, ProcessorKind};

/// The table of all kinds with unit, value and effect, in Markdown. `cargo xtask tables` writes it.
pub fn fault_table() -> String {
    let head = ["| `kind` | unit | `value` | effect |".into(), "|---|---|---|---|".into()];
    let kinds = FaultKind::ALL.into_iter().map(|kind| {
        let row = kind.row();
        let (unit, range) = row.value.map_or(Default::default(), |value| {
            let default = value.default.map_or(String::new(), |value| format!(", else {value}"));
            (value.unit, format!("{} to {}{default}", value.min, value.max))
        });
        let needs = match row.part {
            Part::FluxSensor => "; only with `flux_sensor = true`",
            _ => "",
        };
        table_row([&format!("`{}`", kind.name()), unit, &range, &format!("{}{needs}", row.text)])
    });
    let of_processor = ProcessorKind::ALL.into_iter().map(|kind| {
        let keys: Vec<_> = kind.keys.iter().map(|key| format!("`{}`", key.name())).collect();
        table_row([&format!("`{}`", kind.name), "", &keys.join(", "), kind.text])
    });
    head.into_iter().chain(kinds).chain(of_processor).map(|line| line + "\n").collect()
}

fn table_row(cells: [&str; 4]) -> String {
    let cells = cells.map(|cell| if cell.is_empty() { " |".into() } else { format!(" {cell} |") });
    format!("|{}", cells.concat())
}

/// The names of all kinds.
pub fn fault_names() -> impl Iterator<Item = &'static str> {
    let of_processor = ProcessorKind::ALL.into_iter().map(|kind| kind.name);
    FaultKind::ALL.into_iter().map(FaultKind::name).chain(of_processor)
}
