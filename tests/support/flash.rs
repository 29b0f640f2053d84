//! The settings' three flash sectors without a microcontroller, and settings to store in them.

use std::cell::RefCell;
use std::rc::Rc;

use embassy_futures::block_on;
use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use sequential_storage::cache::Cache;
use sequential_storage::map::{MapConfig, MapStorage};
use thermal_display::settings::{
    Calibration, Correction, DisplaySurface, FluxSensor, Person, PersonCode, RECORD_MAX_BYTES,
    SettingsStore, StoredDevice, StoredSettings, Tile, TriplicatedSealedFlash,
};
use thermal_sim::FlashCells;

/// Bytes of a sector.
pub const SECTOR: usize = 16 * 1024;
/// Bytes of all three sectors.
pub const BYTES: usize = 3 * SECTOR;

/// A flash driver over cells that outlive the store which uses it.
#[derive(Clone, Debug)]
pub struct Flash(Rc<RefCell<FlashCells>>);

/// The error of an operation without power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dead;

impl NorFlashError for Dead {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl Flash {
    /// A flash with these cells.
    pub fn new(cells: FlashCells) -> Self {
        Self(Rc::new(RefCell::new(cells)))
    }

    /// The cells as they are now.
    pub fn cells(&self) -> FlashCells {
        self.0.borrow().clone()
    }

    /// Flips a bit; bit 0 is the lowest of the first byte.
    pub fn flip(&self, bit: usize) {
        let mut cells = self.0.borrow_mut();
        let byte = cells.bytes()[bit / 8] ^ 1 << (bit % 8);
        assert!(cells.load(bit / 8, &[byte]));
    }

    fn alive(&self) -> Result<(), Dead> {
        self.0.borrow().is_powered().then_some(()).ok_or(Dead)
    }
}

impl ErrorType for Flash {
    type Error = Dead;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Dead> {
        self.alive()?;
        let from = offset as usize;
        bytes.copy_from_slice(&self.0.borrow().bytes()[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        BYTES
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Dead> {
        for sector in (from as usize..to as usize).step_by(SECTOR) {
            self.0.borrow_mut().erase(sector..sector + SECTOR);
            self.alive()?;
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Dead> {
        assert!(offset.is_multiple_of(4) && bytes.len().is_multiple_of(4), "whole words");
        for (word, at) in bytes.chunks(4).zip((offset as usize..).step_by(4)) {
            self.0.borrow_mut().program(at, word);
            self.alive()?;
        }
        Ok(())
    }
}

/// Settings that differ from number to number in every value, from 1000 on with heat-flux sensors, surfaces of the display and up to
/// 16 persons; for some numbers none, which stands for factory defaults.
pub fn numbered<const FINGERS: usize>(number: u32) -> Option<StoredDevice<FINGERS>> {
    if number % 50 == 17 {
        return None;
    }
    let of = |i: u32, per: f64| f64::from((number * 7919 + i * 104_729) % 2000) / per;
    let mut stored = StoredDevice::from(std::array::from_fn(|finger| {
        let finger = 40 * finger as u32;
        StoredSettings {
            calibration: Calibration {
                steps_counts: std::array::from_fn(|i| of(finger + i as u32, 1e3)),
                corrections: std::array::from_fn(|i| Correction {
                    offset_k: of(finger + 13 + i as u32, 1e6),
                    slope: of(finger + 18 + i as u32, 1e7),
                    curvature_1_k: of(finger + 23 + i as u32, 1e8),
                }),
            },
            tile: Tile::from_array_rounded(
                [1.0, 0.0, 0.0, 0.1, 0.0].map(|base| base + of(finger + 28, 1e6)),
            ),
            flux_sensor: (number >= 1000).then(|| {
                let values = [0.1, 2000.0, 5.0, 30.0].map(|base| base + of(finger + 29, 1e5));
                FluxSensor::from_array_rounded(values)
            }),
            display: if number >= 1000 {
                let values = [30.0, 1.0, 0.1].map(|base| base + of(finger + 30, 1e5));
                DisplaySurface::from_array_rounded(values)
            } else {
                DisplaySurface::NOMINAL
            },
        }
    }));
    let persons = if number >= 1000 { number % 17 } else { 0 };
    for person in 0..persons {
        let word = format!("P{}", 100 * (number % 1000) + person);
        let code = PersonCode::new(&word).expect("a code");
        let finger = std::array::from_fn(|i| (number * 31 + person * 7 + i as u32) as u8);
        assert!(stored.persons.insert(Person { code, finger }));
    }
    Some(stored)
}

/// Appends any bytes as the newest record; whether that succeeded.
pub fn append(cells: &mut FlashCells, record: &[u8]) -> bool {
    let flash = Flash::new(cells.clone());
    let end = (3 * TriplicatedSealedFlash::<Flash>::DATA_BYTES_PER_SECTOR) as u32;
    let config = MapConfig::new(0..end);
    let mut map = MapStorage::<(), _, _>::new(
        TriplicatedSealedFlash::new(flash.clone()),
        config,
        Cache::new_uncached(),
    );
    let done = block_on(map.store_item(&mut [0; RECORD_MAX_BYTES], &(), &record));
    *cells = flash.cells();
    done.is_ok()
}

/// Three erased sectors.
pub fn erased() -> FlashCells {
    FlashCells::new(vec![0xff; BYTES])
}

fn store<const FINGERS: usize>(cells: FlashCells) -> (SettingsStore<Flash, FINGERS>, Flash) {
    let flash = Flash::new(cells);
    (SettingsStore::new(flash.clone()), flash)
}

/// The settings that a device finds when it is switched on with these cells.
///
/// # Panics
/// They are not valid.
pub fn loaded<const FINGERS: usize>(cells: &FlashCells) -> Option<StoredDevice<FINGERS>> {
    store(cells.clone()).0.load().expect("valid settings")
}

/// The cells after a save and, if power is cut in the given operation (with a seed for what that leaves), after power-up.
///
/// # Panics
/// The save fails with power, or succeeds without.
pub fn saved<const FINGERS: usize>(
    cells: &FlashCells,
    settings: Option<&StoredDevice<FINGERS>>,
    cut: Option<(u64, u64)>,
) -> FlashCells {
    let mut cells = cells.clone();
    if let Some((nth, seed)) = cut {
        cells.cut_power_at(nth, seed);
    }
    let (mut store, flash) = store(cells);
    let done = store.save(settings);
    let mut cells = flash.cells();
    assert_eq!(done.is_ok(), cells.is_powered(), "{done:?}");
    cells.power_up();
    cells
}

/// Whether a save began a new page: the header of its sector is written, that of the next one erased.
pub fn changes_page(before: &FlashCells, after: &FlashCells) -> bool {
    let headers = |cells: &FlashCells| {
        [0, 1, 2].map(|sector| cells.bytes()[sector * SECTOR..][..24].to_vec())
    };
    headers(before) != headers(after)
}
