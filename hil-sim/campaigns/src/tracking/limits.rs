//! How fast the tile heats and cools at its current limit.

use std::path::Path;

use serde::Serialize;
use thermal_sim::SceneRunner;
use thermal_sim::scene::{HostLine, Scene};
use thermal_sim::trace::TraceRow;

use super::case::{TouchingFinger, scene_text};
use super::{COOLANTS_C, ROOM_C};

/// Temperatures between which the mean rate is measured, °C.
const FROM_C: f64 = 28.0;
const TO_C: f64 = 34.0;
/// Lines that bring the display to the cold end and, when it is there, from there to the warm one and back, s. A course is
/// followed as fast as the tile can, where a hold slows down before its end.
const HOST_LINES: [(f64, &str); 2] = [(0.05, "hold 20 5"), (WARM_S, "pulse 20 41 100 9.79 100")];
/// When the display starts for the warm end, and for the cold one, s.
const WARM_S: f64 = 10.0;
const COLD_S: f64 = 20.0;
const END_S: f64 = 34.0;

/// A tile whose sink is cooled to a temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitCase {
    /// What touches the display.
    pub touch: TouchingFinger,
    /// Temperature of what cools the sink, °C.
    pub coolant_c: f64,
}

/// Mean rates between 28 and 34 °C at the current limit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TileLimits {
    /// What touches the display.
    pub touch: TouchingFinger,
    /// Temperature of what cools the sink, °C.
    pub coolant_c: f64,
    /// K/s while heating.
    pub heating_k_s: f64,
    /// K/s while cooling; 0 if the display does not reach 28 °C.
    pub cooling_k_s: f64,
}

impl LimitCase {
    /// Bare and under the thesis's finger, at each of [`COOLANTS_C`].
    pub fn all() -> Vec<Self> {
        let touches = [TouchingFinger::Bare, TouchingFinger::Thesis].into_iter();
        let cases = touches.flat_map(|touch| COOLANTS_C.map(|coolant_c| Self { touch, coolant_c }));
        cases.collect()
    }

    /// Runs it on the nominal tile.
    ///
    /// # Errors
    /// The device stopped, or has tripped.
    pub fn run(&self, device: &dyn SceneRunner) -> anyhow::Result<TileLimits> {
        let plant = [("tile.coolant_k".to_owned(), self.coolant_c - ROOM_C)];
        let text = scene_text(END_S, 1, &self.touch.tables(1.0), &plant);
        let mut scene = Scene::parse(&text, Path::new("limits"))?;
        let lines = HOST_LINES.map(|(t_s, line)| HostLine { t_s, line: line.into() });
        scene.host.extend(lines);
        let (outcome, figures) = device.run(&scene)?;
        if let Some(trip) = figures.faults.first() {
            anyhow::bail!("{} at {} s", trip.fault, trip.t_s);
        }
        let rows = outcome.trace.rows();
        let reaches = |from_s: f64, reached: &dyn Fn(&TraceRow) -> bool| {
            let mut later = rows.iter().filter(|row| row.t_s >= from_s);
            later.find(|row| reached(row)).map(|row| row.t_s)
        };
        let rate = |start: Option<f64>, end: Option<f64>| {
            let times = start.zip(end);
            times.map_or(0.0, |(start, end)| (TO_C - FROM_C) / (end - start))
        };
        Ok(TileLimits {
            touch: self.touch,
            coolant_c: self.coolant_c,
            heating_k_s: rate(
                reaches(WARM_S, &|row| row.display_c >= FROM_C),
                reaches(WARM_S, &|row| row.display_c >= TO_C),
            ),
            cooling_k_s: rate(
                reaches(COLD_S, &|row| row.display_c <= TO_C),
                reaches(COLD_S, &|row| row.display_c <= FROM_C),
            ),
        })
    }
}
