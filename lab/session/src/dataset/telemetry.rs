//! `telemetry.csv`: all lines of telemetry.

use std::io::{self, Read};
use std::path::Path;
use std::time::Duration;

use thermal_client::client::{AvailableFields, ReceivedTelemetry, Telemetry, TelemetryColumn};
use thermal_client::text;
use thermal_wire::host::COLUMNS;
use thermal_wire::telemetry::{ALL_FIELDS, UNKNOWN_WORD};

use super::{RecordingError, unreadable};

/// Columns before those of the telemetry.
const BEFORE: [&str; 4] = ["t_s", "finger", "tick", "state"];
/// Column between those of every line and the further ones.
const REMARK: &str = "remark";

/// The first line, of a device with these fields.
pub(super) fn header(fields: AvailableFields) -> String {
    let name = |column: &TelemetryColumn| column.name;
    let names = (BEFORE.into_iter())
        .chain(TelemetryColumn::default_ones().iter().map(name))
        .chain([REMARK])
        .chain(fields.further_columns().map(name));
    names.collect::<Vec<_>>().join(",") + "\n"
}

/// A line at a time of the session, s, of a finger of the device. Values that are not known are empty.
pub(super) fn row((t_s, finger, line): (f64, u8, &Telemetry), fields: AvailableFields) -> String {
    let cell = |column: &TelemetryColumn| column.text(line).unwrap_or_default();
    let before =
        [format!("{t_s:.4}"), finger.to_string(), line.tick.to_string(), line.state.name().into()];
    let cells = (before.into_iter())
        .chain(TelemetryColumn::default_ones().iter().map(cell))
        .chain([line.remark().unwrap_or(UNKNOWN_WORD).into()])
        .chain(fields.further_columns().map(cell));
    cells.collect::<Vec<_>>().join(",") + "\n"
}

/// The rows of a file, whose header has each name once.
fn rows(path: &Path) -> Result<csv::Reader<impl Read>, RecordingError> {
    let file = text::open(path, text::RECORDING_BYTES_MAX).map_err(unreadable(path))?;
    let mut rows = csv::Reader::from_reader(file);
    let header = rows.headers().map_err(unreadable_csv(path))?;
    if let Some(name) = text::repeated_column(header) {
        let problem = format!("two columns {name:?}; allowed is each name once");
        return Err(RecordingError::Content { path: path.into(), line: 1, problem });
    }
    Ok(rows)
}

/// The fields whose columns a file has.
pub(super) fn fields(path: &Path) -> Result<AvailableFields, RecordingError> {
    let mut rows = rows(path)?;
    let header = rows.headers().map_err(unreadable_csv(path))?;
    Ok(AvailableFields::of_table(header.iter()))
}

/// All lines with their times, s.
pub(super) fn read(path: &Path) -> Result<Vec<(f64, ReceivedTelemetry)>, RecordingError> {
    let mut rows = rows(path)?;
    // A line on the wire has the remark last.
    let words = BEFORE.into_iter().skip(2);
    let words = words.chain(COLUMNS.iter().map(|column| column.name)).chain([REMARK]);
    let header = rows.headers().map_err(unreadable_csv(path))?;
    let places: Vec<_> = words.map(|word| header.iter().position(|name| name == word)).collect();
    let mut lines = Vec::new();
    for (number, row) in (2..).zip(rows.records()) {
        let row = row.map_err(unreadable_csv(path))?;
        let line = line_of(&row, &places).ok_or_else(|| RecordingError::Content {
            path: path.into(),
            line: number,
            problem: "this is no line of telemetry".into(),
        })?;
        lines.push(line);
    }
    Ok(lines)
}

/// A row as the line that was received; `places` are the cells of its words, in the order of the wire.
fn line_of(row: &csv::StringRecord, places: &[Option<usize>]) -> Option<(f64, ReceivedTelemetry)> {
    let cells = places.iter().map(|place| row.get((*place)?).filter(|cell| !cell.is_empty()));
    let words: Vec<_> =
        ["T"].into_iter().chain(cells.map(|cell| cell.unwrap_or(UNKNOWN_WORD))).collect();
    let t_s = row.get(0)?.parse().ok()?;
    let line = ReceivedTelemetry {
        finger: Some(row.get(1)?.parse().ok()?),
        telemetry: Telemetry::parse_fields(&words.join(" "), ALL_FIELDS)?,
        at: Duration::try_from_secs_f64(t_s).ok()?,
        lost_before: 0,
    };
    Some((t_s, line))
}

fn unreadable_csv(path: &Path) -> impl Fn(csv::Error) -> RecordingError + '_ {
    move |error| unreadable(path)(io::Error::other(error.to_string()))
}
