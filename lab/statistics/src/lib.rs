#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod ancova;
pub mod anova;
pub mod chi_square;
pub mod confusion;
pub mod correlation;
pub mod distribution;
mod error;
pub mod exponential;
pub mod levene;
pub mod proportion;
pub mod psychometric;
pub mod regression;
mod sample;
pub mod search;
pub mod sensitivity;
pub mod staircase;
pub mod studentized_range;
pub mod t_test;
pub mod tukey;

pub use error::{Result, StatisticsError};
pub use sample::{Interval, mean, standard_deviation, standard_error_of_mean};
