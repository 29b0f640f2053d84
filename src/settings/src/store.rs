//! Settings in flash: the newest record counts, and a record is there as a whole or not at all.

use core::fmt;

use embassy_futures::block_on;
use embedded_storage::nor_flash::NorFlash;
use sequential_storage::Error;
use sequential_storage::cache::Cache;
use sequential_storage::cache::key_pointers::ArrayKeyPointers;
use sequential_storage::cache::page_pointers::ArrayPagePointers;
use sequential_storage::cache::page_states::ArrayPageStates;
use sequential_storage::map::{MapConfig, MapStorage};

use super::{Kept, LONGEST, SectorError, Sectors, StoredError, decode, encode};

/// Sectors that the records take turns in.
const SECTORS: usize = 3;

/// Where the newest record is, for as long as one operation takes. Without, the whole flash is searched for each record of
/// a page that is given up: seconds.
type Remembered =
    Cache<ArrayPageStates<SECTORS>, ArrayPagePointers<SECTORS>, ArrayKeyPointers<(), 1>, ()>;

/// The settings of a device with that many fingers, in three sectors of a flash.
///
/// Everything waits until the flash is done. Power may fail at any time: what is stored then is what was stored before,
/// or what was to be.
pub struct Store<F: NorFlash, const FINGERS: usize> {
    flash: Sectors<F>,
    buffer: [u8; LONGEST],
}

/// Why settings could not be read or stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoreError<E> {
    /// The flash failed.
    Flash(SectorError<E>),
    /// No order can be found in the flash.
    Corrupt,
    /// What is stored last is no settings.
    Stored(StoredError),
    /// What was stored reads differently.
    NotKept,
}

impl<E: fmt::Display> fmt::Display for StoreError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flash(error) => error.fmt(f),
            Self::Corrupt => f.write_str("the flash is in disorder"),
            Self::Stored(error) => error.fmt(f),
            Self::NotKept => f.write_str("the flash does not keep what it is given"),
        }
    }
}

impl<E: fmt::Debug> From<Error<SectorError<E>>> for StoreError<E> {
    fn from(error: Error<SectorError<E>>) -> Self {
        match error {
            Error::Storage { value } => Self::Flash(value),
            _ => Self::Corrupt,
        }
    }
}

impl<F: NorFlash, const FINGERS: usize> Store<F, FINGERS> {
    /// In the first three sectors of `flash`.
    pub const fn new(flash: F) -> Self {
        Self {
            flash: Sectors::new(flash),
            buffer: [0; LONGEST],
        }
    }

    /// The records, and room for one: nothing is known but what the flash says.
    fn records(&mut self) -> (MapStorage<(), &mut Sectors<F>, Remembered>, &mut [u8]) {
        let end = (SECTORS * Sectors::<F>::BYTES) as u32;
        let nothing = Cache::new(
            ArrayPageStates::new(),
            ArrayPagePointers::new(),
            ArrayKeyPointers::new(),
        );
        let records = MapStorage::new(&mut self.flash, MapConfig::new(0..end), nothing);
        (records, &mut self.buffer)
    }

    /// What was stored last; none are factory defaults, which are also what an empty flash has.
    ///
    /// # Errors
    /// The flash cannot be read, or what is stored is no settings of this device.
    #[inline(never)]
    pub fn load(&mut self) -> Result<Option<[Kept; FINGERS]>, StoreError<F::Error>> {
        let (mut records, buffer) = self.records();
        let stored = block_on(records.fetch_item::<&[u8]>(buffer, &()))?;
        stored.map_or(Ok(None), |bytes| decode(bytes).map_err(StoreError::Stored))
    }

    /// Stores settings, or factory defaults, and reads them back, whatever the flash holds before.
    ///
    /// Only damage that leaves no other way has all of it erased, and what was there is then lost if power fails meanwhile;
    /// a power cut does no such damage.
    ///
    /// # Errors
    /// They are not stored; what was before still is, unless nothing could be read of it or all was erased.
    #[inline(never)]
    pub fn save(&mut self, kept: Option<&[Kept; FINGERS]>) -> Result<(), StoreError<F::Error>> {
        let bytes = encode(kept);
        let mut done = self.append(&bytes);
        if matches!(done, Err(StoreError::NotKept)) {
            // Bits of that place were not erased any more. The next one may be better.
            done = self.append(&bytes);
        }
        if matches!(done, Err(StoreError::Corrupt | StoreError::NotKept)) {
            // It can last, though a record is found: two sectors that both seem to be the newest.
            block_on(self.records().0.erase_all())?;
            done = self.append(&bytes);
        }
        done
    }

    /// Appends a record, and reads it back as a device does that is switched on.
    #[inline(never)]
    fn append(&mut self, bytes: &[u8]) -> Result<(), StoreError<F::Error>> {
        let (mut records, buffer) = self.records();
        // Learns where the newest record is; what is wrong with it does not matter any more.
        let _before = block_on(records.fetch_item::<&[u8]>(buffer, &()));
        block_on(records.store_item(buffer, &(), &bytes))?;
        let (mut records, buffer) = self.records();
        match block_on(records.fetch_item::<&[u8]>(buffer, &()))? {
            Some(kept) if kept == bytes => Ok(()),
            _ => Err(StoreError::NotKept),
        }
    }
}
