//! Scenes, their faults, and commissioning, on the native engine.

mod commissioning;
mod faults;
mod no_allocation;
mod scenes;
mod serve;
mod serve_in_step;
