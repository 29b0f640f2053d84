//! Reading a course from a CSV file.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use super::{Course, CoursePoint};
use crate::text;

/// Temperatures that may stand in a file, °C: those of the display's range, which the device checks as well.
pub const ALLOWED_C: RangeInclusive<f64> = 15.0..=42.0;
/// Column of the time, s.
const TIME: &str = "t_s";
/// Column of the temperature of a file of two columns, °C.
const CELSIUS: &str = "celsius";
/// Column of a trace that is played unless another is chosen: the display's surface, °C.
const DISPLAY: &str = "display_c";
/// Column of the force, N, whose first positive value is the landing.
const FORCE: &str = "force_n";

/// What is played of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Selection<'a> {
    /// The column of the temperature; without it `celsius`, or `display_c` of a trace.
    pub column: Option<&'a str>,
}

/// Why a file is no course.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CourseFileError {
    /// The file cannot be read.
    #[error("{}: {problem}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// Why.
        problem: String,
    },
    /// The course as a whole is not played.
    #[error("{}: {problem}", file.display())]
    Whole {
        /// The file.
        file: PathBuf,
        /// Why, and what is allowed.
        problem: String,
    },
    /// A line is wrong, or begins what a device would refuse.
    #[error("{}:{line}: {problem}", file.display())]
    Line {
        /// The file.
        file: PathBuf,
        /// The line, from 1.
        line: u64,
        /// What is wrong, and what is allowed.
        problem: String,
    },
}

/// A course, and the lines of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct CourseFile {
    file: PathBuf,
    /// The course.
    pub course: Course,
    /// Line of each point.
    lines: Vec<u64>,
}

impl CourseFile {
    /// That something is wrong with the course at a time of it, s.
    pub(super) fn wrong_at(&self, t_s: f64, problem: String) -> CourseFileError {
        let index = self.course.points().partition_point(|point| point.t_s < t_s);
        let line = self.lines.get(index).or(self.lines.last()).copied().unwrap_or(1);
        CourseFileError::Line { file: self.file.clone(), line, problem }
    }

    /// That the course as a whole is not played.
    pub(super) fn wrong(&self, problem: String) -> CourseFileError {
        CourseFileError::Whole { file: self.file.clone(), problem }
    }
}

/// Reads a course from a CSV file: two columns of seconds since the landing and degrees Celsius, with or without the header
/// `t_s,celsius`; or columns with a header, among them `t_s`, such as a `trace.csv`. If there is a column `force_n`, the course
/// begins at its first positive value and ends with the contact.
///
/// # Errors
/// The first thing that is wrong, with file and line, and what is allowed.
pub fn read_course(path: &Path, selection: Selection<'_>) -> Result<CourseFile, CourseFileError> {
    let unreadable = |problem: String| CourseFileError::Unreadable { file: path.into(), problem };
    let text =
        text::read(path, text::TABLE_BYTES_MAX).map_err(|error| unreadable(error.to_string()))?;
    parse_course(&text, path, selection)
}

/// Reads a course from a file's text; `path` is for messages.
fn parse_course(
    text: &str,
    path: &Path,
    selection: Selection<'_>,
) -> Result<CourseFile, CourseFileError> {
    let wrong =
        |line: u64, problem: String| CourseFileError::Line { file: path.into(), line, problem };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut columns: Option<Columns> = None;
    let (mut points, mut lines) = (Vec::<CoursePoint>::new(), Vec::new());
    let mut landed_s = None;
    let mut last_line = 1;
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(last_line, csv::Position::line);
            wrong(line, csv_problem(&error))
        })?;
        let line = record.position().map_or(last_line, csv::Position::line);
        last_line = line;
        let of = match columns {
            Some(columns) => columns,
            None => {
                let (of, has_header) =
                    Columns::find(&record, selection).map_err(|problem| wrong(line, problem))?;
                columns = Some(of);
                if has_header {
                    continue;
                }
                of
            }
        };
        let number = |column: usize, what: &str| -> Result<f64, CourseFileError> {
            let cell = record.get(column).unwrap_or("");
            (cell.parse().ok().filter(|value: &f64| value.is_finite())).ok_or_else(|| {
                wrong(line, format!("{what} `{cell}` is no number; a number is allowed"))
            })
        };
        let mut t_s = number(of.time, TIME)?;
        if let Some(force) = of.force {
            let in_contact = number(force, FORCE)? > 0.0;
            match landed_s {
                None if !in_contact => continue,
                Some(_) if !in_contact => break,
                _ => {}
            }
            t_s -= *landed_s.get_or_insert(t_s);
        }
        let celsius = number(of.celsius, of.name)?;
        if !ALLOWED_C.contains(&celsius) {
            let (least, most) = ALLOWED_C.into_inner();
            return Err(wrong(
                line,
                format!("{} {celsius} is out of range; {least} to {most} °C are allowed", of.name),
            ));
        }
        match points.last() {
            None if t_s < 0.0 => {
                let problem =
                    format!("{TIME} {t_s} is before the landing; 0 s and later is allowed");
                return Err(wrong(line, problem));
            }
            Some(last) if t_s <= last.t_s => {
                let problem = format!(
                    "{TIME} {t_s} is not after {}, that of the row before; times that rise are allowed",
                    last.t_s
                );
                return Err(wrong(line, problem));
            }
            _ => {}
        }
        points.push(CoursePoint { t_s, celsius });
        lines.push(line);
    }
    let Some(first) = points.first().copied() else {
        let problem = match columns {
            Some(Columns { force: Some(_), .. }) => "no row with a positive force_n",
            _ => "no row of a time in seconds and a temperature in °C",
        };
        return Err(wrong(last_line, format!("{problem}; at least two are needed")));
    };
    if first.t_s > 0.0 {
        points.insert(0, CoursePoint { t_s: 0.0, ..first });
        lines.insert(0, lines[0]);
    }
    if points.len() == 1 {
        let problem = "one row is no course; at least two are needed";
        return Err(wrong(last_line, problem.into()));
    }
    let course = Course::new(points).map_err(|error| wrong(last_line, error.to_string()))?;
    Ok(CourseFile { file: path.into(), course, lines })
}

/// Indices of the columns that are read, and the name of that of the temperature.
#[derive(Clone, Copy)]
struct Columns {
    time: usize,
    celsius: usize,
    name: &'static str,
    force: Option<usize>,
}

impl Columns {
    /// Finds the columns by the first row, and says whether that is a header.
    fn find(first: &csv::StringRecord, selection: Selection<'_>) -> Result<(Self, bool), String> {
        let names: Vec<&str> = first.iter().collect();
        for (separator, word) in [(';', "a semicolon"), ('\t', "a tab")] {
            if names.iter().any(|name| name.contains(separator)) {
                return Err(format!(
                    "{word} separates the columns; allowed is a comma between columns, and a point before decimals"
                ));
            }
        }
        if names.iter().all(|cell| cell.parse::<f64>().is_ok()) {
            return match (names.len(), selection.column) {
                (2, None) => Ok((Self { time: 0, celsius: 1, name: CELSIUS, force: None }, false)),
                (2, Some(column)) => Err(format!(
                    "there is no column `{column}`: the file has no header; two columns of seconds and °C are allowed \
                     without one"
                )),
                (count, _) => Err(format!(
                    "{count} columns without a header; two, seconds and °C, are allowed, or a header with {TIME}"
                )),
            };
        }
        if let Some(name) = text::repeated_column(names.iter().copied()) {
            return Err(format!("two columns `{name}`; allowed is each name once"));
        }
        let position = |name: &str| names.iter().position(|known| *known == name);
        let missing =
            |name: &str| format!("there is no column `{name}` among {}", names.join(", "));
        let time = position(TIME).ok_or_else(|| {
            format!("{}; a header with {TIME} and a temperature is allowed", missing(TIME))
        })?;
        let (celsius, name) = match selection.column {
            Some(column) => (position(column).ok_or_else(|| missing(column))?, "temperature"),
            None => (position(CELSIUS).map(|i| (i, CELSIUS)))
                .or_else(|| position(DISPLAY).map(|i| (i, DISPLAY)))
                .ok_or_else(|| format!("{}, nor `{DISPLAY}`", missing(CELSIUS)))?,
        };
        Ok((Self { time, celsius, name, force: position(FORCE) }, true))
    }
}

/// What the CSV reader objects to.
fn csv_problem(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => format!(
            "{len} columns, and {expected_len} in the first row; the same number in all rows is allowed"
        ),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Vec<(f64, f64)>, String> {
        select(text, None)
    }

    fn select(text: &str, column: Option<&str>) -> Result<Vec<(f64, f64)>, String> {
        let read = parse_course(text, Path::new("c.csv"), Selection { column });
        let course = read.map_err(|error| error.to_string())?.course;
        let points = course.points().iter();
        Ok(points.map(|point| (point.t_s, point.celsius)).collect())
    }

    #[test]
    fn two_columns_are_read_with_and_without_a_header() {
        let points = Ok(vec![(0.0, 30.0), (0.5, 28.0), (2.0, 29.5)]);
        assert_eq!(parse("t_s,celsius\n0,30\n0.5,28\n2,29.5\n"), points);
        assert_eq!(parse("0,30\n0.5, 28\n# a remark\n2,29.5"), points);
        assert_eq!(parse("\u{feff}celsius,t_s\r\n30,0\r\n28,0.5\r\n29.5,2\r\n"), points);
    }

    #[test]
    fn a_file_that_begins_late_holds_its_first_temperature_from_the_landing_on() {
        assert_eq!(parse("1,30\n2,28"), Ok(vec![(0.0, 30.0), (1.0, 30.0), (2.0, 28.0)]));
    }

    #[test]
    fn a_trace_is_played_from_landing_to_lift() {
        let trace = "t_s,force_n,display_c,skin_c\n0,0,33,34\n1,2,26,34\n1.5,2,25,28\n2,0,24,27\n3,2,23,26\n";
        assert_eq!(parse(trace), Ok(vec![(0.0, 26.0), (0.5, 25.0)]));
        assert_eq!(select(trace, Some("skin_c")), Ok(vec![(0.0, 34.0), (0.5, 28.0)]));
    }

    #[test]
    fn a_wrong_file_is_answered_with_its_line_its_value_and_what_is_allowed() {
        for (text, answer) in [
            (
                "",
                "c.csv:1: no row of a time in seconds and a temperature in °C; at least two are needed",
            ),
            ("0,30\n", "c.csv:1: one row is no course; at least two are needed"),
            (
                "t_s,celsius\n",
                "c.csv:1: no row of a time in seconds and a temperature in °C; at least two are needed",
            ),
            ("0,30\n1,x\n", "c.csv:2: celsius `x` is no number; a number is allowed"),
            ("0,30\n1,NaN\n", "c.csv:2: celsius `NaN` is no number; a number is allowed"),
            ("0,30\nsoon,29\n", "c.csv:2: t_s `soon` is no number; a number is allowed"),
            ("0,30\n1,50\n", "c.csv:2: celsius 50 is out of range; 15 to 42 °C are allowed"),
            ("0,30\n1,14.9\n", "c.csv:2: celsius 14.9 is out of range; 15 to 42 °C are allowed"),
            (
                "0,30\n1,29\n1,28\n",
                "c.csv:3: t_s 1 is not after 1, that of the row before; times that rise are allowed",
            ),
            ("-1,30\n", "c.csv:1: t_s -1 is before the landing; 0 s and later is allowed"),
            (
                "0,30\n1\n",
                "c.csv:2: 1 columns, and 2 in the first row; the same number in all rows is allowed",
            ),
            (
                "0;30,5\n1;31,5\n",
                "c.csv:1: a semicolon separates the columns; allowed is a comma between columns, and a point before decimals",
            ),
            (
                "t_s\tcelsius\n0\t30\n",
                "c.csv:1: a tab separates the columns; allowed is a comma between columns, and a point before decimals",
            ),
            (
                "0,30,1\n",
                "c.csv:1: 3 columns without a header; two, seconds and °C, are allowed, or a header with t_s",
            ),
            (
                "time,celsius\n0,30\n",
                "c.csv:1: there is no column `t_s` among time, celsius; a header with t_s and a temperature is allowed",
            ),
            (
                "t_s,celsius,celsius\n0,30,31\n1,29,30\n",
                "c.csv:1: two columns `celsius`; allowed is each name once",
            ),
            (
                "t_s,t_s,celsius\n0,0,30\n1,1,30\n",
                "c.csv:1: two columns `t_s`; allowed is each name once",
            ),
            (
                "t_s,kelvin\n0,300\n",
                "c.csv:1: there is no column `celsius` among t_s, kelvin, nor `display_c`",
            ),
            (
                "t_s,force_n,display_c\n0,0,30\n",
                "c.csv:2: no row with a positive force_n; at least two are needed",
            ),
        ] {
            assert_eq!(parse(text), Err(answer.into()), "{text:?}");
        }
        assert_eq!(
            select("t_s,celsius\n0,30\n", Some("skin_c")),
            Err("c.csv:1: there is no column `skin_c` among t_s, celsius".into())
        );
        let none = read_course(Path::new("no-such-file.csv"), Selection::default());
        assert!(matches!(none, Err(CourseFileError::Unreadable { .. })), "{none:?}");
    }
}
