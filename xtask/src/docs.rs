//! Writes the figures of `docs/figures.toml` into the documents, between markers that a reader does not see:
//!
//! ```text
//! <!-- figure kernel.error_sampled -->0.5082 units of 2^-32<!-- /figure -->
//! <!-- figure kernel.error_sampled value -->0.5082<!-- /figure -->        also: bound, all
//! <!-- figures law -->
//! (a table of all figures law.*)
//! <!-- /figures -->
//! ```
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use documented_figures::{Demand, Figure, all};

use crate::process::workspace;

/// `cargo xtask docs`
pub fn run(check: bool) -> Result<()> {
    let mut differ = Vec::new();
    for path in documents()? {
        let shown = path.strip_prefix(workspace()).unwrap_or(&path).display();
        let text = std::fs::read_to_string(&path).with_context(|| shown.to_string())?;
        let filled = fill(&text).with_context(|| shown.to_string())?;
        if filled != text {
            differ.push(shown.to_string());
            if !check {
                std::fs::write(&path, filled).with_context(|| shown.to_string())?;
            }
        }
    }
    let sources = sources(workspace())?;
    let unasserted = all().iter().filter(|figure| !asserted(figure, &sources));
    let unasserted: Vec<_> = unasserted.map(|figure| figure.key.as_str()).collect();
    ensure!(
        unasserted.is_empty(),
        "no test asserts {}; a figure that none can has `recorded_at`",
        unasserted.join(", ")
    );
    if check && !differ.is_empty() {
        bail!("{} differ from docs/figures.toml: cargo xtask docs", differ.join(", "));
    }
    println!("{} figures, {} documents written", all().len(), differ.len());
    Ok(())
}

/// The README and all of `docs/`.
fn documents() -> Result<Vec<PathBuf>> {
    let mut paths = vec![workspace().join("README.md")];
    for entry in std::fs::read_dir(workspace().join("docs"))? {
        paths.push(entry?.path());
    }
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    paths.sort();
    Ok(paths)
}

/// All Rust sources of the repository, without those of the figures themselves.
fn sources(folder: &Path) -> Result<String> {
    let mut text = String::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() && !matches!(name, "target" | "figures") && !name.starts_with('.') {
            text += &sources(&path)?;
        } else if name.ends_with(".rs") {
            text += &std::fs::read_to_string(&path)?;
        }
    }
    Ok(text)
}

/// Whether a source names the figure in full or by a format such as `"scene.{name}_skin_max"`, or none can.
fn asserted(figure: &Figure, sources: &str) -> bool {
    let group = figure.key.split('.').next().unwrap_or_default();
    let start = format!("\"{group}.");
    let mut named = sources.match_indices(&start).filter_map(|(at, _)| {
        let literal = sources.get(at + 1..)?;
        literal.split('"').next()
    });
    matches!(figure.demand, Demand::Recorded(_)) || named.any(|name| is_of(&figure.key, name))
}

/// Whether a format string, with any text for what is in braces, can give a key.
fn is_of(key: &str, format: &str) -> bool {
    let mut parts = format.split(['{', '}']).step_by(2);
    let Some(mut rest) = parts.next().and_then(|first| key.strip_prefix(first)) else {
        return false;
    };
    let mut parts = parts.peekable();
    while let Some(part) = parts.next() {
        let found = if parts.peek().is_some() { rest.find(part) } else { rest.rfind(part) };
        let Some(at) = found else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.is_empty()
}

/// A document with its markers filled.
fn fill(text: &str) -> Result<String> {
    let mut filled = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("<!-- figure") {
        let (before, marker) = rest.split_at(at);
        let (marker, after) = marker.split_once("-->").context("a marker without end")?;
        let words: Vec<&str> = marker.split_whitespace().skip(1).collect();
        let (content, end) = match words[..] {
            ["figure", key] => (stated(key, "all")?, "<!-- /figure -->"),
            ["figure", key, part] => (stated(key, part)?, "<!-- /figure -->"),
            ["figures", group] => (table(group)?, "<!-- /figures -->"),
            _ => bail!("not a marker: {marker}-->"),
        };
        let (_, after) =
            after.split_once(end).with_context(|| format!("{marker}--> without {end}"))?;
        write!(filled, "{before}{marker}-->{content}{end}")?;
        rest = after;
    }
    Ok(filled + rest)
}

/// A figure's value with its unit, or the part of it that a marker names.
fn stated(key: &str, part: &str) -> Result<String> {
    let figure = all().iter().find(|figure| figure.key == key);
    let figure = figure.with_context(|| format!("docs/figures.toml has no figure {key}"))?;
    Ok(match (part, &figure.demand) {
        ("all", _) => with_unit(figure.shown(), &figure.unit),
        ("value", _) => figure.shown(),
        ("bound", Demand::AtMost(bound) | Demand::AtLeast(bound) | Demand::Between(_, bound)) => {
            bound.to_string()
        }
        _ => bail!("{key} has no {part}"),
    })
}

fn with_unit(number: String, unit: &str) -> String {
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// The figures of a group as a table.
fn table(group: &str) -> Result<String> {
    let mut text =
        "\n| figure | value | tests allow | domain | command |\n|---|---|---|---|---|\n".to_owned();
    let mut before = "";
    let of_group = |figure: &&Figure| figure.key.split('.').next() == Some(group);
    for figure in all().iter().filter(of_group) {
        let allowed = match &figure.demand {
            Demand::AtMost(bound) => format!("at most {bound}"),
            Demand::AtLeast(least) => format!("at least {least}"),
            Demand::Between(least, bound) => format!("{least} to {bound}"),
            Demand::Exactly => "no other".to_owned(),
            Demand::Recorded(commit) => format!("(recorded at {commit})"),
        };
        let notes = figure.why.iter().chain(&figure.recorded_with);
        let notes: String = notes.map(|note| format!("; {note}")).collect();
        let command = match figure.command.as_str() {
            same if same == before => "as above".to_owned(),
            command => format!("`{command}`"),
        };
        before = &figure.command;
        // Several values would be cells of the table.
        let value = with_unit(figure.shown().replace(" | ", ", "), &figure.unit);
        let Figure { what, domain, .. } = figure;
        writeln!(text, "| {what} | {value} | {allowed}{notes} | {domain} | {command} |")?;
    }
    ensure!(!before.is_empty(), "docs/figures.toml has no figure {group}.*");
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_are_filled_and_the_text_around_them_stays() {
        let key = &all()[0].key;
        let value = all()[0].shown();
        let text = format!("a <!-- figure {key} value -->old<!-- /figure --> b");
        let expected = format!("a <!-- figure {key} value -->{value}<!-- /figure --> b");
        assert_eq!(fill(&text).expect("a known figure"), expected);
        assert_eq!(fill(&expected).expect("a known figure"), expected);
    }

    #[test]
    fn formats_stand_for_the_keys_that_they_can_give() {
        for (format, expected) in [
            ("a.copper_max", true),
            ("a.{name}_max", true),
            ("a.{}", true),
            ("a.{name}_{what}", true),
            ("a.{name}_rms", false),
            ("a.copper", false),
            ("b.{}", false),
        ] {
            assert_eq!(is_of("a.copper_max", format), expected, "{format}");
        }
    }

    #[test]
    fn wrong_markers_are_refused() {
        for text in [
            "<!-- figure none.such --><!-- /figure -->",
            "<!-- figures none --><!-- /figures -->",
            "<!-- figure kernel.error_sampled -->0.5",
            "<!-- figure -->",
        ] {
            assert!(fill(text).is_err(), "{text}");
        }
    }
}
