//! The trace of a run: one row per millisecond.

use std::collections::VecDeque;
use std::fs::File;
use std::io;
use std::path::Path;

use thermal_client::client::Telemetry;
use thermal_plant::infrared::Reading;
use thermal_plant::sensors::{FluxParams, SensorReadings};
use thermal_plant::{Finger, Plant, RECEPTORS_M};

/// Number of rows without telemetry, and of telemetry lines without a row, that are kept for matching.
const UNMATCHED_MAX: usize = 20;

/// State of the plant at one time, with the telemetry of the device's last tick before it.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceRow {
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
    /// Temperature of the finger on the display at the depths of the cold and warm receptors ([`RECEPTORS_M`]), °C; `None`
    /// where the finger is thinner.
    pub receptors_c: [Option<f64>; RECEPTORS_M.len()],
    /// The same on the real object, °C.
    pub receptors_real_c: [Option<f64>; RECEPTORS_M.len()],
    /// Sink, °C.
    pub sink_c: f64,
    /// Current through the module, A.
    pub current_a: f64,
    /// Heat flux under the sensor for it, mean of the last step, and the sensor's reading at the nominal gain, W/m2; `None`
    /// if it is not fitted.
    pub flux_w_m2: Option<[f64; 2]>,
    /// Sensor outputs before the converter.
    pub taken: SensorReadings,
    /// Sensed supply of the bridge, V.
    pub supply_v: f64,
    /// Whether the fault line is low.
    pub fault_line: bool,
    /// Camera reading of the skin on the real object; `None` between frames.
    pub camera: Option<Reading>,
    /// Telemetry of the device's last tick, if it was received.
    pub device: Option<Telemetry>,
}

impl TraceRow {
    /// The present state of the plant, without telemetry.
    pub fn capture(t_s: f64, plant: &Plant, camera: Option<Reading>) -> Self {
        Self {
            t_s,
            force_n: plant.force_n(),
            display_c: plant.display_c(),
            skin_c: plant.skin_c(),
            skin_real_c: plant.skin_real_c(),
            object_real_c: plant.object_c(),
            receptors_c: plant.receptors_c(Finger::OnDisplay),
            receptors_real_c: plant.receptors_c(Finger::OnObject),
            sink_c: plant.sink_c(),
            current_a: plant.current_a(),
            flux_w_m2: flux_w_m2(plant),
            taken: plant.sensor_readings(),
            supply_v: plant.sensed_supply_v(),
            fault_line: plant.bridge_fault(),
            camera,
            device: None,
        }
    }
}

fn flux_w_m2(plant: &Plant) -> Option<[f64; 2]> {
    Some([plant.flux_w_m2()?, FluxParams::read_w_m2(plant.flux_code()?)])
}

/// Rows of a run, each with the telemetry of the tick before it.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    rows: Vec<TraceRow>,
    /// Tick number and index of the last rows without telemetry.
    waiting: VecDeque<(u64, usize)>,
    /// Telemetry whose row has not been appended yet.
    early: VecDeque<Telemetry>,
}

impl Trace {
    /// An empty trace with room for so many rows.
    pub fn with_capacity(rows: usize) -> Self {
        Self { rows: Vec::with_capacity(rows), ..Self::default() }
    }

    /// Appends a row; `tick` is the number of the device's last tick before it.
    pub fn push(&mut self, tick: u64, mut row: TraceRow) {
        if let Some(index) =
            self.early.iter().position(|telemetry| u64::from(telemetry.tick) == tick)
        {
            row.device = self.early.remove(index);
        } else {
            push_bounded(&mut self.waiting, (tick, self.rows.len()));
        }
        self.rows.push(row);
    }

    /// Attaches telemetry to its row, or keeps it until that row is appended.
    pub fn attach_telemetry(&mut self, telemetry: Telemetry) {
        match self.waiting.iter().find(|(tick, _)| *tick == u64::from(telemetry.tick)) {
            Some((_, index)) => self.rows[*index].device = Some(telemetry),
            None => push_bounded(&mut self.early, telemetry),
        }
    }

    /// One row per millisecond of the scene.
    pub fn rows(&self) -> &[TraceRow] {
        &self.rows
    }

    /// Writes `trace.csv`. A cell is empty if there is no telemetry, or no camera frame, for its row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        self.write_to(File::create(path)?)
    }

    /// Writes the same CSV to any writer.
    ///
    /// # Errors
    /// The writer's.
    pub fn write_to(&self, writer: impl io::Write) -> io::Result<()> {
        let has_camera = self.rows.iter().any(|row| row.camera.is_some());
        let has_flux = self.rows.iter().any(|row| row.flux_w_m2.is_some());
        let columns = || {
            let camera = CAMERA_COLUMNS.iter().filter(|_| has_camera);
            let flux = FLUX_COLUMNS.iter().filter(|_| has_flux);
            COLUMNS.iter().chain(camera).chain(flux)
        };
        let mut csv = csv::Writer::from_writer(writer);
        csv.write_record(columns().map(|(name, _)| name))?;
        for row in &self.rows {
            csv.write_record(columns().map(|(_, cell)| cell(row)))?;
        }
        csv.flush()
    }
}

fn push_bounded<T>(last: &mut VecDeque<T>, new: T) {
    if last.len() == UNMATCHED_MAX {
        last.pop_front();
    }
    last.push_back(new);
}

/// A column of the file: its name and the text of its cells.
type Column = (&'static str, fn(&TraceRow) -> String);

const COLUMNS: [Column; 17] = [
    ("t_s", |row| format!("{:.3}", row.t_s)),
    ("force_n", |row| format!("{:.6}", row.force_n)),
    ("setpoint_c", |row| telemetry_cell(row, |device| device.setpoint_c, 5)),
    ("display_c", |row| format!("{:.6}", row.display_c)),
    ("sensor_c", |row| telemetry_cell(row, |device| device.display_c, 4)),
    ("skin_c", |row| format!("{:.6}", row.skin_c)),
    ("skin_real_c", |row| format!("{:.6}", row.skin_real_c)),
    ("sink_c", |row| format!("{:.6}", row.sink_c)),
    ("current_a", |row| format!("{:.6}", row.current_a)),
    ("state", |row| row.device.as_ref().map_or("", |device| device.state.name()).into()),
    ("demand_a", |row| telemetry_cell(row, |device| device.demand_a, 3)),
    ("object_real_c", |row| format!("{:.6}", row.object_real_c)),
    ("remark", |row| {
        let device = row.device.as_ref();
        let remark = device.and_then(Telemetry::remark);
        remark.unwrap_or("").into()
    }),
    ("skin_cold_c", |row| optional_cell(row.receptors_c[0], 6)),
    ("skin_warm_c", |row| optional_cell(row.receptors_c[1], 6)),
    ("skin_real_cold_c", |row| optional_cell(row.receptors_real_c[0], 6)),
    ("skin_real_warm_c", |row| optional_cell(row.receptors_real_c[1], 6)),
];

/// Additional columns of a run with a camera.
const CAMERA_COLUMNS: [Column; 2] = [
    ("camera_c", |row| optional_cell(row.camera.map(|reading| reading.apparent_c), 6)),
    ("camera_skin_c", |row| optional_cell(row.camera.map(|reading| reading.recovered_c), 6)),
];

/// Additional columns of a run with a heat-flux sensor.
const FLUX_COLUMNS: [Column; 2] = [
    ("flux_w_m2", |row| optional_cell(row.flux_w_m2.map(|[flux, _]| flux), 3)),
    ("flux_sensor_w_m2", |row| optional_cell(row.flux_w_m2.map(|[_, reading]| reading), 3)),
];

fn telemetry_cell(row: &TraceRow, field: fn(&Telemetry) -> Option<f64>, digits: usize) -> String {
    optional_cell(row.device.as_ref().and_then(field), digits)
}

fn optional_cell(value: Option<f64>, digits: usize) -> String {
    value.map_or(String::new(), |value| format!("{value:.digits$}"))
}
