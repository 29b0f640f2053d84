//! Whole sessions of simulated participants, run by the executor.

mod displays;
mod reproducibility;
mod run;
mod samples;
mod skin;
mod thresholds;
