//! `hil-sim roughness`: a measured profile's parameters, as CSV.

use std::io::{Write, stdout};
use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use thermal_thesis::roughness::{EqualSteps, Profile, Roughness};

use super::Failure;

#[derive(Args)]
pub struct Arguments {
    /// The profile, CSV with the columns x_m and z_m
    profile: PathBuf,
}

/// Prints the table; rsm_m is empty where the profile holds no complete element. Says where equal steps stand in place of the
/// printed positions.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let profile = Profile::read(&arguments.profile)
        .with_context(|| arguments.profile.display().to_string())
        .map_err(Failure::input)?;
    if let Some(EqualSteps { step_m, uncertainty_m, unit_m }) = profile.equal_steps() {
        eprintln!(
            "hil-sim: {}: x_m is printed to {unit_m:.1e} m; taken are equal steps of {step_m:.4e} m, within {uncertainty_m:.0e} m",
            arguments.profile.display()
        );
    }
    let Roughness { rq_m, rdq, slope_rad, rsm_m } = profile.roughness();
    let rsm_m = rsm_m.map_or(String::new(), |rsm_m| rsm_m.to_string());
    writeln!(stdout(), "rq_m,rdq,slope_rad,rsm_m\n{rq_m},{rdq},{slope_rad},{rsm_m}")
        .map_err(Failure::run)
}
