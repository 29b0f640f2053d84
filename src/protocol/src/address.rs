//! Addressing of fingers.
//!
//! A line may begin with `@`, the index of a finger and a space, as in `@2 material copper`; its answer then begins in the
//! same way. Without that, a line addresses all fingers. Telemetry names its finger if the device has more than one.

use thermal_device::command::Addressed;

use crate::Error;

/// Splits a line into the index of the finger that it addresses and the rest, on a device with at most ten fingers.
///
/// # Errors
/// The device has no such finger.
pub fn address(line: &str, fingers: usize) -> Result<(Option<u8>, &str), Addressed<Error>> {
    let line = line.trim_ascii_start();
    let Some(addressed) = line.strip_prefix('@') else {
        return Ok((None, line));
    };
    let (index, rest) = addressed.split_once(' ').unwrap_or((addressed, ""));
    let finger = match index.as_bytes() {
        [digit @ b'0'..=b'9'] => Some(digit - b'0').filter(|&n| usize::from(n) < fingers),
        _ => None,
    };
    match finger {
        Some(finger) => Ok((Some(finger), rest)),
        None => Err(Addressed::device(Error::UnknownFinger(
            index.into(),
            fingers,
        ))),
    }
}
