//! The model-based controller, [`Law::Model`], on the simulated tile: finite volumes in `f64`, independent of the controller's
//! own plate model.
//!
//! [`Law::Model`]: thermal_display::control::Law

mod bench;
mod gain_and_law_changes;
mod plate_model;
mod sink_limits;
mod steady_state;
mod step_response;
mod tile_mismatch;
