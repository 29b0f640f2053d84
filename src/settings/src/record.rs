//! The record of the stored settings, as bytes.
//!
//! | bytes | content                                                                             |
//! |-------|-------------------------------------------------------------------------------------|
//! | 2     | version of the layout                                                               |
//! | 1     | kind: 0 for factory defaults, 1 for settings                                        |
//! | 1     | number of fingers, 0 for factory defaults                                           |
//! | 132   | each finger: 13 steps, 5 times offset, slope and curvature, 5 parameters of the tile |
//! | 4     | CRC-32 (ISO-HDLC) of all bytes before it, in every version                          |
//!
//! All fields are little-endian. Each value is an `i32` in units of its last decimal on a line of text.

use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use heapless::Vec;

use super::calibration::power_of_ten;
use super::{BORDER_COUNT, Calibration, Correction, Range, Settings, Tile};

const VERSION: u16 = 1;
const KIND_FACTORY: u8 = 0;
const KIND_SETTINGS: u8 = 1;
const HEADER_BYTES: usize = 4;
const CHECKSUM_BYTES: usize = 4;
const CORRECTIONS: usize = 5;
const VALUES_PER_FINGER: usize = BORDER_COUNT + 3 * CORRECTIONS + 5;
const FINGER_BYTES: usize = 4 * VALUES_PER_FINGER;
/// Largest number of fingers of a device.
const FINGERS_MAX: usize = 10;
/// Length of the longest record, that of a device with ten fingers, bytes.
pub const RECORD_MAX_BYTES: usize = HEADER_BYTES + FINGERS_MAX * FINGER_BYTES + CHECKSUM_BYTES;

const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The bytes of one record, as they are written to flash.
pub type SettingsRecord = Vec<u8, RECORD_MAX_BYTES>;

/// The part of a finger's settings that is stored: all that commissioning determines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredSettings {
    /// Corrections of the converter and of the thermistors.
    pub calibration: Calibration,
    /// Identified parameters of the tile.
    pub tile: Tile,
}

impl StoredSettings {
    /// The stored part of these settings.
    #[must_use]
    pub const fn from_settings(settings: &Settings) -> Self {
        Self {
            calibration: settings.calibration,
            tile: settings.tile,
        }
    }

    /// Complete settings: the stored part, and the factory defaults of all else.
    #[must_use]
    #[inline(never)]
    pub fn settings(&self) -> Settings {
        let mut settings = Settings {
            calibration: self.calibration,
            ..Settings::default()
        };
        settings.set_tile(self.tile);
        settings
    }

    /// Values in the order of the record, each with its number of decimals.
    fn values(&self) -> impl Iterator<Item = (f64, i32)> {
        let steps = self.calibration.steps_counts.into_iter();
        let corrections = self.calibration.corrections.into_iter();
        let tile = self.tile.to_array().into_iter();
        steps
            .map(|step| (step, Calibration::STEP_DECIMALS))
            .chain(corrections.flat_map(|correction| {
                let values = correction.to_array().into_iter();
                values.zip(Calibration::CORRECTION_DECIMALS)
            }))
            .chain(tile.map(|value| (value, Tile::DECIMALS as i32)))
    }

    /// Settings from the values of a record; values that are missing become 0.
    fn from_values(mut values: impl Iterator<Item = i32>) -> Self {
        let mut next =
            |decimals| f64::from(values.next().unwrap_or_default()) / power_of_ten(decimals);
        Self {
            calibration: Calibration {
                steps_counts: core::array::from_fn(|_| next(Calibration::STEP_DECIMALS)),
                corrections: core::array::from_fn(|_| {
                    Correction::from_array(Calibration::CORRECTION_DECIMALS.map(&mut next))
                }),
            },
            tile: Tile::from_array([(); 5].map(|()| next(Tile::DECIMALS as i32))),
        }
    }

    /// The first value outside its range, with that range.
    fn out_of_range(&self) -> Option<(&'static Range, f64)> {
        self.calibration
            .out_of_range()
            .or_else(|| self.tile.out_of_range())
    }
}

/// Why bytes are not a valid record of this device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RecordError {
    /// The length, bytes, is shorter than any record or does not match the number of fingers.
    Length(usize),
    /// The checksum does not match.
    Checksum,
    /// The layout has a version that this firmware does not know.
    Version(u16),
    /// The kind is neither factory defaults nor settings.
    Kind(u8),
    /// The record is that of a device with this number of fingers.
    Fingers(u8),
    /// A value lies outside its range.
    OutOfRange {
        /// Finger whose value in the record is out of range, counted from 0.
        finger: u8,
        /// Name and range of the value.
        allowed: &'static Range,
        /// The value in the record.
        value: f64,
    },
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("stored ")?;
        match self {
            Self::Length(bytes) => write!(f, "settings have a wrong length of {bytes} bytes"),
            Self::Checksum => f.write_str("settings do not fit their checksum"),
            Self::Version(version) => {
                write!(
                    f,
                    "settings have the unknown version {version}; known: {VERSION}"
                )
            }
            Self::Kind(kind) => write!(f, "settings have the unknown kind {kind}; known: 0 1"),
            Self::Fingers(fingers) => write!(f, "settings are those of {fingers} fingers"),
            Self::OutOfRange {
                finger,
                allowed,
                value,
            } => {
                let name = allowed.name;
                write!(
                    f,
                    "{name} {value} of finger {finger} out of range; {allowed}"
                )
            }
        }
    }
}

/// Encodes the settings of all fingers, or factory defaults for `None`, as a record.
#[must_use]
#[inline(never)]
pub fn encode<const FINGERS: usize>(
    settings: Option<&[StoredSettings; FINGERS]>,
) -> SettingsRecord {
    const { assert!(FINGERS <= FINGERS_MAX) };
    let mut record = SettingsRecord::new();
    // Never fails: the capacity is that of FINGERS_MAX fingers.
    let mut append = |bytes: &[u8]| {
        let _fits = record.extend_from_slice(bytes);
    };
    append(&VERSION.to_le_bytes());
    append(&match settings {
        Some(_) => [KIND_SETTINGS, FINGERS as u8],
        None => [KIND_FACTORY, 0],
    });
    for (value, decimals) in settings
        .into_iter()
        .flatten()
        .flat_map(StoredSettings::values)
    {
        append(&(libm::round(value * power_of_ten(decimals)) as i32).to_le_bytes());
    }
    let checksum = CRC.checksum(&record);
    let _fits = record.extend_from_slice(&checksum.to_le_bytes());
    record
}

/// Decodes a record to the settings of all fingers, or to `None` for factory defaults.
///
/// # Errors
/// The bytes are not a valid record of a device with this number of fingers.
#[inline(never)]
pub fn decode<const FINGERS: usize>(
    bytes: &[u8],
) -> Result<Option<[StoredSettings; FINGERS]>, RecordError> {
    let wrong_length = RecordError::Length(bytes.len());
    let (content, checksum) = bytes
        .split_last_chunk::<CHECKSUM_BYTES>()
        .ok_or(wrong_length)?;
    let (header, values) = content
        .split_first_chunk::<HEADER_BYTES>()
        .ok_or(wrong_length)?;
    if CRC.checksum(content) != u32::from_le_bytes(*checksum) {
        return Err(RecordError::Checksum);
    }
    let [version_low, version_high, kind, fingers] = *header;
    match u16::from_le_bytes([version_low, version_high]) {
        VERSION => {}
        version => return Err(RecordError::Version(version)),
    }
    let expected_fingers = match kind {
        KIND_FACTORY => 0,
        KIND_SETTINGS => FINGERS,
        kind => return Err(RecordError::Kind(kind)),
    };
    if usize::from(fingers) != expected_fingers {
        return Err(RecordError::Fingers(fingers));
    }
    if values.len() != expected_fingers * FINGER_BYTES {
        return Err(wrong_length);
    }
    if kind == KIND_FACTORY {
        return Ok(None);
    }
    let (words, _) = values.as_chunks::<4>();
    let mut words = words.iter().map(|word| i32::from_le_bytes(*word));
    let settings = core::array::from_fn(|_| {
        StoredSettings::from_values(words.by_ref().take(VALUES_PER_FINGER))
    });
    for (finger, one) in (0..).zip(&settings) {
        if let Some((allowed, value)) = one.out_of_range() {
            return Err(RecordError::OutOfRange {
                finger,
                allowed,
                value,
            });
        }
    }
    Ok(Some(settings))
}

#[cfg(test)]
mod tests;
