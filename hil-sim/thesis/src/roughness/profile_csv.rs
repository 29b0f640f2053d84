//! Reading of profiles from CSV.

use std::io;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use thermal_client::text;
use thiserror::Error;

use super::Profile;
use super::equal_steps::{EqualSteps, coarsest, recognise};
use super::parameters::{levelled, rms_slope};
use super::printed::{Printed, units};

/// Least number of points of a profile.
pub const LEAST_POINTS: usize = 20;
/// Largest ratio of the longest to the shortest step: beyond it the slopes of Eq. A-2 depend more on the positions of the
/// points than on the surface.
pub const MOST_UNEVEN: f64 = 10.0;
/// Largest magnitude of a position or height, m. No surface is larger, and no parameter overflows.
const LARGEST_M: f64 = 1e3;
/// Shortest step, m: a hundredth of an atom.
const SHORTEST_STEP_M: f64 = 1e-12;
/// Largest unit of the last digit of the positions, as a fraction of the shortest step, with which unequal steps are taken as
/// printed. A profile with a tilt of 5 % then gets a false slope of 2e-4.
const COARSEST_UNEQUAL: f64 = 0.01;
/// Fraction of a step by which printed positions may differ from equal steps and are still taken as they are.
const EXACT: f64 = 1e-6;
/// Slope, m/m, that the last digit of the heights may always be over a step: no surface of a scene is so smooth.
const SMOOTHEST_SLOPE: f64 = 1e-4;

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
    /// Two columns have the same name.
    #[error("line 1: two columns {name:?}; allowed is each name once")]
    RepeatedColumn {
        /// The name.
        name: String,
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
    /// A position or height is too large.
    #[error("line {line}: {column} = {value:e}; allowed is from -{LARGEST_M:e} to {LARGEST_M:e} m")]
    Size {
        /// Where.
        line: u64,
        /// Column.
        column: &'static str,
        /// Value of the cell.
        value: f64,
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
    /// A step is too short.
    #[error("line {line}: a step of {step_m:e} m; allowed is {SHORTEST_STEP_M:e} m or more")]
    Short {
        /// Line at which the step ends.
        line: u64,
        /// Length of the step, m.
        step_m: f64,
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
    /// Positions have too few digits, and are not those of equal steps.
    #[error(
        "line {line}: x_m is printed to {unit_m:.1e} m, and a step of {step_m:.1e} m ends here; allowed are equal steps, or \
         a last digit of up to {COARSEST_UNEQUAL} of the shortest step"
    )]
    CoarsePositions {
        /// Line at which the shortest step ends.
        line: u64,
        /// Unit of the last digit of the positions, m.
        unit_m: f64,
        /// Length of the shortest step, m.
        step_m: f64,
    },
    /// Heights have too few digits: slopes would be those of their rounding.
    #[error(
        "z_m is printed to {unit_m:.1e} m, which over a step is a slope of {rounding:.1e}; allowed is up to the RMS slope of the \
         profile, {rdq:.1e}, or {SMOOTHEST_SLOPE:e}"
    )]
    CoarseHeights {
        /// Unit of the last digit of the heights, m.
        unit_m: f64,
        /// This unit over the mean step, m/m.
        rounding: f64,
        /// RMS slope of the heights as printed, m/m.
        rdq: f64,
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
        Self::parse(text::open(path, text::RECORDING_BYTES_MAX)?)
    }

    /// Reads CSV with the columns `x_m` and `z_m`, in m; other columns and lines that start with `#` are
    /// ignored. x increases from line to line.
    ///
    /// Where the printed positions are those of equal steps, rounded, the profile has equal steps in their place
    /// ([`Self::equal_steps`]).
    ///
    /// # Errors
    /// A column is missing, a cell is not a finite number or too large, x does not increase or too little, fewer than
    /// [`LEAST_POINTS`] points, a ratio of steps above [`MOST_UNEVEN`], or too few digits.
    pub fn parse(text: impl io::Read) -> Result<Self, ProfileError> {
        let mut csv = ReaderBuilder::new()
            .trim(Trim::All)
            .comment(Some(b'#'))
            .flexible(true)
            .from_reader(text);
        let header = csv.headers()?.clone();
        if let Some(name) = text::repeated_column(&header) {
            return Err(ProfileError::RepeatedColumn { name: name.to_owned() });
        }
        let column = |name: &str| {
            let found = header.iter().position(|column| column == name);
            found.ok_or_else(|| ProfileError::Columns {
                found: header.iter().collect::<Vec<_>>().join(", "),
            })
        };
        let (x_column, z_column) = (column("x_m")?, column("z_m")?);
        let (mut lines, mut x, mut z) = (Vec::new(), Vec::<Printed>::new(), Vec::new());
        for row in csv.records() {
            let row = row?;
            let line = row.position().map_or(0, csv::Position::line);
            let position = number(&row, line, "x_m", x_column)?;
            if let Some(before) = x.last() {
                check_step(line, before.value, position.value)?;
            }
            lines.push(line);
            x.push(position);
            z.push(number(&row, line, "z_m", z_column)?);
        }
        if x.len() < LEAST_POINTS {
            return Err(ProfileError::TooFew { count: x.len() });
        }
        let (x_m, equal_steps) = positions(&lines, &x)?;
        let z_m = z.iter().map(|height| height.value).collect();
        let profile = Self { x_m, z_m, equal_steps };
        profile.check_heights(coarsest(&units(&z)))?;
        Ok(profile)
    }

    /// Checks that the slopes are not those of the rounded heights.
    fn check_heights(&self, unit_m: f64) -> Result<(), ProfileError> {
        let Self { x_m, z_m, .. } = self;
        let is_flat = z_m.iter().all(|z| *z == z_m[0]);
        let steps = (x_m.len() - 1) as f64;
        let rounding = unit_m * steps / (x_m[x_m.len() - 1] - x_m[0]);
        let rdq = rms_slope(x_m, &levelled(x_m, z_m));
        if is_flat || rounding <= rdq.max(SMOOTHEST_SLOPE) {
            return Ok(());
        }
        Err(ProfileError::CoarseHeights { unit_m, rounding, rdq })
    }
}

fn check_step(line: u64, before_m: f64, x_m: f64) -> Result<(), ProfileError> {
    if x_m <= before_m {
        return Err(ProfileError::Order { line, x_m, before_m });
    }
    let step_m = x_m - before_m;
    if step_m < SHORTEST_STEP_M {
        return Err(ProfileError::Short { line, step_m });
    }
    Ok(())
}

/// Positions, m, as printed or, where their digits are too few, equidistant.
fn positions(
    lines: &[u64],
    printed: &[Printed],
) -> Result<(Vec<f64>, Option<EqualSteps>), ProfileError> {
    let x_m: Vec<f64> = printed.iter().map(|position| position.value).collect();
    let (mut shortest, mut longest) = ((f64::INFINITY, 0), (0.0, 0));
    for (x, &line) in x_m.windows(2).zip(&lines[1..]) {
        let step_m = x[1] - x[0];
        if step_m < shortest.0 {
            shortest = (step_m, line);
        }
        if step_m > longest.0 {
            longest = (step_m, line);
        }
    }
    let (shortest_m, shortest_line) = shortest;
    let (step_m, line) = longest;
    if step_m > MOST_UNEVEN * shortest_m {
        return Err(ProfileError::Uneven { line, step_m, shortest_m });
    }
    let units_m = units(printed);
    let unit_m = coarsest(&units_m);
    if unit_m <= EXACT * shortest_m {
        return Ok((x_m, None));
    }
    match recognise(&x_m, &units_m) {
        Some((equidistant_m, steps)) => {
            let mut pairs = x_m.iter().zip(&equidistant_m);
            let is_exact = pairs.all(|(x, even)| (x - even).abs() <= EXACT * steps.step_m);
            Ok(if is_exact { (x_m, None) } else { (equidistant_m, Some(steps)) })
        }
        None if unit_m <= COARSEST_UNEQUAL * shortest_m => Ok((x_m, None)),
        None => {
            let line = shortest_line;
            Err(ProfileError::CoarsePositions { line, unit_m, step_m: shortest_m })
        }
    }
}

/// The number in a cell.
fn number(
    row: &StringRecord,
    line: u64,
    column: &'static str,
    index: usize,
) -> Result<Printed, ProfileError> {
    let cell = row.get(index).unwrap_or("");
    let Some(printed) = Printed::parse(cell) else {
        return Err(ProfileError::Cell { line, column, cell: cell.to_owned() });
    };
    let value = printed.value;
    if value.abs() > LARGEST_M {
        return Err(ProfileError::Size { line, column, value });
    }
    Ok(printed)
}
