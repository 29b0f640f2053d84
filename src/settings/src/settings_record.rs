//! The record of the stored settings, as bytes.
//!
//! | bytes      | content                                                                             |
//! |------------|-------------------------------------------------------------------------------------|
//! | 2          | version of the layout                                                               |
//! | 1          | kind: 0 for factory defaults, 1 for settings                                        |
//! | 1          | number of fingers, 0 for factory defaults                                           |
//! | 132 or 160 | each finger: 13 steps, 5 times offset, slope and curvature, 5 parameters of the tile; in version 2 also 4 of the heat-flux sensor, all 0 for a finger without one, and 3 of the display's surface, all 0 for the nominal one |
//! | 1          | number of persons, 1 to 16; in version 2 only, and only if there are persons            |
//! | 28         | each person: code, 8 characters or zeros, and 20 bytes of what was learnt of the finger |
//! | 4          | CRC-32 (ISO-HDLC) of all bytes before it, in every version                          |
//!
//! Version 2 is written only if a finger has a heat-flux sensor or a display whose surface is not the nominal one, or a person is
//! stored, so that older firmware reads the record of any other device.
//!
//! All fields are little-endian. Each value of a finger is an `i32` in units of its last decimal on a `set` line, so that a record
//! holds exactly what the line does.

use core::fmt;

use contact_model::decimal::Shortest;
use heapless::Vec;

use super::calibration::power_of_ten;
use super::{
    CALIBRATED_ADC_BORDER_COUNT, CRC_32, Calibration, Correction, DisplaySurface, FluxSensor,
    Person, PersonCode, Persons, Range, Settings, Tile,
};

const VERSION_1: u16 = 1;
const VERSION_2: u16 = 2;
const KIND_FACTORY_DEFAULTS: u8 = 0;
const KIND_SETTINGS: u8 = 1;
const HEADER_BYTES: usize = 4;
const CHECKSUM_BYTES: usize = 4;
const CORRECTIONS_PER_FINGER: usize = 5;
const INTEGERS_IN_VERSION_1: usize = CALIBRATED_ADC_BORDER_COUNT + 3 * CORRECTIONS_PER_FINGER + 5;
const INTEGERS_IN_VERSION_2: usize =
    INTEGERS_IN_VERSION_1 + FluxSensor::DECIMALS.len() + DisplaySurface::DECIMALS.len();
const RECORD_BYTES_PER_FINGER_MAX: usize = 4 * INTEGERS_IN_VERSION_2;
/// Largest number of fingers that a device can have.
const FINGERS_MAX: usize = 10;
const PERSONS_MAX_BYTES: usize = 1 + Persons::MAX * Person::BYTES;
/// Length of the longest record, that of a device with ten fingers and sixteen persons, in whole words: 2060 bytes.
pub const RECORD_MAX_BYTES: usize =
    (HEADER_BYTES + FINGERS_MAX * RECORD_BYTES_PER_FINGER_MAX + PERSONS_MAX_BYTES + CHECKSUM_BYTES)
        .next_multiple_of(4);

/// The bytes of one record as they are written to flash: the stored settings of all fingers, or the order to use
/// factory defaults, between a header and a checksum.
pub type SettingsRecord = Vec<u8, RECORD_MAX_BYTES>;

/// The stored settings of a device: those of each finger, and the persons.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredDevice<const FINGERS: usize> {
    /// Each finger's.
    pub fingers: [StoredSettings; FINGERS],
    /// Persons whose fingers were learnt.
    pub persons: Persons,
}

impl<const FINGERS: usize> From<[StoredSettings; FINGERS]> for StoredDevice<FINGERS> {
    /// No persons.
    fn from(fingers: [StoredSettings; FINGERS]) -> Self {
        Self { fingers, persons: Persons::new() }
    }
}

/// The part of one finger's settings that is stored in flash, because commissioning determines it for each device:
/// calibration, tile, heat-flux sensor and surface of the display. All other settings always have their factory defaults.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredSettings {
    /// Calibration of the finger's sensors, from the commands `calibrate` and `set`: the jumps of the converter's error at
    /// the 13 calibrated borders between its segments, counts, and for each of the five thermistors the correction that
    /// is added to its temperature, K.
    pub calibration: Calibration,
    /// Thermal parameters of the finger's tile, from the commands `tune` and `set`.
    pub tile: Tile,
    /// The finger's heat-flux sensor, from the command `flux`; `None` if it is not fitted.
    pub flux_sensor: Option<FluxSensor>,
    /// Surface of the finger's display, from the command `surface`.
    pub display: DisplaySurface,
}

impl StoredSettings {
    /// Takes calibration, tile, heat-flux sensor and surface of the display, the part that is stored in flash, from a finger's complete `settings`.
    pub const fn from_settings(settings: &Settings) -> Self {
        Self {
            calibration: settings.calibration,
            tile: settings.tile,
            flux_sensor: settings.flux_sensor,
            display: settings.display,
        }
    }

    /// Complete settings of the finger: the stored calibration, tile, heat-flux sensor and display, the gains that follow from this
    /// tile, and factory defaults for everything else.
    #[inline(never)]
    pub fn to_settings_with_factory_defaults(&self) -> Settings {
        let mut settings = Settings {
            calibration: self.calibration,
            flux_sensor: self.flux_sensor,
            display: self.display,
            ..Settings::default()
        };
        settings.set_tile(self.tile);
        settings
    }

    /// This finger's values in the order of the record, each with the number of decimals that the record holds.
    fn values_and_decimals_to_encode(&self) -> impl Iterator<Item = (f64, i32)> {
        let steps = self.calibration.steps_counts.into_iter();
        let corrections = self.calibration.corrections.into_iter();
        let tile = self.tile.to_array().into_iter();
        let flux_sensor = (self.flux_sensor).map_or(NO_FLUX_SENSOR, |sensor| sensor.to_array());
        let display = match self.display {
            DisplaySurface::NOMINAL => NOMINAL_DISPLAY,
            other => other.to_array(),
        };
        steps
            .map(|step| (step, Calibration::ADC_ERROR_STEP_DECIMALS))
            .chain(corrections.flat_map(|correction| {
                let values = correction.to_array().into_iter();
                values.zip(Calibration::CORRECTION_DECIMALS)
            }))
            .chain(tile.map(|value| (value, Tile::DECIMALS)))
            .chain(flux_sensor.into_iter().zip(FluxSensor::DECIMALS))
            .chain(display.into_iter().zip(DisplaySurface::DECIMALS))
    }

    /// Converts the integers that a record holds for one finger, 33 or 40, to the stored settings of that finger. The integers
    /// have the order of the record, and each is a value in units of its last decimal. A missing integer counts as 0:
    /// [`decode_settings_record`] has checked the length of the record, so that only those of version 2 can be
    /// missing.
    fn from_record_integers(mut values: impl Iterator<Item = i32>) -> Self {
        let mut next =
            |decimals| f64::from(values.next().unwrap_or_default()) / power_of_ten(decimals);
        Self {
            calibration: Calibration {
                steps_counts: core::array::from_fn(|_| next(Calibration::ADC_ERROR_STEP_DECIMALS)),
                corrections: core::array::from_fn(|_| {
                    Correction::from_array(Calibration::CORRECTION_DECIMALS.map(&mut next))
                }),
            },
            tile: Tile::from_array_rounded([(); 5].map(|()| next(Tile::DECIMALS))),
            flux_sensor: Some(FluxSensor::DECIMALS.map(&mut next))
                .filter(|values| *values != NO_FLUX_SENSOR)
                .map(FluxSensor::from_array_rounded),
            display: Some(DisplaySurface::DECIMALS.map(&mut next))
                .filter(|values| *values != NOMINAL_DISPLAY)
                .map_or(DisplaySurface::NOMINAL, DisplaySurface::from_array_rounded),
        }
    }

    /// The first value of calibration, tile, heat-flux sensor or display that is outside its allowed range, with that range; `None` if all are
    /// inside.
    fn first_value_out_of_range(&self) -> Option<(&'static Range, f64)> {
        self.calibration
            .first_value_out_of_range()
            .or_else(|| self.tile.first_value_out_of_range())
            .or_else(|| self.flux_sensor?.first_value_out_of_range())
            .or_else(|| self.display.first_value_out_of_range())
    }
}

/// What a record holds in place of a heat-flux sensor that is not fitted; a sensor has a gain.
const NO_FLUX_SENSOR: [f64; 4] = [0.0; 4];
/// What a record holds in place of the nominal surface of the display.
const NOMINAL_DISPLAY: [f64; 3] = [0.0; 3];

/// Why bytes from the flash are not a valid record of this device. The device then starts with factory defaults, and
/// all fingers are tripped by the fault `settings-corrupt`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RecordError {
    /// The record has this length, bytes, which is too short for header and checksum, or does not match the number of
    /// fingers in its header.
    Length(usize),
    /// The CRC-32 at the end of the record does not match the bytes before it.
    Checksum,
    /// The header of the record names this version of the layout, but this firmware reads only versions 1 and 2.
    Version(u16),
    /// The header of the record names this kind of content, which is neither 0 (factory defaults) nor 1 (settings).
    Kind(u8),
    /// The header of the record names this number of fingers, but the device has another number; or the number is not 0
    /// although the record stands for factory defaults.
    Fingers(u8),
    /// A value in the record lies outside its allowed range.
    OutOfRange {
        /// Index, from 0, of the finger whose value in the record is out of range.
        finger: u8,
        /// Name, unit and allowed range of the value that is out of range.
        allowed: &'static Range,
        /// The value in the record that is out of range, in the unit of `allowed`.
        value: f64,
    },
    /// The record has this number of persons, which is none from 1 to 16.
    Persons(u8),
    /// The person with this index, from 0, has no valid code.
    PersonCode(u8),
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
                    "settings have the unknown version {version}; known: {VERSION_1} {VERSION_2}"
                )
            }
            Self::Kind(kind) => write!(f, "settings have the unknown kind {kind}; known: 0 1"),
            Self::Fingers(fingers) => write!(f, "settings are those of {fingers} fingers"),
            Self::Persons(persons) => {
                write!(f, "settings are of {persons} persons; 1 to {}", Persons::MAX)
            }
            Self::PersonCode(index) => {
                write!(f, "person {index} has no code of 1 to 8 of A-Z, 0-9")
            }
            Self::OutOfRange { finger, allowed, value } => {
                let (name, value) = (allowed.name, Shortest(*value));
                write!(f, "{name} {value} of finger {finger} out of range; {allowed}")
            }
        }
    }
}

/// Encodes the stored settings of all fingers as the bytes of a record; `None` gives the record that stands for factory
/// defaults.
#[inline(never)]
pub fn encode_settings_record<const FINGERS: usize>(
    settings: Option<&StoredDevice<FINGERS>>,
) -> SettingsRecord {
    const { assert!(FINGERS <= FINGERS_MAX) };
    let mut record = SettingsRecord::new();
    // Never fails: the capacity is that of FINGERS_MAX fingers.
    let mut append = |bytes: &[u8]| {
        let _fits = record.extend_from_slice(bytes);
    };
    let persons = settings.map_or(&[][..], |settings| settings.persons.as_slice());
    let settings = settings.map(|settings| &settings.fingers);
    let is_version_2 = (settings.into_iter().flatten())
        .any(|one| one.flux_sensor.is_some() || one.display != DisplaySurface::NOMINAL);
    let (version, integers_per_finger) = if is_version_2 || !persons.is_empty() {
        (VERSION_2, INTEGERS_IN_VERSION_2)
    } else {
        (VERSION_1, INTEGERS_IN_VERSION_1)
    };
    append(&version.to_le_bytes());
    append(&match settings {
        Some(_) => [KIND_SETTINGS, FINGERS as u8],
        None => [KIND_FACTORY_DEFAULTS, 0],
    });
    for (value, decimals) in settings.into_iter().flatten().flat_map(|one| {
        let values = one.values_and_decimals_to_encode();
        values.take(integers_per_finger)
    }) {
        append(&(libm::round(value * power_of_ten(decimals)) as i32).to_le_bytes());
    }
    if !persons.is_empty() {
        append(&[persons.len() as u8]);
    }
    for person in persons {
        append(&person.code.to_bytes());
        append(&person.finger);
    }
    let checksum = CRC_32.checksum(&record);
    let _fits = record.extend_from_slice(&checksum.to_le_bytes());
    record
}

/// Decodes the bytes of a record to the stored settings of all fingers; `None` if the record stands for factory
/// defaults.
///
/// # Errors
/// The bytes are not a valid record of a device with `FINGERS` fingers.
#[inline(never)]
pub fn decode_settings_record<const FINGERS: usize>(
    bytes: &[u8],
) -> Result<Option<StoredDevice<FINGERS>>, RecordError> {
    let wrong_length = RecordError::Length(bytes.len());
    let (content, checksum) = bytes.split_last_chunk::<CHECKSUM_BYTES>().ok_or(wrong_length)?;
    let (header, values) = content.split_first_chunk::<HEADER_BYTES>().ok_or(wrong_length)?;
    if CRC_32.checksum(content) != u32::from_le_bytes(*checksum) {
        return Err(RecordError::Checksum);
    }
    let [version_low, version_high, kind, fingers] = *header;
    let integers_per_finger = match u16::from_le_bytes([version_low, version_high]) {
        VERSION_2 => INTEGERS_IN_VERSION_2,
        VERSION_1 => INTEGERS_IN_VERSION_1,
        version => return Err(RecordError::Version(version)),
    };
    let expected_fingers = match kind {
        KIND_FACTORY_DEFAULTS => 0,
        KIND_SETTINGS => FINGERS,
        kind => return Err(RecordError::Kind(kind)),
    };
    if usize::from(fingers) != expected_fingers {
        return Err(RecordError::Fingers(fingers));
    }
    let (values, persons) =
        values.split_at_checked(expected_fingers * 4 * integers_per_finger).ok_or(wrong_length)?;
    let may_have_persons = kind == KIND_SETTINGS && integers_per_finger == INTEGERS_IN_VERSION_2;
    if !persons.is_empty() && !may_have_persons {
        return Err(wrong_length);
    }
    if kind == KIND_FACTORY_DEFAULTS {
        return Ok(None);
    }
    let persons = decode_persons(persons, wrong_length)?;
    let (words, _) = values.as_chunks::<4>();
    let mut words = words.iter().map(|word| i32::from_le_bytes(*word));
    let fingers = core::array::from_fn(|_| {
        StoredSettings::from_record_integers(words.by_ref().take(integers_per_finger))
    });
    for (finger, one) in (0..).zip(&fingers) {
        if let Some((allowed, value)) = one.first_value_out_of_range() {
            return Err(RecordError::OutOfRange { finger, allowed, value });
        }
    }
    Ok(Some(StoredDevice { fingers, persons }))
}

/// The persons at the end of a record: nothing, or their number and each of them.
fn decode_persons(bytes: &[u8], wrong_length: RecordError) -> Result<Persons, RecordError> {
    let mut persons = Persons::new();
    let Some((number, bytes)) = bytes.split_first() else {
        return Ok(persons);
    };
    if !(1..=Persons::MAX).contains(&usize::from(*number)) {
        return Err(RecordError::Persons(*number));
    }
    let (all, rest) = bytes.as_chunks::<{ Person::BYTES }>();
    if all.len() != usize::from(*number) || !rest.is_empty() {
        return Err(wrong_length);
    }
    for (index, bytes) in (0..).zip(all) {
        let [c0, c1, c2, c3, c4, c5, c6, c7, finger @ ..] = *bytes;
        let code = PersonCode::from_bytes([c0, c1, c2, c3, c4, c5, c6, c7])
            .ok_or(RecordError::PersonCode(index))?;
        // There is room for all; of two with the same code the later one counts.
        let _has_room = persons.insert(Person { code, finger });
    }
    Ok(persons)
}

#[cfg(test)]
mod tests;
