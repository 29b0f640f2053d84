//! One row a millisecond.

use std::collections::VecDeque;
use std::io;
use std::path::Path;

use serde::Serialize;

use crate::plant::Plant;
use crate::telemetry::Telemetry;

/// Rows that wait for their telemetry, and telemetry that waits for its row.
const WAITING: usize = 20;

/// The state at one time: of the plant, and what the device says of its last tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Time, s.
    pub t_s: f64,
    /// Force of the finger, N.
    pub force_n: f64,
    /// Surface of the display, °C.
    pub display_c: f64,
    /// Surface of the skin on it, °C.
    pub skin_c: f64,
    /// Surface of the same skin on the real object, °C.
    pub skin_real_c: f64,
    /// Surface of the real object, °C.
    pub object_real_c: f64,
    /// Sink, °C.
    pub sink_c: f64,
    /// Current through the module, A.
    pub current_a: f64,
    /// What the device said.
    pub device: Option<Telemetry>,
}

impl Row {
    /// The plant now; the device has not spoken yet.
    #[must_use]
    pub fn now(t_s: f64, plant: &Plant) -> Self {
        Self {
            t_s,
            force_n: plant.force_n(),
            display_c: plant.display_c(),
            skin_c: plant.skin_c(),
            skin_real_c: plant.skin_real_c(),
            object_real_c: plant.object_c(),
            sink_c: plant.sink_c(),
            current_a: plant.current_a(),
            device: None,
        }
    }
}

/// Rows of a run, each joined with the telemetry of the tick before it.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    rows: Vec<Row>,
    /// Tick before each of the last rows, and its index.
    waiting: VecDeque<(u64, usize)>,
    early: VecDeque<Telemetry>,
}

impl Trace {
    /// Adds a row; `tick` is the number of the device's last tick before it.
    pub fn push(&mut self, tick: u64, mut row: Row) {
        if let Some(index) = self.early.iter().position(|telemetry| telemetry.tick == tick) {
            row.device = self.early.remove(index);
        } else {
            keep(&mut self.waiting, (tick, self.rows.len()));
        }
        self.rows.push(row);
    }

    /// Gives the telemetry to its row, which may be still to come.
    pub fn join(&mut self, telemetry: Telemetry) {
        match self.waiting.iter().find(|(tick, _)| *tick == telemetry.tick) {
            Some((_, index)) => self.rows[*index].device = Some(telemetry),
            None => keep(&mut self.early, telemetry),
        }
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Writes `trace.csv`; a cell is empty where the device said nothing.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut csv = csv::Writer::from_path(path)?;
        for row in &self.rows {
            csv.serialize(Record::from(row))?;
        }
        csv.flush()
    }
}

fn keep<T>(last: &mut VecDeque<T>, new: T) {
    if last.len() == WAITING {
        last.pop_front();
    }
    last.push_back(new);
}

/// A row as it stands in the file.
#[derive(Serialize)]
struct Record<'a> {
    t_s: String,
    force_n: String,
    setpoint_c: String,
    display_c: String,
    sensor_c: String,
    skin_c: String,
    skin_real_c: String,
    sink_c: String,
    current_a: String,
    state: &'a str,
    demand_a: String,
    object_real_c: String,
    remark: &'a str,
}

impl<'a> From<&'a Row> for Record<'a> {
    fn from(row: &'a Row) -> Self {
        let device = row.device.as_ref();
        let said = |field: fn(&Telemetry) -> Option<f64>, digits: usize| {
            device
                .and_then(field)
                .map_or(String::new(), |value| format!("{value:.digits$}"))
        };
        Self {
            t_s: format!("{:.3}", row.t_s),
            force_n: format!("{:.6}", row.force_n),
            setpoint_c: said(|device| device.setpoint_c, 5),
            display_c: format!("{:.6}", row.display_c),
            sensor_c: said(|device| device.sensor_c, 4),
            skin_c: format!("{:.6}", row.skin_c),
            skin_real_c: format!("{:.6}", row.skin_real_c),
            sink_c: format!("{:.6}", row.sink_c),
            current_a: format!("{:.6}", row.current_a),
            state: device.map_or("", |device| &device.state),
            demand_a: said(|device| device.demand_a, 3),
            object_real_c: format!("{:.6}", row.object_real_c),
            remark: device.and_then(|device| device.remark.as_deref()).unwrap_or(""),
        }
    }
}
