//! The finger that a line is for, on a device with several fingers.
//!
//! A line may begin with `@` and the number of a finger, as in `@2 material copper`; its answer then begins with the
//! same. A line without an address is for all fingers. Telemetry has an address if there is more than one finger.

use thermal_device::FingerIndex;
use thermal_device::command::WithSourceFinger;

use crate::Error;

/// Splits a line from the host, such as `@2 material copper`, into the finger whose index its address contains, here 2
/// for the third finger, and the rest of the line. The finger is `None`, which stands for all fingers, if the line has
/// no address.
///
/// # Errors
/// [`Error::UnknownFinger`]: what follows `@` is not a single digit, or the device has no finger with this index.
pub fn split_address<const FINGERS: usize>(
    line: &str,
) -> Result<(Option<FingerIndex<FINGERS>>, &str), WithSourceFinger<Error>> {
    let line = line.trim_ascii_start();
    let Some(addressed) = line.strip_prefix('@') else {
        return Ok((None, line));
    };
    let (number, rest) = addressed.split_once([' ']).unwrap_or((addressed, ""));
    let known = match number.as_bytes() {
        [digit @ b'0'..=b'9'] => FingerIndex::new(usize::from(digit - b'0')),
        _ => None,
    };
    match known {
        Some(finger) => Ok((Some(finger), rest)),
        None => {
            Err(WithSourceFinger::from_whole_device(Error::UnknownFinger(number.into(), FINGERS)))
        }
    }
}

/// Index of the finger whose address a damaged line has, for the answer that refuses the line; `None` without an address of
/// a finger of this device. The damage may be in the address itself.
pub fn legible_address<const FINGERS: usize>(line: &str) -> Option<u8> {
    let (finger, _) = split_address::<FINGERS>(line).ok()?;
    finger.map(FingerIndex::index_u8)
}
