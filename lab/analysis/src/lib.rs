#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod analyses;
mod cells;
mod input;
mod page;
mod picture;
mod report;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use serde::Deserialize;
use thermal_session::dataset::DataSet;

pub use input::Simulated;
use report::rounded;
pub use report::{Analysis, Cell, Column, Picture, Section, Table, TaskAnalysis};

/// Analyses the sessions of a data set, each task over all its participants; sessions of a task whose files
/// differ are analysed apart. Void trials do not count. Whatever the records
/// are, every number is finite; what cannot be computed is a sentence in [`Section::not_possible`], what was left out one in
/// [`Section::warnings`] or [`Analysis::left_out`].
pub fn analyse(data: &DataSet, simulated: Simulated) -> Analysis {
    let excluded: BTreeMap<_, _> = (data.sessions.iter())
        .filter_map(|session| Some((&session.info.participant, session.excluded.as_ref()?)))
        .collect();
    let excluded = excluded.iter().map(|(code, why)| format!("participant {code}: {why}"));
    let sessions: Vec<_> =
        data.sessions.iter().filter(|session| session.excluded.is_none()).collect();
    let tasks = input::tasks(&sessions, simulated);
    Analysis {
        left_out: data.left_out.iter().map(ToString::to_string).chain(excluded).collect(),
        tasks: tasks.iter().map(analyses::of_task).collect(),
    }
}

impl Analysis {
    /// The analysis as JSON.
    pub fn json(&self) -> String {
        // Neither a map with keys that are no strings nor a number that is not finite is in it.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// The analysis as one HTML page that needs no other file.
    pub fn page(&self) -> String {
        page::page(self)
    }

    /// The tables: names of files, of task and table, and their contents as CSV. Numbers have seven significant
    /// digits; what has no value is empty.
    pub fn csv(&self) -> Vec<(String, String)> {
        let tables = self.tasks.iter().flat_map(|task| {
            let tables = task.sections.iter().flat_map(|section| &section.tables);
            tables.map(|table| (csv_name(&task.task, &table.name), table.csv()))
        });
        tables.collect()
    }
}

/// Name of the file of a table of a task.
fn csv_name(task: &str, table: &str) -> String {
    format!("{task}_{table}.csv")
}

/// Names of the files that [`Analysis::csv`] has given for an analysis, from its JSON.
///
/// # Errors
/// The text is no JSON of an analysis.
pub fn csv_names(json: &str) -> Result<Vec<String>, serde_json::Error> {
    #[derive(Deserialize)]
    struct Named {
        tasks: Vec<NamedTask>,
    }
    #[derive(Deserialize)]
    struct NamedTask {
        task: String,
        sections: Vec<NamedSection>,
    }
    #[derive(Deserialize)]
    struct NamedSection {
        tables: Vec<NamedTable>,
    }
    #[derive(Deserialize)]
    struct NamedTable {
        name: String,
    }
    let is_part_of_a_name =
        |name: &&str| name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
    let Named { tasks } = serde_json::from_str(json)?;
    let names = tasks.iter().flat_map(|NamedTask { task, sections }| {
        let tables = sections.iter().flat_map(|section| &section.tables);
        let names = tables.map(|table| &*table.name).filter(is_part_of_a_name);
        names.filter(move |_| is_part_of_a_name(&&**task)).map(move |name| csv_name(task, name))
    });
    Ok(names.collect())
}

impl Table {
    fn csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let names = self.columns.iter().map(|column| match column.unit {
            "" => column.name.clone(),
            unit => format!("{} / {unit}", column.name),
        });
        // Writing into memory fails only where a row has another number of cells, which a table does not have.
        let _ = writer.write_record(names);
        for row in &self.rows {
            let _ = writer.write_record(row.iter().map(|cell| match cell {
                Cell::Nothing => String::new(),
                Cell::Text(text) => text.clone(),
                Cell::Count(count) => count.to_string(),
                Cell::Number(number) => decimal_or_scientific(rounded(*number)),
            }));
        }
        let bytes = writer.into_inner().unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

/// A number as text, small ones with an exponent.
fn decimal_or_scientific(number: f64) -> String {
    if number != 0.0 && number.abs() < 1e-4 { format!("{number:e}") } else { number.to_string() }
}
