//! Reading of profiles from CSV.

use std::fs::File;
use std::io;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use thiserror::Error;

use super::Profile;

/// Least number of points of a profile.
pub const LEAST_POINTS: usize = 20;
/// Largest ratio of the longest to the shortest step: beyond it the slopes of Eq. A-2 depend more on the positions of the
/// points than on the surface.
pub const MOST_UNEVEN: f64 = 10.0;

/// Error in a profile. Line 1 is the header.
#[derive(Debug, Error)]
pub enum ProfileError {
    /// The file cannot be opened.
    #[error(transparent)]
    Unreadable(#[from] io::Error),
    /// The file is not valid CSV or not UTF-8.
    #[error(transparent)]
    NotCsv(#[from] csv::Error),
    /// A column is missing.
    #[error("line 1: columns {found}; needed are x_m and z_m")]
    Columns {
        /// Columns of the file.
        found: String,
    },
    /// A cell is not a finite number.
    #[error("line {line}: {column} = {cell:?}; allowed is a finite number")]
    Cell {
        /// Where.
        line: u64,
        /// Column.
        column: &'static str,
        /// Content of the cell.
        cell: String,
    },
    /// x does not increase.
    #[error("line {line}: x_m = {x_m} after {before_m}; allowed is a greater x_m in every line")]
    Order {
        /// Where.
        line: u64,
        /// x of this line, m.
        x_m: f64,
        /// x of the previous line, m.
        before_m: f64,
    },
    /// A step is too long.
    #[error(
        "line {line}: a step of {step_m:e} m; allowed is up to {MOST_UNEVEN} times the shortest step, {shortest_m:e} m"
    )]
    Uneven {
        /// Line at which the longest step ends.
        line: u64,
        /// Length of the longest step, m.
        step_m: f64,
        /// Length of the shortest step, m.
        shortest_m: f64,
    },
    /// The profile is too short.
    #[error("{count} points; allowed is {LEAST_POINTS} or more")]
    TooFew {
        /// Number of points.
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

    /// Reads CSV with the columns `x_m` and `z_m`, in m; other columns and lines that start with `#` are
    /// ignored. x increases from line to line.
    ///
    /// # Errors
    /// A column is missing, a cell is not a finite number, x does not increase, fewer than [`LEAST_POINTS`] points, or
    /// a ratio of steps above [`MOST_UNEVEN`].
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
                return Err(ProfileError::Order { line, x_m: x, before_m });
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
        return Err(ProfileError::Uneven { line, step_m, shortest_m });
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
    value.ok_or_else(|| ProfileError::Cell { line, column, cell: cell.to_owned() })
}
