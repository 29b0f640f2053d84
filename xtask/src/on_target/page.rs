//! The page of figures that the tests measure: a row for each, with a column for each kind of run.

use anyhow::{Result, ensure};

/// Of the page.
pub const PATH: &str = "docs/on-target.md";

/// What a test prints before a figure.
const PREFIX: &str = "figure ";

/// A printed figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measured {
    key: String,
    value: String,
}

/// The figure in a line of output: `figure KEY VALUE UNIT`, perhaps behind what the runner has begun to print.
pub fn figure(line: &str) -> Option<Measured> {
    let (_, words) = line.split_once(PREFIX)?;
    let mut words = words.split_whitespace();
    Some(Measured { key: words.next()?.into(), value: words.next()?.into() })
}

/// A kind of run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    Emulated,
    Board,
}

impl Column {
    /// Index of its cell in a row, `| key | what | unit | emulated | board |`, split at the bars.
    const fn cell(self) -> usize {
        match self {
            Self::Emulated => 4,
            Self::Board => 5,
        }
    }

    /// How the line begins that says where its figures come from.
    const fn origin(self) -> &'static str {
        match self {
            Self::Emulated => "Emulated: ",
            Self::Board => "On a board: ",
        }
    }
}

/// The page with a column filled. Every figure has a row, and every row a figure.
pub fn fill(page: &str, column: Column, figures: &[Measured], origin: &str) -> Result<String> {
    let mut left: Vec<&Measured> = figures.iter().collect();
    let mut missing = Vec::new();
    let lines = page.lines().map(|line| {
        if line.starts_with(column.origin()) {
            return format!("{}{origin}.", column.origin());
        }
        let mut cells: Vec<&str> = line.split('|').collect();
        let Some(key) = key(&cells) else {
            return line.into();
        };
        let Some(found) = left.iter().position(|figure| figure.key == key) else {
            missing.push(key.to_owned());
            return line.into();
        };
        let value = format!(" {} ", left.remove(found).value);
        cells[column.cell()] = &value;
        cells.join("|")
    });
    let filled = lines.collect::<Vec<_>>().join("\n") + "\n";
    ensure!(missing.is_empty(), "no test has printed {}", missing.join(", "));
    let unknown: Vec<_> = left.iter().map(|figure| figure.key.as_str()).collect();
    ensure!(unknown.is_empty(), "{PATH} has no row for {}", unknown.join(", "));
    Ok(filled)
}

/// The key of a row, in backquotes in its first cell.
fn key<'a>(cells: &[&'a str]) -> Option<&'a str> {
    let [_, key, _, _, _, _, _] = cells else {
        return None;
    };
    key.trim().strip_prefix('`')?.strip_suffix('`')
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "\
Emulated: nobody.
On a board: nobody.

| key | what | unit | emulated | board |
|---|---|---|---|---|
| `tick` | a tick | cycles | - | - |
| `lock` | a lock | cycles | 7 | - |
";

    fn measured() -> Vec<Measured> {
        ["figure tick 12.5 cycles", "test a::b ... figure lock 3 cycles", "test a::b ... ok"]
            .iter()
            .filter_map(|line| figure(line))
            .collect()
    }

    #[test]
    fn a_run_fills_its_own_column_and_says_where_its_figures_come_from() {
        let filled = fill(PAGE, Column::Emulated, &measured(), "rustc 1").unwrap();
        assert!(filled.starts_with("Emulated: rustc 1.\nOn a board: nobody.\n"));
        assert!(filled.contains("| `tick` | a tick | cycles | 12.5 | - |\n"));
        let both = fill(&filled, Column::Board, &measured(), "rustc 2").unwrap();
        assert!(both.starts_with("Emulated: rustc 1.\nOn a board: rustc 2.\n"));
        assert!(both.ends_with("| `lock` | a lock | cycles | 3 | 3 |\n"));
    }

    #[test]
    fn a_row_without_a_figure_and_a_figure_without_a_row_are_named() {
        let [tick, lock] = measured().try_into().unwrap();
        let error = fill(PAGE, Column::Board, std::slice::from_ref(&tick), "").unwrap_err();
        assert_eq!(error.to_string(), "no test has printed lock");
        let other = figure("figure jitter 5 cycles").unwrap();
        let error = fill(PAGE, Column::Board, &[tick, lock, other], "").unwrap_err();
        assert_eq!(error.to_string(), "docs/on-target.md has no row for jitter");
    }
}
