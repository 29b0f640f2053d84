//! `physio.tsv.gz`: telemetry of a finger of the device, in rows of equal distance.

use std::io::Write;
use std::path::Path;

use flate2::{Compression, GzBuilder};
use serde_json::{Value, json};
use thermal_client::client::{AvailableFields, Telemetry, TelemetryColumn};
use thermal_device::StateName;

use super::events::UNKNOWN;
use super::{RecordingError, error_at, telemetry};

/// A column of the rows.
enum Column {
    /// A field of the telemetry.
    Field(&'static TelemetryColumn),
    /// Whether the set-point is limited.
    Limited,
    /// The state, as a number.
    State,
}

/// The columns of a recording with these fields. The count of evaluations is of the firmware, not of a finger.
fn columns(fields: AvailableFields) -> Vec<Column> {
    let measured = TelemetryColumn::default_ones().iter().filter(|field| !field.unit.is_empty());
    (measured.map(Column::Field))
        .chain([Column::Limited, Column::State])
        .chain(fields.further_columns().map(Column::Field))
        .collect()
}

impl Column {
    const fn name(&self) -> &'static str {
        match self {
            Self::Field(field) => field.quantity(),
            Self::Limited => "limited",
            Self::State => "state",
        }
    }

    fn value(&self, line: &Telemetry) -> Option<f64> {
        match self {
            Self::Field(field) => field.number(line),
            Self::Limited => Some(f64::from(u8::from(line.limited))),
            Self::State => {
                let known = STATES.iter().position(|state| *state == line.state);
                Some(known.unwrap_or(TRIPPED) as f64)
            }
        }
    }

    /// What the sidecar says of it.
    fn about(&self) -> Value {
        let (description, unit, words) = match self {
            Self::Field(field) => (field.description, field.unit, field.words()),
            Self::Limited => ("1 if the set-point is limited or not followed", "", Vec::new()),
            Self::State => (
                "State of the device; a trip has a fault, which the log names",
                "",
                STATES.iter().map(|state| state.name()).chain(["tripped"]).collect(),
            ),
        };
        let mut about = json!({ "Description": description });
        if !unit.is_empty() {
            about["Units"] = unit.into();
        }
        if !words.is_empty() {
            let numbered = words.into_iter().enumerate();
            about["Levels"] =
                numbered.map(|(number, word)| (number.to_string(), Value::from(word))).collect();
        }
        about
    }
}

/// The states, whose places are their numbers.
const STATES: [StateName; 7] = [
    StateName::Off,
    StateName::SelfTest,
    StateName::Ready,
    StateName::Armed,
    StateName::Preset,
    StateName::Contact,
    StateName::Stimulus,
];
/// Number of the state `tripped`.
const TRIPPED: usize = STATES.len();

/// The rows of a finger.
pub(super) struct Rows {
    /// Compressed, without a time in it, so that equal telemetry gives equal bytes.
    pub gzip: Vec<u8>,
    /// What its columns are.
    pub sidecar: Value,
}

/// The rows of a finger, one every `interval_ms` from the begin of the session on, from `telemetry.csv`.
pub(super) fn compressed(
    telemetry: &Path,
    task: &str,
    finger: u8,
    interval_ms: u32,
) -> Result<Rows, RecordingError> {
    let mut gzip = GzBuilder::new().mtime(0).write(Vec::new(), Compression::default());
    let columns = columns(telemetry::fields(telemetry)?);
    let nothing = vec![UNKNOWN; columns.len()].join("\t") + "\n";
    let mut next_row: i64 = 0;
    let mut off_max_s: f64 = 0.0;
    let interval_s = 1e-3 * f64::from(interval_ms);
    for (t_s, received) in telemetry::read(telemetry)? {
        let row = (t_s / interval_s).round() as i64;
        // Of two lines that are nearest to the same row the first counts.
        if received.finger != Some(finger) || row < next_row {
            continue;
        }
        for _ in next_row..row {
            gzip.write_all(nothing.as_bytes()).map_err(error_at(telemetry))?;
        }
        let cell = |column: &Column| {
            column.value(&received.telemetry).map_or(UNKNOWN.into(), |value| value.to_string())
        };
        let cells: Vec<_> = columns.iter().map(cell).collect();
        gzip.write_all((cells.join("\t") + "\n").as_bytes()).map_err(error_at(telemetry))?;
        next_row = row + 1;
        off_max_s = off_max_s.max((t_s - row as f64 * interval_s).abs());
    }
    let gzip = gzip.finish().map_err(error_at(telemetry))?;
    Ok(Rows { gzip, sidecar: sidecar(task, &columns, interval_ms, off_max_s) })
}

/// What the columns of a task are, and how far the rows' times are off, s: the device's ticks are not those of the session.
fn sidecar(task: &str, columns: &[Column], interval_ms: u32, off_max_s: f64) -> Value {
    let names: Vec<_> = columns.iter().map(Column::name).collect();
    let mut about = json!({
        "TaskName": task,
        "SamplingFrequency": 1e3 / f64::from(interval_ms),
        "StartTime": 0.0,
        "PhysioType": "generic",
        "TimeErrorMax": (off_max_s * 1e4).round() / 1e4,
        "TimeErrorDescription": "A row is the line of telemetry nearest to its time; the largest distance, in seconds",
        "Columns": names,
    });
    for column in columns {
        about[column.name()] = column.about();
    }
    about
}
