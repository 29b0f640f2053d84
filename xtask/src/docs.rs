//! Writes the figures of `docs/figures.toml` into the documents, between markers that a reader does not see:
//!
//! ```text
//! <!-- figure kernel.error_sampled -->0.5082 units of 2^-32<!-- /figure -->
//! <!-- figure kernel.error_sampled value -->0.5082<!-- /figure -->        also: bound, all
//! <!-- figures law -->
//! (a table of all figures law.*)
//! <!-- /figures -->
//! <!-- about figures -->
//! (how far figures may be off, and which of the page are recorded, when and by what)
//! <!-- /about -->
//! <!-- recorded 88e36ec cargo xtask fidelity -->
//! Text and tables with results of this command at this commit.
//! <!-- at -->
//! (commit and command, and whether the code has changed since)
//! <!-- /recorded -->
//! ```
//!
//! Other results in prose are refused ([`documented_figures::results`]), unless `docs/constants.toml` says that they are none.
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use documented_figures::{Constants, Demand, Figure, HEADROOM, all, is_head_of_records};

use crate::process::workspace;

mod age;

use age::History;

/// Results that are listed when there are more.
const LISTED_MOST: usize = 60;

/// `cargo xtask docs`
pub fn run(check: bool) -> Result<()> {
    let mut differ = Vec::new();
    let mut pages = Vec::new();
    let mut history = History::default();
    for path in documents(workspace())? {
        let shown = path.strip_prefix(workspace()).unwrap_or(&path).display().to_string();
        let text = std::fs::read_to_string(&path).with_context(|| shown.clone())?;
        let filled = fill(&shown, &text, &mut history).with_context(|| shown.clone())?;
        let is_same = age::without_notes(&filled) == age::without_notes(&text);
        if !is_same || (filled != text && !history.is_incomplete && !check) {
            differ.push(shown.clone());
            if !check {
                std::fs::write(&path, &filled).with_context(|| shown.clone())?;
            }
        }
        pages.push((shown, filled));
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
    let numbers = check_prose(&pages)?;
    println!(
        "{} figures, {} documents written, {numbers} numbers in prose are constants",
        all().len(),
        differ.len()
    );
    Ok(())
}

/// Checks that no page states a result in prose; returns the count of numbers that `docs/constants.toml` excuses.
fn check_prose(pages: &[(String, String)]) -> Result<usize> {
    let list = workspace().join("docs/constants.toml");
    let list = std::fs::read_to_string(list).context("docs/constants.toml")?;
    let constants =
        Constants::parse(&list).map_err(|error| anyhow!("docs/constants.toml: {error}"))?;
    let (unlisted, unused) = constants.unlisted(pages);
    let shown = unlisted.iter().take(LISTED_MOST);
    let shown: String = shown
        .map(|(page, result)| format!("{page}:{}: {}\n", result.line, result.number))
        .collect();
    ensure!(
        unlisted.is_empty(),
        "{} results in prose, which no test asserts:\n{shown}allowed: a figure of docs/figures.toml; a block `<!-- recorded COMMIT \
         COMMAND -->`; no number; or, for a constant, an entry in docs/constants.toml with the reason",
        unlisted.len()
    );
    ensure!(
        unused.is_empty(),
        "no page needs these entries of docs/constants.toml:\n{}",
        unused.join("\n")
    );
    let results = pages.iter().map(|(_, page)| documented_figures::results(page).len());
    Ok(results.sum())
}

/// All pages of the repository: files in Markdown, but the changelog, which speaks of the past.
fn documents(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            paths.extend(documents(&path)?);
        } else if name.ends_with(".md") && name != "CHANGELOG.md" {
            paths.push(path);
        }
    }
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
fn fill(page: &str, text: &str, history: &mut History) -> Result<String> {
    let filled = fill_markers(&about(page, text, history)?, text, history)?;
    let filled = fill_records(&filled, history)?;
    ensure!(
        keys(text).is_empty() || text.contains("<!-- about figures -->"),
        "the page has figures, but no `<!-- about figures --><!-- /about -->`"
    );
    Ok(filled)
}

/// A text with the age of each row of tables that have the columns `recorded at` and `command`.
fn fill_records(text: &str, history: &mut History) -> Result<String> {
    let mut filled = String::new();
    let mut head = "";
    for line in text.split_inclusive('\n') {
        let is_row = line.starts_with('|');
        if !is_row || !is_head_of_records(head) || line.starts_with("|---") {
            head = if !is_row {
                ""
            } else if head.is_empty() {
                line
            } else {
                head
            };
            filled += line;
            continue;
        }
        let cells = || {
            line.split(" | ").zip(head.split(" | ").map(|cell| cell.trim_matches([' ', '|', '\n'])))
        };
        let command = cells().find(|(_, head)| *head == "command").map_or("", |(cell, _)| cell);
        for (index, (cell, head)) in cells().enumerate() {
            let between = if index == 0 { "" } else { " | " };
            let commit = cell.split(' ').next().unwrap_or_default();
            let is_commit = head == "recorded at";
            let cell = if is_commit {
                history.commit_with_note(commit, command)?
            } else {
                cell.to_owned()
            };
            write!(filled, "{between}{cell}")?;
        }
    }
    Ok(filled)
}

/// A text with its markers filled, those in records as well.
fn fill_markers(about: &str, text: &str, history: &mut History) -> Result<String> {
    let mut filled = String::new();
    let mut rest = text;
    while let Some(at) = next_marker(rest) {
        let (before, marker) = rest.split_at(at);
        let (marker, after) = marker.split_once("-->").context("a marker without end")?;
        let words: Vec<&str> = marker.split_whitespace().skip(1).collect();
        let (content, end) = match words[..] {
            ["figure", key] => (stated(key, "all")?, "<!-- /figure -->"),
            ["figure", key, part] => (stated(key, part)?, "<!-- /figure -->"),
            ["figures", group] => (table(group, history)?, "<!-- /figures -->"),
            ["about", "figures"] => (about.to_owned(), "<!-- /about -->"),
            ["recorded", commit, _, ..] => {
                let (inside, _) =
                    after.split_once("<!-- at -->").context("recorded without `at`")?;
                let (_, command) = marker.split_once(commit).unwrap_or_default();
                let inside = fill_markers(about, inside, history)?;
                let by = format!(
                    "Recorded at {} by `{}`.",
                    history.commit_with_note(commit, command)?,
                    command.trim()
                );
                (format!("{inside}<!-- at -->\n{by}\n"), "<!-- /recorded -->")
            }
            _ => bail!("not a marker: {marker}-->"),
        };
        let (_, after) =
            after.split_once(end).with_context(|| format!("{marker}--> without {end}"))?;
        write!(filled, "{before}{marker}-->{content}{end}")?;
        rest = after;
    }
    Ok(filled + rest)
}

/// Where the next marker begins.
fn next_marker(text: &str) -> Option<usize> {
    ["<!-- figure", "<!-- about figures", "<!-- recorded"]
        .iter()
        .filter_map(|start| text.find(start))
        .min()
}

/// The keys of the figures that stand in the text of a page, outside of tables of a group.
fn keys(text: &str) -> Vec<&str> {
    let starts = text.split("<!-- figure ").skip(1);
    starts.filter_map(|start| start.split_whitespace().next()).collect()
}

/// How far figures may be off, and which of a page no test measures.
fn about(page: &str, text: &str, history: &mut History) -> Result<String> {
    let to_docs = match page.strip_prefix("docs/") {
        Some(_) => String::new(),
        None => "../".repeat(page.matches('/').count()) + "docs/",
    };
    let mut recorded: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    let on_page = keys(text);
    for figure in all().iter().filter(|figure| on_page.contains(&figure.key.as_str())) {
        if let Demand::Recorded(commit) = &figure.demand {
            let values = recorded.entry((commit, &figure.command)).or_default();
            values.push(figure.key.split('.').next().unwrap_or_default());
        }
    }
    let mut about = format!(
        "\nFigures on this page are as measured when they were last set; a test fails when one is beyond its bound, at most \
         {HEADROOM} times off unless a reason is given ([how]({to_docs}README.md#figures))."
    );
    let mut untested = Vec::new();
    for ((commit, command), mut groups) in recorded {
        groups.dedup();
        let noted = history.commit_with_note(commit, command)?;
        untested.push(format!("`{}` at {noted} by `{command}`", groups.join("`, `")));
    }
    if !untested.is_empty() {
        write!(about, " Recorded, without a test: {}.", untested.join("; "))?;
    }
    Ok(about + "\n")
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
fn table(group: &str, history: &mut History) -> Result<String> {
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
            Demand::Recorded(commit) => {
                format!("recorded at {}", history.commit_with_note(commit, &figure.command)?)
            }
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

    fn filled(page: &str, text: &str) -> Result<String> {
        fill(page, text, &mut History::default())
    }

    #[test]
    fn markers_are_filled_and_the_text_around_them_stays() {
        let key = &all()[0].key;
        let value = all()[0].shown();
        let text = format!("a <!-- figure {key} value -->old<!-- /figure --> b");
        let expected = format!("a <!-- figure {key} value -->{value}<!-- /figure --> b");
        for text in [&text, &expected] {
            let about = "\n<!-- about figures -->\n<!-- /about -->";
            let filled = filled("docs/a.md", &(text.clone() + about)).expect("a known figure");
            assert!(filled.starts_with(&expected), "{filled}");
            assert!(
                filled.contains(
                    "at most 1.3 times off unless a reason is given ([how](README.md#figures))"
                ),
                "{filled}"
            );
        }
    }

    #[test]
    fn rows_that_name_a_commit_get_its_age() {
        let table = "| a | recorded at | command |\n|---|---|---|\n| 1 | 0000000 (old) | `x` |\n";
        let expected = table.replace(" (old)", "");
        assert_eq!(filled("README.md", table).expect("a commit"), expected);
        assert!(filled("README.md", &table.replace("0000000", "today")).is_err());
    }

    #[test]
    fn a_record_names_commit_and_command() {
        let text = "<!-- recorded 0000000 cargo run x -->\nIt was 3 K.\n<!-- at -->\nold\n<!-- /recorded --> b";
        let filled = filled("README.md", text).expect("a record");
        assert_eq!(filled, text.replace("old", "Recorded at 0000000 by `cargo run x`."));
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
            "<!-- recorded 0000000 -->x<!-- at --><!-- /recorded -->",
            "<!-- recorded today cargo run -->x<!-- at --><!-- /recorded -->",
            "<!-- recorded 0000000 cargo run -->x<!-- /recorded -->",
        ] {
            assert!(filled("README.md", text).is_err(), "{text}");
        }
    }
}
