//! How closely the display follows temperatures that the host prescribes, and how fast the tile is.
//!
//! ```text
//! stimulus, touch, sensor lag | draw -> scene (upload, trigger) -> SceneRunner::run -> display minus course -> table, picture
//! ```

mod case;
mod limits;
mod plot;
mod report;
mod stimulus;

pub use case::{TouchingFinger, TrackingCase, TrackingResult};
pub use limits::{LimitCase, TileLimits};
pub use plot::chart;
pub use report::{TrackingBox, TrackingReport};
pub use stimulus::Stimulus;

/// Lags of the display's thermistors, s: the fastest, the nominal and the slowest of the parameter box.
pub const SENSOR_LAGS_S: [f64; 3] = [0.02, 0.1, 0.5];
/// Temperatures of what cools the sink, °C, for the tile's limits.
pub const COOLANTS_C: [f64; 3] = [15.0, 25.0, 35.0];
/// Force of the finger, N.
pub const FORCE_N: f64 = 2.0;
/// Temperature of the room, °C.
pub(crate) const ROOM_C: f64 = 24.0;
