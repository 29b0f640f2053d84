//! Whom a line is for, on a device with several fingers.
//!
//! A line may begin with `@` and the number of a finger, `@2 material copper`; its answer then begins so too.
//! Without that it is for every finger. Telemetry says whose it is if there is more than one finger.

use thermal_device::command::Addressed;

use crate::Error;

/// Splits a line into the finger that it is for and the rest, on a device with that many fingers, ten at most.
///
/// # Errors
/// There is no such finger.
pub fn address(line: &str, fingers: usize) -> Result<(Option<u8>, &str), Addressed<Error>> {
    let line = line.trim_ascii_start();
    let Some(addressed) = line.strip_prefix('@') else {
        return Ok((None, line));
    };
    let (number, rest) = addressed.split_once(' ').unwrap_or((addressed, ""));
    let known = match number.as_bytes() {
        [digit @ b'0'..=b'9'] => Some(digit - b'0').filter(|&n| usize::from(n) < fingers),
        _ => None,
    };
    match known {
        Some(finger) => Ok((Some(finger), rest)),
        None => Err(Addressed::device(Error::UnknownFinger(
            number.into(),
            fingers,
        ))),
    }
}
