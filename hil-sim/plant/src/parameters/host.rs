//! The host's numbers.

use super::Source::ClassValue;
use super::slot::{Slot, slot, under};
use super::spread::{absolute, between};
use crate::HostParams;

/// A calibration within 20 mK; the noise of a good bridge.
pub fn slots(host: &mut HostParams) -> impl Iterator<Item = Slot<'_>> {
    let HostParams {
        reference_offset_k,
        reference_noise_k,
    } = host;
    let all = [
        slot(
            reference_offset_k,
            "reference_offset_k",
            "K",
            "what the host's reference thermometer shows too much",
            absolute(0.02),
            (-5.0, 5.0),
            ClassValue,
        ),
        slot(
            reference_noise_k,
            "reference_noise_k",
            "K",
            "standard deviation of one of its readings",
            between(0.0, 1e-3),
            (0.0, 1.0),
            ClassValue,
        ),
    ];
    under("host", all)
}
