//! The flash sectors of the settings: saves with power cuts, records of any content, and damage of any kind.

use std::sync::OnceLock;

use arbitrary::{Arbitrary, Unstructured};
use system_tests::flash::{BYTES, Flash, append, numbered};
use thermal_display::settings::{
    Calibration, Correction, FluxSensor, Person, PersonCode, SettingsStore, StoreError,
    StoredDevice, StoredSettings, Tile,
};
use thermal_sim::FlashCells;

/// Saves before an input begins: none, a few, as many as fit into a sector, and enough to begin other sectors.
const SAVES: [u32; 8] = [0, 1, 2, 3, 20, 37, 38, 80];
/// Largest number of events of one input.
const EVENTS: usize = 24;

/// Stored values of a finger: smallest and largest stored integer, and stored integers per unit. The last four are those of the
/// heat-flux sensor.
const VALUES: [(i32, i32, f64); 37] = {
    let mut values = [(-4_000, 4_000, 1e3); 37];
    let mut sensor = 0;
    while sensor < 5 {
        values[13 + 3 * sensor] = (-1_200_000, 1_200_000, 1e6);
        values[14 + 3 * sensor] = (-500_000, 500_000, 1e7);
        values[15 + 3 * sensor] = (-200_000, 200_000, 1e8);
        sensor += 1;
    }
    values[28] = (100_000, 15_000_000, 1e6);
    values[29] = (0, 500_000, 1e6);
    values[30] = (0, 5_000_000, 1e6);
    values[31] = (1_000, 5_000_000, 1e6);
    values[32] = (0, 1_000_000, 1e6);
    values[33] = (10_000, 1_000_000, 1e6);
    values[34] = (64_000, 4_031_000, 1e3);
    values[35] = (100, 500_000, 1e3);
    values[36] = (0, 1_000_000, 1e3);
    values
};
/// Values of a finger in records of version 1, which know no heat-flux sensor.
const VALUES_IN_VERSION_1: usize = 33;

#[derive(Arbitrary, Debug)]
struct Input {
    five_fingers: bool,
    saves: u8,
    events: Vec<Event>,
}

#[derive(Arbitrary, Debug)]
enum Event {
    /// Inverts bits.
    Flip { at: u16, bits: u8 },
    /// Overwrites bytes.
    Bytes { at: u16, bytes: Vec<u8> },
    /// Appends a record whose checksums are right: values as fractions of their ranges, of both versions, any header, any length.
    Record {
        values: [i16; 37],
        is_version_1: bool,
        header: Option<[u8; 4]>,
        length: Option<u8>,
        /// Number byte and bytes after the values; in records of version 2 persons, if it is right.
        persons: Option<(u8, Vec<u8>)>,
    },
    /// Saves settings; with `cut`, power fails in this flash operation.
    Save { number: u8, cut: Option<(u8, u8)> },
}

/// Flash cells, and every value of the settings that was written to them.
#[derive(Clone)]
struct History<const FINGERS: usize> {
    cells: FlashCells,
    written: Vec<Option<StoredDevice<FINGERS>>>,
}

static ONE: OnceLock<Vec<History<1>>> = OnceLock::new();
static FIVE: OnceLock<Vec<History<5>>> = OnceLock::new();

/// Settings that are found were written, and settings can be stored after any damage.
pub fn run(input: &[u8]) -> bool {
    let Ok(input) = Input::arbitrary_take_rest(Unstructured::new(input)) else {
        return false;
    };
    if input.five_fingers {
        play(&FIVE, &input);
    } else {
        play(&ONE, &input);
    }
    true
}

/// The events.
pub fn show(input: &[u8]) -> String {
    match Input::arbitrary_take_rest(Unstructured::new(input)) {
        Ok(input) => format!("{input:#?}"),
        Err(error) => error.to_string(),
    }
}

fn play<const FINGERS: usize>(starts: &OnceLock<Vec<History<FINGERS>>>, input: &Input) {
    let starts = starts.get_or_init(|| {
        SAVES
            .map(|saves| (0..saves).fold(History::new(), |history, number| history.saved(number)))
            .to_vec()
    });
    let mut history = starts[usize::from(input.saves) % starts.len()].clone();
    for event in input.events.iter().take(EVENTS) {
        history.apply(event);
        history.check_found();
    }
    history.check_save();
}

impl<const FINGERS: usize> History<FINGERS> {
    fn new() -> Self {
        Self {
            cells: FlashCells::new(vec![0xff; BYTES]),
            written: vec![None],
        }
    }

    fn saved(mut self, number: u32) -> Self {
        let done = self.save(numbered(number));
        assert!(done.is_ok(), "save {number}: {done:?}");
        self
    }

    /// Saves settings as a device does that was just switched on.
    fn save(&mut self, settings: Option<StoredDevice<FINGERS>>) -> Result<(), String> {
        let flash = Flash::new(self.cells.clone());
        let done = SettingsStore::new(flash.clone()).save(settings.as_ref());
        self.cells = flash.cells();
        self.written.push(settings);
        done.map_err(|error| format!("{error:?}"))
    }

    fn load(&self) -> Result<Option<StoredDevice<FINGERS>>, StoreError<system_tests::flash::Dead>> {
        SettingsStore::new(Flash::new(self.cells.clone())).load()
    }

    fn apply(&mut self, event: &Event) {
        match event {
            Event::Flip { at, bits } => {
                let at = usize::from(*at) % BYTES;
                let byte = self.cells.bytes()[at] ^ bits;
                assert!(self.cells.load(at, &[byte]));
            }
            Event::Bytes { at, bytes } => {
                let at = usize::from(*at) % BYTES;
                let fit = bytes.len().min(BYTES - at);
                assert!(self.cells.load(at, &bytes[..fit]));
            }
            Event::Record {
                values,
                is_version_1,
                header,
                length,
                persons,
            } => {
                let count = if *is_version_1 {
                    VALUES_IN_VERSION_1
                } else {
                    37
                };
                self.append_record(&values[..count], *header, *length, persons.as_ref());
            }
            Event::Save { number, cut } => {
                if let Some((nth, seed)) = cut {
                    self.cells
                        .cut_power_at(u64::from(*nth) + 1, u64::from(*seed));
                }
                let settings = numbered(u32::from(*number));
                let done = self.save(settings.clone());
                self.cells.power_up();
                if done.is_ok() {
                    assert_eq!(self.load().ok(), Some(settings), "stored, but not found");
                }
            }
        }
    }

    /// Appends a record, which counts as written if it is valid.
    fn append_record(
        &mut self,
        fractions: &[i16],
        header: Option<[u8; 4]>,
        length: Option<u8>,
        persons: Option<&(u8, Vec<u8>)>,
    ) {
        let units: Vec<_> = fractions
            .iter()
            .zip(VALUES)
            .map(|(fraction, (min, max, _))| {
                // The range, and a tenth of it beyond either end.
                let (min, max) = (f64::from(min), f64::from(max));
                (0.5 * (min + max) + 0.6 * (max - min) * f64::from(*fraction) / 32768.0) as i32
            })
            .collect();
        let version = if units.len() == VALUES_IN_VERSION_1 {
            1
        } else {
            2
        };
        let header = header.unwrap_or([version, 0, 1, FINGERS as u8]);
        let mut content = header.to_vec();
        (0..FINGERS).for_each(|_| content.extend(units.iter().flat_map(|unit| unit.to_le_bytes())));
        if let Some((number, bytes)) = persons {
            // Codes and data by turns, so that some are right.
            content.push(*number);
            let byte = |at: usize| bytes.get(at % bytes.len().max(1)).copied().unwrap_or(b'A');
            let all = (0..usize::from(*number % 20)).flat_map(|person| {
                let code = (0..8).map(move |at| b'A' + (person * 3 + at) as u8 % 26);
                code.chain((0..20).map(move |at| person as u8 ^ byte(person * 20 + at)))
            });
            content.extend(all);
        }
        let length = length.map_or(content.len(), usize::from);
        content.resize(length, 0);
        self.written.extend(settings_in(&content));
        let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&content);
        content.extend(checksum.to_le_bytes());
        let _ = append(&mut self.cells, &content);
    }

    /// Only settings that were written are found.
    fn check_found(&self) {
        if let Ok(found) = self.load() {
            assert!(self.written.contains(&found), "never written: {found:?}");
        }
    }

    /// Settings can be stored, whatever the cells hold.
    fn check_save(&mut self) {
        let settings = numbered(1000);
        let done = self.save(settings.clone());
        assert!(done.is_ok(), "cannot be saved: {done:?}");
        assert_eq!(self.load().ok(), Some(settings), "stored, but not found");
    }
}

/// The settings that a record with this content before its checksum holds, if it is a valid one.
fn settings_in<const FINGERS: usize>(content: &[u8]) -> Option<Option<StoredDevice<FINGERS>>> {
    let (header, values) = content.split_first_chunk::<4>()?;
    let count = match header {
        [1, 0, ..] => VALUES_IN_VERSION_1,
        [2, 0, ..] => VALUES.len(),
        _ => return None,
    };
    if header[2..] == [0, 0] && values.is_empty() {
        return Some(None);
    }
    if header[2..] != [1, FINGERS as u8] {
        return None;
    }
    let (values, persons) = values.split_at_checked(4 * count * FINGERS)?;
    if count == VALUES_IN_VERSION_1 && !persons.is_empty() {
        return None;
    }
    let (units, _) = values.as_chunks::<4>();
    let units: Vec<_> = units.iter().map(|unit| i32::from_le_bytes(*unit)).collect();
    let fingers: Option<Vec<_>> = units.chunks(count).map(finger_of).collect();
    let fingers: [StoredSettings; FINGERS] = fingers?.try_into().ok()?;
    let mut stored = StoredDevice::from(fingers);
    if let Some((number, bytes)) = persons.split_first() {
        let is_complete = bytes.len() == 28 * usize::from(*number);
        if !(1..=16).contains(number) || !is_complete {
            return None;
        }
        for person in bytes.chunks(28) {
            let word = std::str::from_utf8(&person[..8]).ok()?;
            let code = PersonCode::new(word.trim_end_matches('\0'))?;
            let finger = person[8..].try_into().ok()?;
            stored.persons.insert(Person { code, finger });
        }
    }
    Some(Some(stored))
}

/// The settings of a finger with these stored integers, if all are within their ranges.
fn finger_of(units: &[i32]) -> Option<StoredSettings> {
    let has_flux_sensor = units[VALUES_IN_VERSION_1..].iter().any(|unit| *unit != 0);
    let count = if has_flux_sensor {
        VALUES.len()
    } else {
        VALUES_IN_VERSION_1
    };
    let mut values = Vec::new();
    for (unit, (min, max, per_unit)) in units.iter().zip(VALUES).take(count) {
        if !(min..=max).contains(unit) {
            return None;
        }
        values.push(f64::from(*unit) / per_unit);
    }
    let mut values = values.into_iter();
    let mut next = || values.next().unwrap_or_default();
    Some(StoredSettings {
        calibration: Calibration {
            steps_counts: std::array::from_fn(|_| next()),
            corrections: std::array::from_fn(|_| Correction {
                offset_k: next(),
                slope: next(),
                curvature_1_k: next(),
            }),
        },
        tile: Tile::from_array_rounded(std::array::from_fn(|_| next())),
        flux_sensor: has_flux_sensor
            .then(|| FluxSensor::from_array_rounded(std::array::from_fn(|_| next()))),
    })
}
