//! What the settings' sectors hold: saves, with power that is cut, records of any content, and damage of any kind.

use std::sync::OnceLock;

use arbitrary::{Arbitrary, Unstructured};
use system_tests::flash::{BYTES, Flash, append, numbered};
use thermal_display::settings::{
    Calibration, Correction, SettingsStore, StoreError, StoredSettings, Tile,
};
use thermal_sim::FlashCells;

/// Saves that an input begins after: none, few, all that fit into a sector, and turns to another.
const SAVES: [u32; 8] = [0, 1, 2, 3, 20, 37, 38, 80];
/// Events of one input, at most.
const EVENTS: usize = 24;

/// Values of a finger: least, most, and how many make one.
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
struct Course {
    five_fingers: bool,
    saves: u8,
    events: Vec<Event>,
}

#[derive(Arbitrary, Debug)]
enum Event {
    /// Cells read otherwise.
    Flip { at: u16, bits: u8 },
    /// Cells read so.
    Bytes { at: u16, bytes: Vec<u8> },
    /// A record whose checksums are right: values in parts of their ranges, another head, another length.
    Record {
        values: [i16; 33],
        head: Option<[u8; 4]>,
        length: Option<u8>,
    },
    /// Settings are saved; power fails in that operation.
    Save { number: u8, cut: Option<(u8, u8)> },
}

/// FlashCells, and all that was ever written to them.
#[derive(Clone)]
struct Kit<const FINGERS: usize> {
    cells: FlashCells,
    written: Vec<Option<[StoredSettings; FINGERS]>>,
}

static ONE: OnceLock<Vec<Kit<1>>> = OnceLock::new();
static FIVE: OnceLock<Vec<Kit<5>>> = OnceLock::new();

/// Whatever is found was written, and settings can be stored again.
pub fn run(input: &[u8]) -> bool {
    let Ok(course) = Course::arbitrary_take_rest(Unstructured::new(input)) else {
        return false;
    };
    if course.five_fingers {
        play(&FIVE, &course);
    } else {
        play(&ONE, &course);
    }
    true
}

/// The course, line by line.
pub fn show(input: &[u8]) -> String {
    match Course::arbitrary_take_rest(Unstructured::new(input)) {
        Ok(course) => format!("{course:#?}"),
        Err(error) => error.to_string(),
    }
}

fn play<const FINGERS: usize>(kits: &OnceLock<Vec<Kit<FINGERS>>>, course: &Course) {
    let kits = kits.get_or_init(|| {
        SAVES
            .map(|saves| (0..saves).fold(Kit::new(), |kit, number| kit.saved(number)))
            .to_vec()
    });
    let mut kit = kits[usize::from(course.saves) % kits.len()].clone();
    for event in course.events.iter().take(EVENTS) {
        kit.take(event);
        kit.look();
    }
    kit.mend();
}

impl<const FINGERS: usize> Kit<FINGERS> {
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

    /// By a device that is switched on anew.
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

    fn take(&mut self, event: &Event) {
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
                head,
                length,
            } => self.record(values, *head, *length),
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

    /// Appends a record, which counts as written only if all of it is as it has to be.
    fn record(&mut self, parts: &[i16; 33], head: Option<[u8; 4]>, length: Option<u8>) {
        let units: Vec<_> = parts
            .iter()
            .zip(VALUES)
            .map(|(part, (least, most, _))| {
                // The middle and up to 1.2 times half of the range beside it.
                let (least, most) = (f64::from(least), f64::from(most));
                (0.5 * (least + most) + 0.6 * (most - least) * f64::from(*part) / 32768.0) as i32
            })
            .collect();
        let good = [1, 0, 1, FINGERS as u8];
        let head = head.unwrap_or(good);
        let mut content = head.to_vec();
        (0..FINGERS).for_each(|_| content.extend(units.iter().flat_map(|unit| unit.to_le_bytes())));
        let whole = content.len();
        content.resize(length.map_or(whole, usize::from), 0);
        let allowed = units
            .iter()
            .zip(VALUES)
            .all(|(unit, (least, most, _))| (least..=most).contains(unit));
        if content == [1, 0, 0, 0] {
            self.written.push(None);
        } else if head == good && content.len() == whole && allowed {
            let mut values = units
                .iter()
                .zip(VALUES)
                .map(|(unit, (_, _, per))| f64::from(*unit) / per);
            let mut next = || values.next().unwrap_or_default();
            let kept = StoredSettings {
                calibration: Calibration {
                    steps_counts: std::array::from_fn(|_| next()),
                    corrections: std::array::from_fn(|_| Correction {
                        offset_k: next(),
                        slope: next(),
                        curvature_1_k: next(),
                    }),
                },
                tile: Tile::from_array(std::array::from_fn(|_| next())),
            };
            self.written.push(Some([kept; FINGERS]));
        }
        let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&content);
        content.extend(checksum.to_le_bytes());
        let _taken = append(&mut self.cells, &content);
    }

    /// Nothing is found that was not written.
    fn look(&self) {
        if let Ok(found) = self.load() {
            assert!(self.written.contains(&found), "never written: {found:?}");
        }
    }

    /// Whatever the cells hold, settings can be stored.
    fn mend(&mut self) {
        let settings = numbered(1000);
        let done = self.save(settings);
        assert!(done.is_ok(), "cannot be mended: {done:?}");
        assert_eq!(self.load().ok(), Some(settings), "stored, but not found");
    }
}
