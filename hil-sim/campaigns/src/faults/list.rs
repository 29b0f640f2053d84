//! The list of fault cases, as `list.toml` states them.

use std::collections::BTreeMap;
use std::slice;
use std::sync::LazyLock;

use anyhow::Context;
use serde::Deserialize;
use thermal_device::learning::FingerKnowledge;
use thermal_device::safety::Fault;
use toml::Value;

use super::{ExpectedReaction, FaultCase, FaultScene, InjectedFault, LearningExpected, Symptom};

/// Default duration of the scene after a fault, s: long enough for the heat of the sink to return.
const AFTER_S: f64 = 24.0;

/// What `list.toml` holds.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    cases: Vec<Row>,
    #[serde(default)]
    select_lines: Vec<Row>,
    symptoms: Groups,
    causes: Groups,
    knowledge: Groups,
    scenes: Groups,
}

/// Lists by the names that stand for them in a row.
type Groups = BTreeMap<String, Vec<Value>>;

#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Row {
    fault: String,
    symptoms: Vec<Value>,
    causes: Vec<Value>,
    restarts: bool,
    latent: bool,
    unchanged: bool,
    knowledge: Vec<Value>,
    unnoticed_at: Vec<Value>,
    assumed_k: Option<f64>,
    learnt_k: Option<f64>,
    scenes: Vec<Value>,
    never_at: Vec<Value>,
    after_s: Option<f64>,
}

/// The cases for every device, and those of the select lines of five fingers.
type Lists = [Vec<FaultCase>; 2];

static LISTS: LazyLock<Lists> =
    LazyLock::new(|| read(include_str!("list.toml")).expect("list.toml"));

/// All fault cases of one finger in the order of the table.
pub fn fault_cases() -> Vec<FaultCase> {
    LISTS[0].clone()
}

/// The fault cases of the select lines, which only the device for five fingers has.
pub(super) fn select_line_cases() -> Vec<FaultCase> {
    LISTS[1].clone()
}

/// The cases of a table. Their texts and lists are kept until the program ends.
fn read(text: &str) -> anyhow::Result<Lists> {
    let table: Table = toml::from_str(text)?;
    let case =
        |row: &Row| fault_case(row, &table).with_context(|| format!("fault {:?}", row.fault));
    let cases = |rows: &[Row]| rows.iter().map(case).collect::<anyhow::Result<_>>();
    Ok([cases(&table.cases)?, cases(&table.select_lines)?])
}

fn fault_case(row: &Row, table: &Table) -> anyhow::Result<FaultCase> {
    let scenes = |words| expand(words, &table.scenes, named(&FaultScene::ALL, FaultScene::name));
    let learning = match (row.assumed_k, row.learnt_k) {
        (None, None) => None,
        (assumed_k, learnt_k) => Some(LearningExpected {
            knowledge: expand(
                &row.knowledge,
                &table.knowledge,
                named(&FingerKnowledge::ALL, FingerKnowledge::name),
            )?,
            unnoticed_at: scenes(&row.unnoticed_at)?,
            assumes: assumed_k.is_some(),
            skin_max_k: (assumed_k.xor(learnt_k)).context("has two limits of the skin")?,
        }),
    };
    let causes = expand(&row.causes, &table.causes, named(Fault::ALL, Fault::name))?;
    Ok(FaultCase {
        fault: InjectedFault::from_text(row.fault.clone().leak()).context("is unknown")?,
        symptoms: expand(&row.symptoms, &table.symptoms, |word| Symptom::deserialize(word).ok())?,
        expected: match row.restarts {
            true => ExpectedReaction::Restart,
            false => ExpectedReaction::Trip(causes),
        },
        latent: row.latent,
        unchanged: row.unchanged,
        learning,
        scenes: scenes(&row.scenes)?,
        never_at: scenes(&row.never_at)?,
        after_s: row.after_s.unwrap_or(AFTER_S),
    })
}

/// The values of the words of a row, of which some stand for a group.
fn expand<T>(
    words: &[Value],
    groups: &Groups,
    value: impl Fn(Value) -> Option<T>,
) -> anyhow::Result<&'static [T]> {
    let words = words.iter().flat_map(|word| {
        let group = word.as_str().and_then(|name| groups.get(name));
        group.map_or(slice::from_ref(word), Vec::as_slice)
    });
    let value = |word: &Value| value(word.clone()).with_context(|| format!("{word} is unknown"));
    Ok(words.map(value).collect::<anyhow::Result<Vec<T>>>()?.leak())
}

/// Finds the value that a word names.
fn named<T: Copy>(all: &[T], name: fn(T) -> &'static str) -> impl Fn(Value) -> Option<T> {
    move |word| {
        let mut all = all.iter().copied();
        all.find(|value| word.as_str() == Some(name(*value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_row_is_refused_with_what_is_wrong() {
        for (row, expected) in [
            (r#"fault = "fan-of x10""#, r#"fault "fan-of x10": is unknown"#),
            (r#"fault = "fan-off 10""#, "is unknown"),
            (r#"fault = "fan-off""#, "is unknown"),
            (r#"fault = "adc-stuck", causes = ["warm"]"#, r#""adc-stuck": "warm" is unknown"#),
            (r#"fault = "adc-stuck", symptoms = [{ after = "1" }]"#, "is unknown"),
            (r#"fault = "adc-stuck", scenes = ["pi10hz"]"#, r#""pi10hz" is unknown"#),
            (
                r#"fault = "flux-open", knowledge = ["contacts"], assumed_k = 1"#,
                r#""contacts" is unknown"#,
            ),
            (r#"fault = "flux-open", assumed_k = 1, learnt_k = 1"#, "two limits"),
            (r#"fault = "adc-stuck", cause = []"#, "unknown field `cause`"),
        ] {
            let table =
                format!("cases = [{{ {row} }}]\n[symptoms]\n[causes]\n[knowledge]\n[scenes]\n");
            let error = read(&table).expect_err(row);
            assert!(format!("{error:#}").contains(expected), "{row}: {error:#}");
        }
    }

    #[test]
    fn no_group_has_the_name_of_a_word() {
        let table: Table = toml::from_str(include_str!("list.toml")).expect("a table");
        let is_symptom = |name: &String| Value::from(name.as_str()).try_into::<Symptom>().is_ok();
        assert!(!table.symptoms.keys().any(is_symptom));
        assert!(!Fault::ALL.iter().any(|fault| table.causes.contains_key(fault.name())));
        assert!(!FaultScene::ALL.iter().any(|scene| table.scenes.contains_key(scene.name())));
    }
}
