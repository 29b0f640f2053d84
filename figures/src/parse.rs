//! From the text of `docs/figures.toml` to figures.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use crate::{Demand, Figure, HEADROOM, Number};

/// A table of the file, as its head explains it.
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
    type Groups = BTreeMap<String, BTreeMap<String, Spanned<Entry>>>;
    let groups: Groups = toml::from_str(text).map_err(|error| error.to_string())?;
    let mut found = Vec::new();
    for (group, entries) in groups {
        for (name, entry) in entries {
            let start = entry.span().start;
            found.push((start, figure(format!("{group}.{name}"), entry.into_inner())?));
        }
    }
    found.sort_by_key(|(start, _)| *start);
    Ok(found.into_iter().map(|(_, figure)| figure).collect())
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
        let text = format!("[a.b]\nwhat = \"x\"\ndomain = \"d\"\ncommand = \"c\"\n{lines}");
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

    #[test]
    fn figures_keep_the_order_of_the_file() {
        let keys: Vec<_> = crate::all().iter().map(|figure| &figure.key).collect();
        let places: Vec<_> = keys
            .iter()
            .map(|key| crate::TEXT.find(&format!("[{key}]\n")).expect("a table"))
            .collect();
        assert!(places.is_sorted());
    }
}
