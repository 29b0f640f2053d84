//! `cargo xtask bench`: run time against error of the contact model, of alternatives to it, and of the simulated plant.
use anyhow::Result;
use clap::ValueEnum;

use crate::report;
use crate::setup::Permission;

/// Subject of the measurement.
#[derive(Clone, Copy, ValueEnum)]
pub enum Job {
    /// The contact model and alternatives to it
    Model,
    /// The simulated plant on this host
    Plant,
}

/// `cargo xtask bench`
pub fn run(permission: Permission, job: Job, options: report::Options) -> Result<()> {
    let job = match job {
        Job::Model => "model",
        Job::Plant => "plant",
    };
    report::run(permission, ("model-bench", job), options, Vec::new())
}
