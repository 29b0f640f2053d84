//! `cargo xtask bench`: run time against error of the contact model, of alternatives to it, of the simulated plant, and of both engines.
use anyhow::Result;
use clap::ValueEnum;

use crate::process::Invocation;
use crate::report;
use crate::setup::Permission;

/// Subject of the measurement.
#[derive(Clone, Copy, ValueEnum)]
pub enum Job {
    /// The contact model and alternatives to it
    Model,
    /// The simulated plant on this host
    Plant,
    /// A whole scene on the native engine and on the image, times real time
    Engines,
}

/// `cargo xtask bench`
pub fn run(permission: Permission, job: Job, options: report::Options) -> Result<()> {
    let job = match job {
        Job::Model => "model",
        Job::Plant => "plant",
        Job::Engines => "engines",
    };
    let measure = Invocation::bench_package("model-bench", [job]);
    report::run(permission, measure, options, Vec::new())
}
