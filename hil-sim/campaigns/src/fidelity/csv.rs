//! The figures as CSV, for other programs.

use super::{DrawResult, FidelityRow, PopulationResult};

/// A column: its name and the text of its cells.
type Column<T> = (&'static str, fn(&T) -> String);

const ROWS: [Column<FidelityRow>; 24] = [
    ("scenario", |row| row.scenario.name().into()),
    ("case", |row| row.case.clone()),
    ("force_n", |row| row.force_n.to_string()),
    ("skin_before_c", |row| row.skin_before_c.to_string()),
    ("object_c", |row| row.object_c.to_string()),
    ("law", |row| row.law.into()),
    ("without", |row| row.without.map_or("", |without| without.name()).into()),
    ("judged", |row| row.judged.figure.into()),
    ("value", |row| some(row.judged.value)),
    ("unit", |row| row.judged.unit.into()),
    ("bound", |row| some(row.judged.bound)),
    ("within", |row| some(row.judged.within)),
    ("skin_max_after_50ms_mk", |row| some(row.figures.skin_max_mk())),
    ("skin_rms_mk", |row| some(row.figures.skin_rms_mk())),
    ("display_max_after_50ms_mk", |row| {
        some(row.figures.display_error_mk.and_then(|errors| errors.max_after_50ms))
    }),
    ("display_rms_mk", |row| some(row.figures.display_error_mk.map(|errors| errors.rms))),
    ("current_max_a", |row| row.figures.current_a.max_abs.to_string()),
    ("current_rms_a", |row| row.figures.current_a.rms.to_string()),
    ("energy_j", |row| row.figures.energy_j.to_string()),
    ("kernel_evaluations", |row| some(row.figures.kernel_evaluations)),
    ("instructions_mean", |row| some(row.figures.instructions_per_tick.mean)),
    ("instructions_max", |row| some(row.figures.instructions_per_tick.max)),
    ("cycles_mean", |row| some(row.figures.cycles_per_tick.mean)),
    ("cycles_max", |row| some(row.figures.cycles_per_tick.max)),
];

const DRAWS: [Column<DrawResult>; 7] = [
    ("draw", |one| one.number.to_string()),
    ("material", |one| one.material.clone()),
    ("force_n", |one| one.force_n.to_string()),
    ("law", |one| one.law.into()),
    ("skin_max_after_50ms_mk", |one| one.max_after_50ms_mk.to_string()),
    ("skin_rms_mk", |one| one.rms_mk.to_string()),
    ("faults", |one| one.faults.join(" ")),
];

const POPULATIONS: [Column<PopulationResult>; 7] = [
    ("population", |one| one.population.name().into()),
    ("case", |one| one.case.clone()),
    ("told", |one| one.way.name().into()),
    ("skin_max_after_50ms_mk", |one| one.max_after_50ms_mk.to_string()),
    ("skin_max_after_500ms_mk", |one| one.max_after_500ms_mk.to_string()),
    ("skin_rms_mk", |one| one.rms_mk.to_string()),
    ("faults", |one| one.faults.join(" ")),
];

fn some<T: ToString>(value: Option<T>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

/// One line per run.
///
/// # Errors
/// Out of memory.
pub fn rows_csv(rows: &[FidelityRow]) -> anyhow::Result<Vec<u8>> {
    write(&ROWS, rows, |_| Vec::new(), &[])
}

/// One line per draw and law; the drawn parameters are the last columns.
///
/// # Errors
/// Out of memory.
pub fn box_csv(drawn: &[DrawResult]) -> anyhow::Result<Vec<u8>> {
    let keys: Vec<_> = drawn
        .first()
        .map_or(Vec::new(), |one| one.plant.iter().map(|(key, _)| key.as_str()).collect());
    let values = |one: &DrawResult| one.plant.iter().map(|(_, value)| value.to_string()).collect();
    write(&DRAWS, drawn, values, &keys)
}

/// One line per case of a population and what the device was told.
///
/// # Errors
/// Out of memory.
pub fn populations_csv(results: &[PopulationResult]) -> anyhow::Result<Vec<u8>> {
    write(&POPULATIONS, results, |_| Vec::new(), &[])
}

fn write<T>(
    columns: &[Column<T>],
    rows: &[T],
    more: impl Fn(&T) -> Vec<String>,
    names: &[&str],
) -> anyhow::Result<Vec<u8>> {
    let mut csv = ::csv::Writer::from_writer(Vec::new());
    csv.write_record(columns.iter().map(|(name, _)| *name).chain(names.iter().copied()))?;
    for row in rows {
        csv.write_record(columns.iter().map(|(_, cell)| cell(row)).chain(more(row)))?;
    }
    Ok(csv.into_inner()?)
}
