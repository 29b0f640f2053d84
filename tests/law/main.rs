//! The law with a model of the plate, [`Law::Model`], on the simulator's tile: finite volumes in `f64` that know nothing of
//! the law's own model.
//!
//! [`Law::Model`]: thermal_display::control::Law

mod bench;
mod changes;
mod mismatch;
mod model;
mod rest;
mod sink;
mod steps;
