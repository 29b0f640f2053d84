//! Tests of the device as a whole without its hardware: lines and samples in, answers and outputs
//! out.

use crate::settings::{Settings, Tile};

mod bridge;
mod commissioning;
mod course_refusals;
mod courses;
mod device;
mod flux;
mod line_queue;
mod objects;
mod persons;
mod station;
mod storage;
mod surface;
mod task_liveness;

/// The factory's settings, but for a leak that differs in the last digit: the tile counts as identified.
fn tuned_settings() -> Settings {
    Settings { tile: Tile { leak_1_s: 0.104, ..Tile::FACTORY_DEFAULT }, ..Settings::default() }
}
