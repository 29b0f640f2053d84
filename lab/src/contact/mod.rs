//! The contact law of a person's finger: what is shown while it is measured, and what is reported.

mod chart;
mod report;
mod screen;

pub use report::Report;
