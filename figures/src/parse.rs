//! From the text of `docs/figures.toml` to figures.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::{Spanned, Table, Value};

use crate::{Demand, Figure, HEADROOM, Number};

/// Facts that the figures of a group share, and the figures, by name.
type Block = BTreeMap<Spanned<String>, Value>;

/// In a text that figures share, what a figure states itself, or else its name.
const OWN: &str = "{}";

/// All that is stated of a figure, as the head of the file explains it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    what: String,
    value: OneOrMore,
    bound: Option<Number>,
    least: Option<Number>,
    #[serde(default)]
    exact: bool,
    recorded_at: Option<String>,
    #[serde(default)]
    unit: String,
    domain: String,
    command: String,
    why: Option<String>,
    recorded_with: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum OneOrMore {
    One(Number),
    More(Vec<Number>),
}

/// All figures of a text, in its order.
pub fn figures(text: &str) -> Result<Vec<Figure>, String> {
    let groups: BTreeMap<String, Vec<Block>> =
        toml::from_str(text).map_err(|error| error.to_string())?;
    let mut found = BTreeMap::new();
    for (group, blocks) in groups {
        for block in blocks {
            let (rows, mut shared) = rows_and_shared(block);
            for (start, (name, row)) in rows {
                let key = format!("{group}.{name}");
                let in_figure = |problem: String| {
                    let lines: Vec<_> = problem.lines().collect();
                    format!("{key}: {}", lines.join(" "))
                };
                let facts = with_shared(&name, row, &shared).map_err(in_figure)?;
                let entry = facts.try_into().map_err(|error| in_figure(error.to_string()))?;
                let figure = figure(key.clone(), entry)?;
                if found.insert(key.clone(), (start, figure)).is_some() {
                    return Err(in_figure("is there twice".into()));
                }
                shared.entry("domain").or_insert_with(|| "the same".into());
            }
        }
    }
    let mut found: Vec<_> = found.into_values().collect();
    found.sort_by_key(|(start, _)| *start);
    Ok(found.into_iter().map(|(_, figure)| figure).collect())
}

/// The figures of a block by their place in the text, and the facts that they share.
fn rows_and_shared(block: Block) -> (BTreeMap<usize, (String, Table)>, Table) {
    let (mut rows, mut shared) = (BTreeMap::new(), Table::new());
    for (name, value) in block {
        let start = name.span().start;
        match value {
            Value::Table(row) => _ = rows.insert(start, (name.into_inner(), row)),
            fact => _ = shared.insert(name.into_inner(), fact),
        }
    }
    (rows, shared)
}

/// A figure's facts with those that it shares.
fn with_shared(name: &str, mut facts: Table, shared: &Table) -> Result<Table, String> {
    for (fact, shared) in shared {
        let own = facts.get(fact);
        if own == Some(shared) {
            return Err(format!("states the {fact} that it shares with its block"));
        }
        let pattern = shared.as_str().filter(|text| text.contains(OWN));
        let text = own.map_or(Some(name), Value::as_str);
        if let (Some(pattern), Some(text)) = (pattern, text) {
            facts.insert(fact.clone(), pattern.replace(OWN, text).into());
        } else if own.is_none() {
            facts.insert(fact.clone(), shared.clone());
        }
    }
    Ok(facts)
}

fn figure(key: String, entry: Entry) -> Result<Figure, String> {
    let demand = match (entry.bound, entry.least, entry.exact, entry.recorded_at) {
        (Some(bound), None, false, None) => Demand::AtMost(bound),
        (None, Some(least), false, None) => Demand::AtLeast(least),
        (Some(bound), Some(least), false, None) => Demand::Between(least, bound),
        (None, None, true, None) => Demand::Exactly,
        (None, None, false, Some(commit)) => Demand::Recorded(commit),
        _ => return Err(format!("{key}: one of bound, least, exact, recorded_at")),
    };
    let values = match entry.value {
        OneOrMore::One(value) => vec![value],
        OneOrMore::More(values) => values,
    };
    let value = match values[..] {
        [value] => value.get(),
        _ if matches!(demand, Demand::Exactly | Demand::Recorded(_)) => 1.0,
        _ => return Err(format!("{key}: several values are exact or recorded")),
    };
    let above = |bound: &Number| bound.get() / value;
    let below = |least: &Number| value / least.get();
    // How far the ends of what is allowed are from the value, as factors.
    let factors = match &demand {
        Demand::AtMost(bound) => vec![above(bound)],
        Demand::AtLeast(least) => vec![below(least)],
        Demand::Between(least, bound) => vec![below(least), above(bound)],
        Demand::Exactly | Demand::Recorded(_) => vec![],
    };
    let headroom = factors.iter().copied().fold(1.0, f64::max);
    if factors.iter().any(|factor| *factor < 1.0) {
        return Err(format!("{key}: the stated value is beyond its bound"));
    }
    // One part in a million for what a decimal fraction loses.
    if headroom > HEADROOM * (1.0 + 1e-6) && entry.why.is_none() {
        return Err(format!(
            "{key}: the bound is {headroom:.2} times the value; allowed is {HEADROOM}, or a reason (why)"
        ));
    }
    Ok(Figure {
        key,
        what: entry.what,
        values,
        demand,
        unit: entry.unit,
        domain: entry.domain,
        command: entry.command,
        why: entry.why,
        recorded_with: entry.recorded_with,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Verdict;

    fn parsed(lines: &str) -> Result<Figure, String> {
        let text = format!("[[a]]\n[a.b]\nwhat = \"x\"\ndomain = \"d\"\ncommand = \"c\"\n{lines}");
        figures(&text).map(|mut all| all.remove(0))
    }

    fn holds(lines: &str, measured: f64) -> bool {
        parsed(lines).expect("a figure").judge(measured) == Verdict::Holds
    }

    #[test]
    fn a_loose_bound_needs_a_reason() {
        assert!(parsed("value = 10\nbound = 13").is_ok());
        assert!(parsed("value = 10\nbound = 14").is_err());
        assert!(parsed("value = 10\nbound = 14\nwhy = \"drawn\"").is_ok());
        assert!(parsed("value = 13\nleast = 10").is_ok());
        assert!(parsed("value = 14\nleast = 10").is_err());
    }

    #[test]
    fn a_value_beyond_its_bound_is_refused() {
        assert!(parsed("value = 10\nbound = 9").is_err());
        assert!(parsed("value = 10\nleast = 11").is_err());
    }

    #[test]
    fn a_figure_has_one_demand() {
        assert!(parsed("value = 10").is_err());
        assert!(parsed("value = 10\nbound = 11\nexact = true").is_err());
        assert!(parsed("value = 10\nbound = 11\nleast = 9").is_ok());
        assert!(parsed("value = 10\nrecorded_at = \"abcdef0\"").is_ok());
    }

    #[test]
    fn a_measurement_beyond_the_bound_or_far_better_than_stated_differs() {
        for (measured, expected) in [(9.0, true), (12.0, true), (13.1, false), (7.0, false)] {
            assert_eq!(holds("value = 10\nbound = 13", measured), expected, "{measured}");
        }
        for (measured, expected) in [(10.0, true), (9.0, false), (14.0, false)] {
            assert_eq!(holds("value = 10\nleast = 9.5", measured), expected, "{measured}");
        }
        for (measured, expected) in [(9.0, true), (11.0, true), (8.9, false), (11.1, false)] {
            let range = "value = 10\nleast = 9\nbound = 11";
            assert_eq!(holds(range, measured), expected, "{measured}");
        }
        assert!(holds("value = 10\nexact = true", 10.0));
        assert!(!holds("value = 10\nexact = true", 10.1));
        assert!(!holds("value = 10\nbound = 13", f64::NAN));
    }

    #[test]
    fn a_figure_depends_on_its_compiler() {
        let figure = parsed("value = 1\nexact = true\nrecorded_with = \"rustc 1.95.0\"");
        let figure = figure.expect("a figure");
        for (compiler, expected) in [
            ("rustc version 1.95.0 (59807616e 2026-04-14)", true),
            ("rustc version 1.95.01", false),
            ("rustc version 1.96.0 (ac68faa20 2026-05-25)", false),
        ] {
            assert_eq!(figure.holds_for(compiler), expected, "{compiler}");
        }
    }

    /// What the figures of a block say of a fact, or what is wrong.
    fn facts(block: &str, fact: fn(&Figure) -> &str) -> Result<Vec<String>, String> {
        let shared = "command = 'c'\nexact = true\nwhat = 'x'";
        let figures = figures(&format!("[[a]]\n{shared}\n{block}"))?;
        Ok(figures.iter().map(|figure| fact(figure).to_owned()).collect())
    }

    fn problem(block: &str) -> String {
        facts(block, |figure| &figure.key).expect_err("a problem")
    }

    #[test]
    fn figures_share_the_facts_of_their_block_or_state_others() {
        let block = "unit = 'K'\ndomain = 'd'\nc = { value = 1, unit = 'mK' }\nb = { value = 2 }";
        assert_eq!(facts(block, |figure| &figure.unit), Ok(vec!["mK".into(), "K".into()]));
        assert_eq!(facts(block, |figure| &figure.domain), Ok(vec!["d".into(), "d".into()]));
        let next_block = format!("{block}\n[[a]]\ne = {{ value = 3 }}");
        assert!(problem(&next_block).starts_with("a.e: missing field"));
    }

    #[test]
    fn a_figure_without_a_domain_has_the_one_above() {
        let block = "c = { value = 1, domain = 'd' }\nb = { value = 2 }";
        let expected = ["d", "the same"].map(String::from);
        assert_eq!(facts(block, |figure| &figure.domain), Ok(expected.into()));
        assert_eq!(problem("c = { value = 1 }"), "a.c: missing field `domain`");
    }

    #[test]
    fn braces_in_a_shared_text_are_what_the_figure_states_or_its_name() {
        let block = "domain = 'on {}'\nc = { value = 1 }\nb = { value = 2, domain = 'd' }";
        let expected = ["on c", "on d"].map(String::from);
        assert_eq!(facts(block, |figure| &figure.domain), Ok(expected.into()));
    }

    #[test]
    fn what_is_wrong_names_figure_and_fact() {
        for (block, expected) in [
            ("c = { value = 1, domain = 'd', wht = 1 }", "a.c: unknown field `wht`"),
            ("wht = 1\nc = { value = 1, domain = 'd' }", "a.c: unknown field `wht`"),
            (
                "c = { value = 1, domain = 2 }",
                "a.c: invalid type: integer `2`, expected a string in `domain`",
            ),
            ("domain = '{}'\nc = { value = 1, domain = 2 }", "a.c: invalid type: integer `2`"),
            ("c = { value = 1, domain = 'd', exact = true }", "a.c: states the exact that"),
            (
                "c = { value = 1, domain = 'd' }\n[[a]]\nc = { value = 2, exact = true, what = 'x', domain = 'd', command = 'c' }",
                "a.c: is there twice",
            ),
        ] {
            let problem = problem(block);
            assert!(problem.starts_with(expected), "{problem}");
        }
    }

    #[test]
    fn figures_keep_the_order_of_the_file() {
        let block = "command = 'c'\nexact = true\nwhat = 'x'\nz = { value = 1, domain = 'd' }";
        let text = format!("[[b]]\n{block}\ny = {{ value = 2 }}\n[[a]]\n{block}\n[[b]]\n");
        let text = text + &block.replace("z =", "x =");
        let figures = figures(&text).expect("figures");
        let keys: Vec<_> = figures.iter().map(|figure| figure.key.as_str()).collect();
        assert_eq!(keys, ["b.z", "b.y", "a.z", "b.x"]);
    }
}
