//! Whole sessions of simulated participants.

mod driver;
mod samples;
