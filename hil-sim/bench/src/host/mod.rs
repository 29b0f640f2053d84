//! The host's part: runs all measurements, on the host and in the emulator, and reports them.
mod accuracy;
mod emulated;
pub mod engines;
mod figures;
mod image;
pub mod plant;
mod plot;
mod precise;
mod scenes;
mod tables;
mod timing;

pub use figures::{Effort, measure};
pub use plot::draw;
pub use tables::{page, tables};
