//! Compares the force of a recording with its target.

use crate::ramps::{RAMPS, force_n, ramp_at};
use crate::recording::Recording;

/// Forces below and above which each ramp must go, N: half of the ramp in the logarithm, over which the conductance of a gap and that of
/// the spots differ enough to be separated.
const REACHED_N: (f64, f64) = (0.2, 1.0);
/// Largest RMS of the logarithm of the force over its target; above it the person did not follow the ramps.
const LOG_RMS_MAX: f64 = 0.4;

/// How closely a force has followed the target of the ramps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceTracking {
    /// Typical deviation of the force from its target, %.
    pub deviation_percent: f64,
    /// Least and largest force of each ramp, N.
    pub reached_n: [(f64, f64); RAMPS],
}

/// How a force did not follow the ramps.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ForceTrackingError {
    /// A ramp did not reach far enough.
    #[error(
        "ramp {ramp} went from {least_n:.3} to {largest_n:.3} N; it must go below {} and above {} N",
        REACHED_N.0,
        REACHED_N.1
    )]
    Range {
        /// Number of the ramp, from 1.
        ramp: usize,
        /// Least force, N.
        least_n: f64,
        /// Largest force, N.
        largest_n: f64,
    },
    /// The force was too far from the target.
    #[error(
        "the force was typically off its target by {0:.0} %; allowed are {allowed:.0} %",
        allowed = 100.0 * LOG_RMS_MAX.exp_m1()
    )]
    Deviation(f64),
}

impl ForceTracking {
    /// The tracking of a recording of all ramps.
    ///
    /// # Errors
    /// A ramp does not cover the forces, or the force was too far from its target.
    pub fn of(recording: &Recording) -> Result<Self, ForceTrackingError> {
        let mut reached_n = [(f64::INFINITY, 0.0_f64); RAMPS];
        let (mut squares, mut count) = (0.0, 0.0);
        for sample in &recording.samples {
            let Some((ramp, target_n)) = ramp_at(sample.since_s).zip(force_n(sample.since_s))
            else {
                continue;
            };
            let (least_n, largest_n) = &mut reached_n[ramp];
            *least_n = least_n.min(sample.force_n);
            *largest_n = largest_n.max(sample.force_n);
            squares += (sample.force_n / target_n).ln().powi(2);
            count += 1.0;
        }
        for (ramp, &(least_n, largest_n)) in reached_n.iter().enumerate() {
            if least_n > REACHED_N.0 || largest_n < REACHED_N.1 {
                return Err(ForceTrackingError::Range { ramp: ramp + 1, least_n, largest_n });
            }
        }
        let log_rms = f64::sqrt(squares / count);
        let deviation_percent = 100.0 * log_rms.exp_m1();
        if log_rms > LOG_RMS_MAX {
            return Err(ForceTrackingError::Deviation(deviation_percent));
        }
        Ok(Self { deviation_percent, reached_n })
    }
}
