//! `telemetry.csv`: all lines of telemetry.

use std::io;
use std::path::Path;
use std::time::Duration;

use thermal_client::client::{ReceivedTelemetry, Telemetry};

use super::{RecordingError, unreadable};

/// Columns of the values, in the order of a line on the wire.
const VALUES: [&str; 9] = [
    "setpoint_c",
    "display_c",
    "sink_c",
    "skin_c",
    "room_c",
    "force_n",
    "demand_a",
    "current_a",
    "evaluations",
];

/// The first line.
pub(super) fn header() -> String {
    format!("t_s,finger,tick,state,{},remark\n", VALUES.join(","))
}

/// A line at a time of the session, s, of a finger of the device. Values that are not known are empty.
pub(super) fn row((t_s, finger, line): (f64, u8, &Telemetry)) -> String {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let values = [
        line.setpoint_c,
        line.display_c,
        line.sink_c,
        line.skin_c,
        line.room_c,
        line.force_n,
        line.demand_a,
        line.current_a,
    ];
    let count = line.evaluations.map_or(String::new(), |count| count.to_string());
    let cells: Vec<_> = values.map(number).into_iter().chain([count]).collect();
    format!(
        "{t_s:.4},{finger},{},{},{},{}\n",
        line.tick,
        line.state.name(),
        cells.join(","),
        line.remark().unwrap_or("-")
    )
}

/// All lines with their times, s.
pub(super) fn read(path: &Path) -> Result<Vec<(f64, ReceivedTelemetry)>, RecordingError> {
    let unreadable = |error: csv::Error| unreadable(path)(io::Error::other(error.to_string()));
    let mut rows = csv::Reader::from_path(path).map_err(unreadable)?;
    let mut lines = Vec::new();
    for (number, row) in (2..).zip(rows.records()) {
        let row = row.map_err(unreadable)?;
        let line = line_of(&row).ok_or_else(|| RecordingError::Content {
            path: path.into(),
            line: number,
            problem: "this is no line of telemetry".into(),
        })?;
        lines.push(line);
    }
    Ok(lines)
}

/// A row as the line that was received.
fn line_of(row: &csv::StringRecord) -> Option<(f64, ReceivedTelemetry)> {
    let t_s: f64 = row.get(0)?.parse().ok()?;
    let words = row.iter().skip(2).map(|cell| if cell.is_empty() { "-" } else { cell });
    let words: Vec<_> = ["T"].into_iter().chain(words).collect();
    let line = ReceivedTelemetry {
        finger: Some(row.get(1)?.parse().ok()?),
        telemetry: Telemetry::parse(&words.join(" "))?,
        at: Duration::try_from_secs_f64(t_s).ok()?,
        lost_before: 0,
    };
    Some((t_s, line))
}
