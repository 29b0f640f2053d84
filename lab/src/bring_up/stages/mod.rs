//! The procedure: all stages in the order of power, each a file of this folder. The first one, `bare-board.toml`, explains the
//! keys.
//!
//! Limits are worked out from the netlists and the bill of materials in `hardware/`; a test compares the nominal values with
//! the netlists.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;
use serde::de::IntoDeserializer as _;
use serde::de::value::Error as NoStage;
use toml::{Table, Value};

use super::check::{Check, Expected, Reading, Routine, Stage, StageId, Step};

macro_rules! files {
    ($($stage:literal)*) => {
        [$(($stage, include_str!(concat!($stage, ".toml")))),*]
    };
}

/// Names of the stages in their order, each with its file.
const FILES: [(&str, &str); 13] = files!(
    "bare-board" "rails" "chip" "line" "reset" "sensors" "supply" "latch" "edges" "load" "tile" "commissioning" "run"
);

/// All stages in their order. The first use reads the files; it panics at one that is wrong, and names the step, the key and
/// what is allowed.
pub static STAGES: LazyLock<Vec<Stage>> = LazyLock::new(|| {
    let mut needs = Tables::new();
    let stages = FILES.iter().map(|(name, text)| {
        stage(name, text, &mut needs).map_err(|problem| format!("stages/{name}.toml: {problem}"))
    });
    stages.collect::<Result<_, _>>().unwrap_or_else(|problem| panic!("{problem}"))
});

/// Tables by the names that `like` may give.
type Tables = BTreeMap<String, Table>;

/// A file of a stage.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    title: String,
    needs: Table,
    /// What a check blocks that does not say it itself.
    blocks: Option<Value>,
    step: Vec<Table>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, bound(deserialize = "'de: 'static"))]
struct RoutineStep {
    run: Routine,
}

/// Reads the file of a stage. What earlier stages need may be named.
fn stage(name: &'static str, text: &str, needs: &mut Tables) -> Result<Stage, String> {
    let file: File = toml::from_str(text).map_err(|error| error.to_string())?;
    let id = StageId::deserialize(name.into_deserializer());
    let id = id.map_err(|error: NoStage| error.to_string())?;
    let completed = completed(file.needs, name, needs);
    let needs = completed.and_then(read).map_err(|problem| format!("needs: {problem}"))?;
    let (mut steps, mut checks) = (Vec::new(), Tables::new());
    for (index, table) in file.step.into_iter().enumerate() {
        let first = ["check", "do", "run"].iter().find_map(|key| Some((key, table.get(*key)?)));
        let first = first.map(|(key, value)| format!(", {key} = {value}")).unwrap_or_default();
        let step = step(table, id, file.blocks.as_ref(), &mut checks);
        steps.push(step.map_err(|problem| format!("step {}{first}: {problem}", index + 1))?);
    }
    Ok(Stage { id, name, title: file.title.leak(), needs, steps: steps.leak() })
}

/// Reads a step.
fn step(
    mut table: Table,
    stage: StageId,
    blocks: Option<&Value>,
    checks: &mut Tables,
) -> Result<Step, String> {
    if table.contains_key("run") {
        return read(table).map(|RoutineStep { run }| Step::Routine(run));
    }
    let Some(check) = table.get("check") else {
        return read(table).map(Step::Manual);
    };
    let name = check.as_str().unwrap_or_default().to_owned();
    table = completed(table, &name, checks)?;
    if let Some(blocks) = blocks {
        table.entry("blocks").or_insert_with(|| blocks.clone());
    }
    if let Some(finding) = table.remove("finding") {
        for side in ["low", "high"] {
            table.entry(side).or_insert_with(|| finding.clone());
        }
    }
    let check: Check = read(table)?;
    match (check.reading, check.expected) {
        (Reading::Meter { .. }, Expected::Words(_)) => {
            Err("expected.words: an instrument shows a number; allowed: expected.range".into())
        }
        (_, Expected::Range(least, most, _)) if least > most => {
            Err(format!("expected.range: {least} to {most}; allowed: the smaller one first"))
        }
        _ if check.blocks.is_some_and(|blocked| blocked < stage) => {
            Err("blocks: an earlier stage; allowed: this one and later ones".into())
        }
        _ => Ok(Step::Check(check)),
    }
}

/// A table with what it takes from the one that its `like` names. It can itself be named from now on.
fn completed(mut table: Table, name: &str, known: &mut Tables) -> Result<Table, String> {
    if let Some(like) = table.remove("like") {
        let found = like.as_str().and_then(|like| known.get(like)).ok_or_else(|| {
            let known: Vec<_> = known.keys().map(String::as_str).collect();
            format!("like: {like}; allowed: an earlier one, {}", known.join(", "))
        })?;
        fill(&mut table, found);
    }
    known.insert(name.into(), table.clone());
    Ok(table)
}

/// Takes what is missing in a table from another one.
fn fill(table: &mut Table, other: &Table) {
    for (key, value) in other {
        match (table.get_mut(key), value) {
            (Some(Value::Table(table)), Value::Table(other)) => fill(table, other),
            (Some(_), _) => (),
            (None, _) => drop(table.insert(key.clone(), value.clone())),
        }
    }
}

fn read<T: Deserialize<'static>>(table: Table) -> Result<T, String> {
    table
        .try_into()
        .map_err(|error: toml::de::Error| error.to_string().trim_end().replace('\n', ", "))
}
