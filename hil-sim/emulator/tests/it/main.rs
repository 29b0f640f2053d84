//! The emulated microcontroller against its reference manuals, under a test image of its own.

mod core;
mod devices;
mod faults;
mod files;
mod probe;
