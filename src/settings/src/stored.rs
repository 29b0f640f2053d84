//! Settings as bytes that outlive the power.
//!
//! | bytes | what                                                                           |
//! |-------|--------------------------------------------------------------------------------|
//! | 2     | version of the layout                                                          |
//! | 1     | 0: factory defaults, 1: settings of as many fingers as follow                  |
//! | 1     | fingers, 0 for factory defaults                                                |
//! | 132   | of each finger: 13 steps, 5 times offset, slope and curvature, 5 of the tile   |
//! | 4     | CRC-32 (ISO-HDLC) of all before; it ends every version                         |
//!
//! Everything is little-endian; a value is the integer that its decimals on a line of text make, `i32`.

use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use heapless::Vec;

use super::Range;
use super::{BORDERS, Calibration, Correction, Settings, Tile};

const VERSION: u16 = 1;
const FACTORY: u8 = 0;
const SETTINGS: u8 = 1;
const HEAD: usize = 4;
const TAIL: usize = 4;
const CORRECTIONS: usize = 5;
const VALUES: usize = BORDERS + 3 * CORRECTIONS + 5;
const FINGER: usize = 4 * VALUES;
/// Fingers that a device has at most.
const FINGERS_MAX: usize = 10;
/// Bytes of the longest record.
pub const LONGEST: usize = HEAD + FINGERS_MAX * FINGER + TAIL;

const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// A record.
pub type StoredBytes = Vec<u8, LONGEST>;

/// What is kept of a finger's settings: all that commissioning finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kept {
    /// What calibration has found.
    pub calibration: Calibration,
    /// What tuning has found.
    pub tile: Tile,
}

impl Kept {
    /// Of these settings.
    #[must_use]
    pub const fn of(settings: &Settings) -> Self {
        Self {
            calibration: settings.calibration,
            tile: settings.tile,
        }
    }

    /// The settings of a device of this class that was commissioned so.
    #[must_use]
    #[inline(never)]
    pub fn settings(&self) -> Settings {
        let mut settings = Settings {
            calibration: self.calibration,
            ..Settings::default()
        };
        settings.retune(self.tile);
        settings
    }

    /// Values as they are stored, each with its decimals.
    fn values(&self) -> impl Iterator<Item = (f64, i32)> {
        let steps = self.calibration.steps_counts.into_iter();
        let corrections = self
            .calibration
            .corrections
            .into_iter()
            .flat_map(|correction| {
                let Correction {
                    offset_k,
                    slope,
                    curvature_1_k,
                } = correction;
                [offset_k, slope, curvature_1_k]
                    .into_iter()
                    .zip(Calibration::DECIMALS)
            });
        let tile = self.tile.to_array().into_iter();
        steps
            .map(|step| (step, Calibration::STEP_DECIMALS))
            .chain(corrections)
            .chain(tile.map(|value| (value, Tile::DECIMALS as i32)))
    }

    /// From stored values; those that are missing are 0.
    fn from_values(mut values: impl Iterator<Item = i32>) -> Self {
        let mut next = |decimals| f64::from(values.next().unwrap_or_default()) / scale(decimals);
        let steps_counts = core::array::from_fn(|_| next(Calibration::STEP_DECIMALS));
        let corrections = core::array::from_fn(|_| {
            let [offset_k, slope, curvature_1_k] = Calibration::DECIMALS.map(&mut next);
            Correction {
                offset_k,
                slope,
                curvature_1_k,
            }
        });
        Self {
            calibration: Calibration {
                steps_counts,
                corrections,
            },
            tile: Tile::from_array([(); 5].map(|()| next(Tile::DECIMALS as i32))),
        }
    }

    /// The first value that no `set` line could give, and what is allowed.
    fn beyond(&self) -> Option<(&'static Range, f64)> {
        self.calibration
            .out_of_range()
            .or_else(|| self.tile.out_of_range())
    }
}

/// Why bytes are no settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoredError {
    /// Fewer bytes than any record has, or not as many as its fingers need.
    Length(usize),
    /// The checksum is that of other bytes.
    Checksum,
    /// Written by a firmware with another layout.
    Version(u16),
    /// Neither factory defaults nor settings.
    Kind(u8),
    /// Of a device with so many fingers.
    Fingers(u8),
    /// A value that no `set` line could give.
    OutOfRange {
        /// Whose.
        finger: u8,
        /// Which, and what is allowed.
        allowed: &'static Range,
        /// What is stored.
        value: f64,
    },
}

impl fmt::Display for StoredError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(bytes) => {
                write!(f, "stored settings have a wrong length of {bytes} bytes")
            }
            Self::Checksum => f.write_str("stored settings do not fit their checksum"),
            Self::Version(version) => {
                write!(
                    f,
                    "stored settings have the unknown version {version}; known: {VERSION}"
                )
            }
            Self::Kind(kind) => write!(
                f,
                "stored settings have the unknown kind {kind}; known: 0 1"
            ),
            Self::Fingers(fingers) => write!(f, "stored settings are those of {fingers} fingers"),
            Self::OutOfRange {
                finger,
                allowed:
                    Range {
                        name,
                        unit,
                        min,
                        max,
                    },
                value,
            } => {
                write!(
                    f,
                    "stored {name} {value} of finger {finger} out of range; {min} to {max} {unit}"
                )
            }
        }
    }
}

/// The bytes that keep the settings of all fingers, ten at most, or factory defaults.
#[must_use]
#[inline(never)]
pub fn encode<const FINGERS: usize>(kept: Option<&[Kept; FINGERS]>) -> StoredBytes {
    const { assert!(FINGERS <= FINGERS_MAX) };
    let mut bytes = StoredBytes::new();
    // All of it fits, which the assertion says.
    let mut put = |part: &[u8]| {
        let _fits = bytes.extend_from_slice(part);
    };
    put(&VERSION.to_le_bytes());
    put(&match kept {
        Some(_) => [SETTINGS, FINGERS as u8],
        None => [FACTORY, 0],
    });
    for (value, decimals) in kept.into_iter().flatten().flat_map(Kept::values) {
        put(&(libm::round(value * scale(decimals)) as i32).to_le_bytes());
    }
    let checksum = CRC.checksum(&bytes);
    let _fits = bytes.extend_from_slice(&checksum.to_le_bytes());
    bytes
}

/// The settings of all fingers, or none for factory defaults.
///
/// # Errors
/// Why the bytes are no settings of this device.
#[inline(never)]
pub fn decode<const FINGERS: usize>(bytes: &[u8]) -> Result<Option<[Kept; FINGERS]>, StoredError> {
    let wrong_length = StoredError::Length(bytes.len());
    let (content, checksum) = bytes.split_last_chunk::<TAIL>().ok_or(wrong_length)?;
    let (head, values) = content.split_first_chunk::<HEAD>().ok_or(wrong_length)?;
    if CRC.checksum(content) != u32::from_le_bytes(*checksum) {
        return Err(StoredError::Checksum);
    }
    let [version_low, version_high, kind, fingers] = *head;
    match u16::from_le_bytes([version_low, version_high]) {
        VERSION => {}
        version => return Err(StoredError::Version(version)),
    }
    let expected = match kind {
        FACTORY => 0,
        SETTINGS => FINGERS,
        kind => return Err(StoredError::Kind(kind)),
    };
    if usize::from(fingers) != expected {
        return Err(StoredError::Fingers(fingers));
    }
    if values.len() != expected * FINGER {
        return Err(wrong_length);
    }
    if kind == FACTORY {
        return Ok(None);
    }
    let (words, _) = values.as_chunks::<4>();
    let mut words = words.iter().map(|word| i32::from_le_bytes(*word));
    let kept = core::array::from_fn(|_| Kept::from_values(words.by_ref().take(VALUES)));
    for (finger, one) in (0..).zip(&kept) {
        if let Some((allowed, value)) = one.beyond() {
            return Err(StoredError::OutOfRange {
                finger,
                allowed,
                value,
            });
        }
    }
    Ok(Some(kept))
}

/// Ten to that power.
fn scale(decimals: i32) -> f64 {
    (0..decimals).fold(1.0, |scale, _| 10.0 * scale)
}

#[cfg(test)]
mod tests;
