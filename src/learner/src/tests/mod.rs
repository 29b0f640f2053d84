//! The learner against simulated contacts, an independent implementation, and properties.

mod bound;
pub mod contacts;
mod golden;
pub mod matrix;
mod properties;
pub mod random;
pub mod simulation;
