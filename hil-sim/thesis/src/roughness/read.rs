//! Profiles from CSV.

use std::fs::File;
use std::io;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use thiserror::Error;

use super::Profile;

/// Fewest points of a profile.
pub const LEAST_POINTS: usize = 20;
/// Longest step between neighbouring points, in shortest steps: beyond, the slopes of Eq. A-2 would say more of
/// the points' places than of the surface.
pub const MOST_UNEVEN: f64 = 10.0;

/// Why a file is no profile. Lines count from 1, the header's.
#[derive(Debug, Error)]
pub enum ProfileError {
    /// The file cannot be opened.
    #[error(transparent)]
    Unreadable(#[from] io::Error),
    /// It is not CSV, or not text.
    #[error(transparent)]
    NotCsv(#[from] csv::Error),
    /// A column is missing.
    #[error("line 1: columns {found}; needed are x_m and z_m")]
    Columns {
        /// Those that are there.
        found: String,
    },
    /// A cell holds no finite number.
    #[error("line {line}: {column} = {cell:?}; allowed is a finite number")]
    Cell {
        /// Where.
        line: u64,
        /// In which column.
        column: &'static str,
        /// What it holds.
        cell: String,
    },
    /// x does not rise.
    #[error("line {line}: x_m = {x_m} after {before_m}; allowed is a greater x_m in every line")]
    Order {
        /// Where.
        line: u64,
        /// Its x, m.
        x_m: f64,
        /// That of the line before, m.
        before_m: f64,
    },
    /// A step is too long.
    #[error(
        "line {line}: a step of {step_m:e} m; allowed is up to {MOST_UNEVEN} times the shortest step, {shortest_m:e} m"
    )]
    Uneven {
        /// Where the longest step ends.
        line: u64,
        /// Its length, m.
        step_m: f64,
        /// The shortest of all, m.
        shortest_m: f64,
    },
    /// The profile is too short.
    #[error("{count} points; allowed is {LEAST_POINTS} or more")]
    TooFew {
        /// Points found.
        count: usize,
    },
}

impl Profile {
    /// Reads a file as [`Self::parse`] does.
    ///
    /// # Errors
    /// The file cannot be read, or as [`Self::parse`].
    pub fn read(path: &Path) -> Result<Self, ProfileError> {
        Self::parse(File::open(path)?)
    }

    /// Reads CSV with a header that names `x_m` and `z_m`, in m; other columns and lines that start with `#` are
    /// passed over. x rises from line to line.
    ///
    /// # Errors
    /// A column is missing, a cell is no finite number, x does not rise, fewer than [`LEAST_POINTS`] points, or
    /// steps more uneven than [`MOST_UNEVEN`].
    pub fn parse(text: impl io::Read) -> Result<Self, ProfileError> {
        let mut csv = ReaderBuilder::new()
            .trim(Trim::All)
            .comment(Some(b'#'))
            .flexible(true)
            .from_reader(text);
        let header = csv.headers()?.clone();
        let column = |name: &str| {
            let found = header.iter().position(|column| column == name);
            found.ok_or_else(|| ProfileError::Columns {
                found: header.iter().collect::<Vec<_>>().join(", "),
            })
        };
        let (x_column, z_column) = (column("x_m")?, column("z_m")?);
        let (mut lines, mut x_m, mut z_m) = (Vec::new(), Vec::new(), Vec::new());
        for row in csv.records() {
            let row = row?;
            let line = row.position().map_or(0, csv::Position::line);
            let x = number(&row, line, "x_m", x_column)?;
            if let Some(&before_m) = x_m.last()
                && x <= before_m
            {
                return Err(ProfileError::Order {
                    line,
                    x_m: x,
                    before_m,
                });
            }
            lines.push(line);
            x_m.push(x);
            z_m.push(number(&row, line, "z_m", z_column)?);
        }
        if x_m.len() < LEAST_POINTS {
            return Err(ProfileError::TooFew { count: x_m.len() });
        }
        check_steps(&lines, &x_m)?;
        Ok(Self { x_m, z_m })
    }
}

fn check_steps(lines: &[u64], x_m: &[f64]) -> Result<(), ProfileError> {
    let (mut shortest_m, mut longest) = (f64::INFINITY, (0.0, 0));
    for (x, &line) in x_m.windows(2).zip(&lines[1..]) {
        let step_m = x[1] - x[0];
        shortest_m = step_m.min(shortest_m);
        if step_m > longest.0 {
            longest = (step_m, line);
        }
    }
    let (step_m, line) = longest;
    if step_m > MOST_UNEVEN * shortest_m {
        return Err(ProfileError::Uneven {
            line,
            step_m,
            shortest_m,
        });
    }
    Ok(())
}

fn number(
    row: &StringRecord,
    line: u64,
    column: &'static str,
    index: usize,
) -> Result<f64, ProfileError> {
    let cell = row.get(index).unwrap_or("");
    let value = cell.parse().ok().filter(|value: &f64| value.is_finite());
    value.ok_or_else(|| ProfileError::Cell {
        line,
        column,
        cell: cell.to_owned(),
    })
}
