//! What a station presents, in words, and where.

use std::fmt;

use crate::Presented;

impl Presented {
    /// The finger of the device whose display the station is; `None` for a sample or nothing.
    pub const fn device_finger(&self) -> Option<u8> {
        match *self {
            Self::Nothing | Self::Sample { .. } => None,
            Self::Material { device_finger, .. }
            | Self::Hold { device_finger, .. }
            | Self::Pulses { device_finger, .. } => Some(device_finger),
        }
    }
}

impl fmt::Display for Presented {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => write!(f, "nothing"),
            Self::Sample { material } => write!(f, "sample of {material}"),
            Self::Material { material, .. } => write!(f, "display as {material}"),
            Self::Hold { celsius, .. } => write!(f, "display at {celsius} C"),
            Self::Pulses { base_c, .. } => write!(f, "display with pulses from {base_c} C"),
        }
    }
}
