//! The flash sectors of the settings: saves with power cuts, records of any content, and damage of any kind.

use std::sync::OnceLock;

use arbitrary::{Arbitrary, Unstructured};
use system_tests::flash::{BYTES, Flash, append, numbered};
use thermal_display::settings::{
    Calibration, Correction, DisplaySurface, FluxSensor, Person, PersonCode, Persons,
    SettingsStore, StoreError, StoredDevice, StoredSettings, Tile,
};
use thermal_sim::FlashCells;

/// Saves before an input begins: none, a few, as many as fit into a sector, and enough to begin other sectors.
const SAVES: [u32; 8] = [0, 1, 2, 3, 20, 37, 38, 80];
/// Largest number of events of one input.
const EVENTS: usize = 24;

/// Stored values of a finger: smallest and largest stored integer, and stored integers per unit. The last seven are those of the
/// heat-flux sensor and of the display's surface.
const VALUES: [(i32, i32, f64); 40] = {
    let mut values = [(-4_000, 4_000, 1e3); 40];
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
    values[37] = (100, 500_000, 1e3);
    values[38] = (100, 300_000, 1e4);
    values[39] = (100, 150_000, 1e5);
    values
};
/// Values of a finger in records of version 1, which know neither heat-flux sensors nor surfaces of the display.
const VALUES_IN_VERSION_1: usize = 33;
/// From this value on they are those of the surface.
const SURFACE_VALUES_FROM: usize = 37;

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
        values: [i16; 40],
        is_version_1: bool,
        persons: Vec<([u8; 8], [u8; 20])>,
        header: Option<[u8; 4]>,
        length: Option<u8>,
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
        Self { cells: FlashCells::new(vec![0xff; BYTES]), written: vec![None] }
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
            Event::Record { values, is_version_1, persons, header, length } => {
                let count = if *is_version_1 { VALUES_IN_VERSION_1 } else { VALUES.len() };
                self.append_record(&values[..count], persons, *header, *length);
            }
            Event::Save { number, cut } => {
                if let Some((nth, seed)) = cut {
                    self.cells.cut_power_at(u64::from(*nth) + 1, u64::from(*seed));
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
        persons: &[([u8; 8], [u8; 20])],
        header: Option<[u8; 4]>,
        length: Option<u8>,
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
        let version = if units.len() == VALUES_IN_VERSION_1 { 1 } else { 2 };
        let header = header.unwrap_or([version, 0, 1, FINGERS as u8]);
        let mut content = header.to_vec();
        (0..FINGERS).for_each(|_| content.extend(units.iter().flat_map(|unit| unit.to_le_bytes())));
        if let Ok(count @ 1..) = u8::try_from(persons.len()) {
            content.push(count);
            for (code, finger) in persons {
                // Any bytes, or the code of that many letters.
                let code = match code {
                    [0, letters, ..] => {
                        std::array::from_fn(|i| if i < usize::from(letters % 9) { b'A' } else { 0 })
                    }
                    any => *any,
                };
                content.extend(code);
                content.extend(finger);
            }
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
    let (values, persons) = values.split_at_checked(4 * count * FINGERS)?;
    if header[2..] != [1, FINGERS as u8] || (count == VALUES_IN_VERSION_1 && !persons.is_empty()) {
        return None;
    }
    let (units, _) = values.as_chunks::<4>();
    let units: Vec<_> = units.iter().map(|unit| i32::from_le_bytes(*unit)).collect();
    let fingers: Option<Vec<_>> = units.chunks(count).map(finger_of).collect();
    Some(Some(StoredDevice { fingers: fingers?.try_into().ok()?, persons: persons_in(persons)? }))
}

/// The persons at the end of a record.
fn persons_in(content: &[u8]) -> Option<Persons> {
    let mut persons = Persons::new();
    let Some((count, content)) = content.split_first() else {
        return Some(persons);
    };
    if !(1..=16).contains(count) || content.len() != 28 * usize::from(*count) {
        return None;
    }
    for person in content.as_chunks::<28>().0 {
        let (code, finger) = person.split_at(8);
        let letters = code.iter().take_while(|byte| **byte != 0);
        let word: String = letters.map(|byte| char::from(*byte)).collect();
        let code = PersonCode::new(&word).filter(|known| known.to_bytes() == *code)?;
        let finger = finger.try_into().ok()?;
        assert!(persons.insert(Person { code, finger }), "16 fit");
    }
    Some(persons)
}

/// The settings of a finger with these stored integers, if all are within their ranges.
fn finger_of(units: &[i32]) -> Option<StoredSettings> {
    // All zero stands for no sensor and for the nominal surface; a version 1 has neither.
    let is_given = |from: usize, to: usize| units.iter().take(to).skip(from).any(|unit| *unit != 0);
    let has_flux_sensor = is_given(VALUES_IN_VERSION_1, SURFACE_VALUES_FROM);
    let has_surface = is_given(SURFACE_VALUES_FROM, VALUES.len());
    let mut values = Vec::new();
    for (index, (unit, (min, max, per_unit))) in units.iter().zip(VALUES).enumerate() {
        let is_checked = match index {
            ..VALUES_IN_VERSION_1 => true,
            VALUES_IN_VERSION_1..SURFACE_VALUES_FROM => has_flux_sensor,
            _ => has_surface,
        };
        if is_checked && !(min..=max).contains(unit) {
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
        flux_sensor: Some(FluxSensor::from_array_rounded(std::array::from_fn(|_| next())))
            .filter(|_| has_flux_sensor),
        display: Some(DisplaySurface::from_array_rounded(std::array::from_fn(|_| next())))
            .filter(|_| has_surface)
            .unwrap_or(DisplaySurface::NOMINAL),
    })
}
