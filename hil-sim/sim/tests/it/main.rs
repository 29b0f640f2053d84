//! Scenes, their faults, and commissioning, on the native engine.

mod commissioning;
mod dose;
mod faults;
mod flash_cells;
mod machine_faults;
mod no_allocation;
mod scenes;
mod serve;
mod serve_in_step;
mod trigger_edges;
mod wiring;
