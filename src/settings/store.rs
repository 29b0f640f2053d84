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

/// Where the newest record is. Without, the whole flash is searched for each record of a page that is given up: seconds.
type Remembered = Cache<ArrayPageStates<SECTORS>, ArrayPagePointers<SECTORS>, ArrayKeyPointers<(), 1>, ()>;

/// The settings of a device with that many fingers, in three sectors of a flash.
///
/// Everything waits until the flash is done. Power may fail at any time: what is stored then is what was stored before,
/// or what was to be.
pub struct Store<F: NorFlash, const FINGERS: usize> {
    map: MapStorage<(), Sectors<F>, Remembered>,
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
    pub fn new(flash: F) -> Self {
        let end = (SECTORS * Sectors::<F>::BYTES) as u32;
        Self {
            map: MapStorage::new(
                Sectors::new(flash),
                MapConfig::new(0..end),
                Cache::new(
                    ArrayPageStates::new(),
                    ArrayPagePointers::new(),
                    ArrayKeyPointers::new(),
                ),
            ),
            buffer: [0; LONGEST],
        }
    }

    /// What was stored last; none are factory defaults, which are also what an empty flash has.
    ///
    /// # Errors
    /// The flash cannot be read, or what is stored is no settings of this device.
    #[inline(never)]
    pub fn load(&mut self) -> Result<Option<[Kept; FINGERS]>, StoreError<F::Error>> {
        let stored = block_on(self.map.fetch_item::<&[u8]>(&mut self.buffer, &()))?;
        stored.map_or(Ok(None), |bytes| decode(bytes).map_err(StoreError::Stored))
    }

    /// Stores settings, or factory defaults, and reads them back.
    ///
    /// # Errors
    /// They are not stored; what was before still is, unless nothing could be read of it.
    #[inline(never)]
    pub fn save(&mut self, kept: Option<&[Kept; FINGERS]>) -> Result<(), StoreError<F::Error>> {
        let bytes = encode(kept);
        // Learns where the newest record is; what is wrong with it does not matter any more.
        let _before = self.load();
        if let Err(error) = self.append(&bytes) {
            // Disorder in which nothing is found is not worth keeping.
            let is_disorder = matches!(error, StoreError::Corrupt);
            if !is_disorder || !matches!(self.load(), Err(StoreError::Corrupt)) {
                return Err(error);
            }
            block_on(self.map.erase_all())?;
            self.append(&bytes)?;
        }
        let kept = block_on(self.map.fetch_item::<&[u8]>(&mut self.buffer, &()))?;
        if kept == Some(bytes.as_slice()) {
            Ok(())
        } else {
            Err(StoreError::NotKept)
        }
    }

    #[inline(never)]
    fn append(&mut self, bytes: &[u8]) -> Result<(), StoreError<F::Error>> {
        Ok(block_on(self.map.store_item(&mut self.buffer, &(), &bytes))?)
    }
}
