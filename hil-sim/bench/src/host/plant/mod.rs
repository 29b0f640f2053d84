//! The simulated plant: run time of a whole finger on this host and what it grows with, and run time against error of
//! the bodies.
mod bodies;
mod figures;
mod finger;
mod fit;
mod parts;
mod plot;
mod replay;
mod tables;

pub use figures::measure;
pub use plot::draw;
pub use tables::{page, tables};
