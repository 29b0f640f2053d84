//! Parameters of the host.

use super::Source::ClassValue;
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{absolute, between};
use crate::HostParams;

/// A calibration to 20 mK and the noise of a good resistance bridge.
pub fn entries(host: &mut HostParams) -> impl Iterator<Item = Entry<'_>> {
    let HostParams { reference_offset_k, reference_noise_k } = host;
    let all = [
        entry!(
            reference_offset_k,
            "K",
            "what the host's reference thermometer shows too much",
            absolute(0.02),
            (-5.0, 5.0),
            ClassValue,
        ),
        entry!(
            reference_noise_k,
            "K",
            "standard deviation of one of its readings",
            between(0.0, 1e-3),
            (0.0, 1.0),
            ClassValue,
        ),
    ];
    prefixed("host", all)
}
