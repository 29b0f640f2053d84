//! `physio.tsv.gz`: telemetry of a finger of the device, in rows of equal distance.

use std::io::Write;
use std::path::Path;

use flate2::{Compression, GzBuilder};
use serde_json::{Value, json};
use thermal_client::client::Telemetry;
use thermal_device::StateName;

use super::events::UNKNOWN;
use super::{RecordingError, error_at, telemetry};

/// A column: name, unit, description, and the value of a line.
type Column = (&'static str, &'static str, &'static str, fn(&Telemetry) -> Option<f64>);

const COLUMNS: [Column; 10] = [
    ("setpoint", "degC", "Set-point of the display's surface", |line| line.setpoint_c),
    ("display", "degC", "Thermistor of the display", |line| line.display_c),
    ("sink", "degC", "Thermistor of the heat sink", |line| line.sink_c),
    ("skin", "degC", "Thermistor on the skin at the edge of the contact", |line| line.skin_c),
    ("room", "degC", "Thermistor of the room", |line| line.room_c),
    ("force", "N", "Force of the finger", |line| line.force_n),
    ("demand", "A", "Demanded current of the Peltier module; positive cools", |line| line.demand_a),
    ("current", "A", "Magnitude of the measured current", |line| line.current_a),
    ("limited", "", "1 if the set-point is limited or not followed", |line| {
        Some(f64::from(u8::from(line.limited)))
    }),
    ("state", "", "State of the device; a trip has a fault, which the log names", |line| {
        let known = STATES.iter().position(|state| *state == line.state);
        Some(known.unwrap_or(TRIPPED) as f64)
    }),
];

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
    /// Largest distance of a line's time from that of its row, s: the device's ticks are not those of the session.
    pub off_max_s: f64,
}

/// The rows of a finger, one every `interval_ms` from the begin of the session on, from `telemetry.csv`.
pub(super) fn compressed(
    telemetry: &Path,
    finger: u8,
    interval_ms: u32,
) -> Result<Rows, RecordingError> {
    let mut gzip = GzBuilder::new().mtime(0).write(Vec::new(), Compression::default());
    let nothing = [UNKNOWN; COLUMNS.len()].join("\t") + "\n";
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
        let cells = COLUMNS.map(|(.., value)| {
            value(&received.telemetry).map_or(UNKNOWN.into(), |value| value.to_string())
        });
        gzip.write_all((cells.join("\t") + "\n").as_bytes()).map_err(error_at(telemetry))?;
        next_row = row + 1;
        off_max_s = off_max_s.max((t_s - row as f64 * interval_s).abs());
    }
    Ok(Rows { gzip: gzip.finish().map_err(error_at(telemetry))?, off_max_s })
}

/// What the columns of a task are, and how far the rows' times are off, s.
pub(super) fn sidecar(task: &str, interval_ms: u32, off_max_s: f64) -> Value {
    let names: Vec<_> = COLUMNS.iter().map(|(name, ..)| *name).collect();
    let mut about = json!({
        "TaskName": task,
        "SamplingFrequency": 1e3 / f64::from(interval_ms),
        "StartTime": 0.0,
        "PhysioType": "generic",
        "TimeErrorMax": (off_max_s * 1e4).round() / 1e4,
        "TimeErrorDescription": "A row is the line of telemetry nearest to its time; the largest distance, in seconds",
        "Columns": names,
    });
    for (name, unit, description, _) in COLUMNS {
        about[name] = json!({ "Description": description });
        if !unit.is_empty() {
            about[name]["Units"] = unit.into();
        }
    }
    let words = STATES.iter().map(|state| state.name()).chain(["tripped"]);
    let numbered = words.enumerate();
    about["state"]["Levels"] =
        numbered.map(|(number, name)| (number.to_string(), Value::from(name))).collect();
    about
}
