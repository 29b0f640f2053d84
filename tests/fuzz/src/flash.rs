//! The flash sectors of the settings: saves with power cuts, records of any content, and damage of any kind.

use std::sync::OnceLock;

use arbitrary::{Arbitrary, Unstructured};
use system_tests::flash::{BYTES, Flash, append, numbered};
use thermal_display::settings::{
    Calibration, Correction, SettingsStore, StoreError, StoredSettings, Tile,
};
use thermal_sim::FlashCells;

/// Saves before an input begins: none, a few, as many as fit into a sector, and enough to begin other sectors.
const SAVES: [u32; 8] = [0, 1, 2, 3, 20, 37, 38, 80];
/// Largest number of events of one input.
const EVENTS: usize = 24;

/// Stored values of a finger: smallest and largest stored integer, and stored integers per unit.
const VALUES: [(i32, i32, f64); 33] = {
    let mut values = [(-4_000, 4_000, 1e3); 33];
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
    values
};

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
    /// Appends a record whose checksums are right: values as fractions of their ranges, any header, any length.
    Record {
        values: [i16; 33],
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
    written: Vec<Option<[StoredSettings; FINGERS]>>,
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
    fn save(&mut self, settings: Option<[StoredSettings; FINGERS]>) -> Result<(), String> {
        let flash = Flash::new(self.cells.clone());
        let done = SettingsStore::new(flash.clone()).save(settings.as_ref());
        self.cells = flash.cells();
        self.written.push(settings);
        done.map_err(|error| format!("{error:?}"))
    }

    fn load(
        &self,
    ) -> Result<Option<[StoredSettings; FINGERS]>, StoreError<system_tests::flash::Dead>> {
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
                header,
                length,
            } => self.append_record(values, *header, *length),
            Event::Save { number, cut } => {
                if let Some((nth, seed)) = cut {
                    self.cells
                        .cut_power_at(u64::from(*nth) + 1, u64::from(*seed));
                }
                let settings = numbered(u32::from(*number));
                let done = self.save(settings);
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
        fractions: &[i16; 33],
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
        let valid = [1, 0, 1, FINGERS as u8];
        let header = header.unwrap_or(valid);
        let mut content = header.to_vec();
        (0..FINGERS).for_each(|_| content.extend(units.iter().flat_map(|unit| unit.to_le_bytes())));
        let valid_length = content.len();
        content.resize(length.map_or(valid_length, usize::from), 0);
        let allowed = units
            .iter()
            .zip(VALUES)
            .all(|(unit, (min, max, _))| (min..=max).contains(unit));
        if content == [1, 0, 0, 0] {
            self.written.push(None);
        } else if header == valid && content.len() == valid_length && allowed {
            let mut values = units
                .iter()
                .zip(VALUES)
                .map(|(unit, (_, _, per_unit))| f64::from(*unit) / per_unit);
            let mut next = || values.next().unwrap_or_default();
            let settings = StoredSettings {
                calibration: Calibration {
                    steps_counts: std::array::from_fn(|_| next()),
                    corrections: std::array::from_fn(|_| Correction {
                        offset_k: next(),
                        slope: next(),
                        curvature_1_k: next(),
                    }),
                },
                tile: Tile::from_array_rounded(std::array::from_fn(|_| next())),
            };
            self.written.push(Some([settings; FINGERS]));
        }
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
        let done = self.save(settings);
        assert!(done.is_ok(), "cannot be saved: {done:?}");
        assert_eq!(self.load().ok(), Some(settings), "stored, but not found");
    }
}
