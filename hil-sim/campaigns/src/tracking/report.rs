//! The report of a campaign, as Markdown.

use std::fmt::Write;

use serde::Serialize;

use super::{SENSOR_LAGS_S, TileLimits, TouchingFinger, TrackingResult};
use crate::fidelity::Percentiles;

/// Errors of one stimulus over the devices of the box, mK.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrackingBox {
    /// Stimulus.
    pub stimulus: String,
    /// Largest difference to the course, or overshoot.
    pub worst_mk: Percentiles,
    /// Devices whose set-point was reported as limited.
    pub limited: usize,
    /// Devices that have tripped.
    pub faulty: usize,
}

/// Results of all cases.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrackingReport {
    /// Name of the engine.
    pub engine: &'static str,
    /// Names of the stimuli.
    pub stimuli: Vec<String>,
    /// Results for each stimulus, by [`TouchingFinger::ALL`] and [`SENSOR_LAGS_S`].
    pub results: Vec<Vec<Vec<TrackingResult>>>,
    /// Limits of the tile.
    pub limits: Vec<TileLimits>,
    /// Devices that were drawn.
    pub devices: u64,
    /// Over the box, under the thesis's finger.
    pub boxed: Vec<TrackingBox>,
}

impl TrackingReport {
    /// Tables in Markdown, mK and K/s.
    pub fn tables(&self) -> String {
        let mut text = String::from("| mK |");
        // Writing to a String cannot fail.
        for touch in TouchingFinger::ALL {
            for lag_s in SENSOR_LAGS_S {
                let _ = write!(text, " {}, {lag_s} s |", touch.name());
            }
        }
        text += &format!("\n|---|{}\n", "---|".repeat(9));
        for (name, touches) in self.stimuli.iter().zip(&self.results) {
            let _ = write!(text, "| {name} |");
            for result in touches.iter().flatten() {
                let mark = if result.faults.is_empty() { "" } else { " tripped" };
                let _ = write!(text, " {:.1}{mark} |", result.worst_mk);
            }
            text += "\n";
        }
        if !self.boxed.is_empty() {
            let devices = self.devices;
            let _ = writeln!(
                text,
                "\n| mK, {devices} devices | median | 95 % | worst | limited | tripped |\n|---|---|---|---|---|---|"
            );
            for row in &self.boxed {
                let errors = row.worst_mk;
                let _ = writeln!(
                    text,
                    "| {} | {:.1} | {:.1} | {:.1} | {} | {} |",
                    row.stimulus, errors.p50, errors.p95, errors.max, row.limited, row.faulty
                );
            }
        }
        text += "\n| K/s | sink's coolant / °C | heating | cooling |\n|---|---|---|---|\n";
        for limits in &self.limits {
            let _ = writeln!(
                text,
                "| {} | {} | {:.1} | {:.1} |",
                limits.touch.name(),
                limits.coolant_c,
                limits.heating_k_s,
                limits.cooling_k_s
            );
        }
        text
    }
}
