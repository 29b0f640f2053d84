//! `physio.tsv.gz`: telemetry of a finger of the device, in rows of equal distance.

use std::io::{self, Write};
use std::path::Path;

use flate2::{Compression, GzBuilder};
use serde_json::{Value, json};
use thermal_device::StateName;

use super::events::UNKNOWN;
use super::{RecordingError, at};

/// The columns: name, column of `telemetry.csv`, unit and description. The state is a number, because cells are.
const COLUMNS: [(&str, &str, &str, &str); 10] = [
    (
        "setpoint",
        "setpoint_c",
        "degC",
        "Set-point of the display's surface",
    ),
    ("display", "display_c", "degC", "Thermistor of the display"),
    ("sink", "sink_c", "degC", "Thermistor of the heat sink"),
    (
        "skin",
        "skin_c",
        "degC",
        "Thermistor on the skin at the edge of the contact",
    ),
    ("room", "room_c", "degC", "Thermistor of the room"),
    ("force", "force_n", "N", "Force of the finger"),
    (
        "demand",
        "demand_a",
        "A",
        "Demanded current of the Peltier module; positive cools",
    ),
    (
        "current",
        "current_a",
        "A",
        "Magnitude of the measured current",
    ),
    (
        "limited",
        "limited",
        "",
        "1 if the set-point is limited or not followed",
    ),
    ("state", "state", "", "State of the device"),
];

/// Names of the states, whose places are their numbers. A trip has a fault, which the log names.
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

/// Writes the rows of a finger, one every `interval_ms` from the begin of the session on, from `telemetry`. Returns the
/// compressed file; without a time in it, so that equal telemetry gives equal bytes.
pub(super) fn compressed(
    telemetry: &Path,
    finger: u8,
    interval_ms: u32,
) -> Result<Vec<u8>, RecordingError> {
    let mut rows =
        csv::Reader::from_path(telemetry).map_err(|error| unreadable(telemetry, &error))?;
    let headers = rows
        .headers()
        .map_err(|error| unreadable(telemetry, &error))?
        .clone();
    let index = |name: &str| headers.iter().position(|header| header == name);
    let places: Vec<_> = COLUMNS.iter().map(|(_, name, ..)| index(name)).collect();
    let (time, of_finger) = (index("t_s"), index("finger"));
    let mut gzip = GzBuilder::new()
        .mtime(0)
        .write(Vec::new(), Compression::default());
    let nothing = [UNKNOWN; COLUMNS.len()].join("\t") + "\n";
    let mut next_row: i64 = 0;
    for row in rows.records() {
        let row = row.map_err(|error| unreadable(telemetry, &error))?;
        let cell =
            |place: Option<usize>| place.and_then(|place| row.get(place)).unwrap_or_default();
        if cell(of_finger).parse() != Ok(finger) {
            continue;
        }
        let Ok(t_s) = cell(time).parse::<f64>() else {
            continue;
        };
        let place = (t_s * 1e3 / f64::from(interval_ms)).round() as i64;
        // Of two lines that are nearest to the same row the first counts.
        if place < next_row {
            continue;
        }
        for _ in next_row..place {
            gzip.write_all(nothing.as_bytes()).map_err(at(telemetry))?;
        }
        let cells: Vec<_> = (COLUMNS.iter().zip(&places))
            .map(|((name, ..), place)| physio_cell(name, cell(*place)))
            .collect();
        gzip.write_all((cells.join("\t") + "\n").as_bytes())
            .map_err(at(telemetry))?;
        next_row = place + 1;
    }
    gzip.finish().map_err(at(telemetry))
}

fn physio_cell(name: &str, cell: &str) -> String {
    match (name, cell) {
        (_, "") => UNKNOWN.into(),
        ("state", word) => {
            let known = STATES.iter().position(|state| state.name() == word);
            known.unwrap_or(TRIPPED).to_string()
        }
        (_, number) => number.into(),
    }
}

/// An error of the reader of tables.
fn unreadable(path: &Path, error: &csv::Error) -> RecordingError {
    at(path)(io::Error::other(error.to_string()))
}

/// What the columns are.
pub(super) fn sidecar(interval_ms: u32) -> Value {
    let names: Vec<_> = COLUMNS.iter().map(|(name, ..)| *name).collect();
    let mut about = json!({
        "SamplingFrequency": 1e3 / f64::from(interval_ms),
        "StartTime": 0.0,
        "Columns": names,
    });
    for (name, _, unit, description) in COLUMNS {
        about[name] = json!({ "Description": description });
        if !unit.is_empty() {
            about[name]["Units"] = unit.into();
        }
    }
    let numbered = STATES
        .iter()
        .map(|state| state.name())
        .chain(["tripped"])
        .enumerate();
    about["state"]["Levels"] = numbered
        .map(|(number, name)| (number.to_string(), Value::from(name)))
        .collect();
    about
}
