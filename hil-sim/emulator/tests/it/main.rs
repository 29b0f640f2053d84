//! The emulated microcontroller against its reference manuals, under the test image of `probe/`.

mod core;
mod devices;
mod faults;
mod files;
mod probe;
