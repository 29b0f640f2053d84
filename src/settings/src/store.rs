//! The settings in flash: a log of records, of which the newest is valid.

use core::fmt;

use embassy_futures::block_on;
use embedded_storage::nor_flash::NorFlash;
use sequential_storage::Error;
use sequential_storage::cache::Cache;
use sequential_storage::cache::key_pointers::ArrayKeyPointers;
use sequential_storage::cache::page_pointers::ArrayPagePointers;
use sequential_storage::cache::page_states::ArrayPageStates;
use sequential_storage::map::{MapConfig, MapStorage};

use super::{
    RECORD_MAX_BYTES, RecordError, RedundantSectors, SectorError, StoredSettings, decode, encode,
};

/// Sectors that the log rotates through.
const SECTOR_COUNT: usize = 3;

/// Position of the newest record, cached during one operation. Without it, the whole flash would be searched once for
/// every record of a sector that is reclaimed, which takes seconds.
type LogCache = Cache<
    ArrayPageStates<SECTOR_COUNT>,
    ArrayPagePointers<SECTOR_COUNT>,
    ArrayKeyPointers<(), 1>,
    (),
>;

/// The stored settings of a device with `FINGERS` fingers, in three sectors of a flash.
///
/// Every operation blocks until the flash has finished. After a power failure at any time, the flash holds either the
/// previous settings or the new ones.
pub struct SettingsStore<F: NorFlash, const FINGERS: usize> {
    flash: RedundantSectors<F>,
    buffer: [u8; RECORD_MAX_BYTES],
}

/// Why settings could not be loaded or saved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoreError<E> {
    /// The driver of the flash reported an error, or a sector could not be erased.
    Flash(SectorError<E>),
    /// The structure of the log is damaged.
    Corrupt,
    /// The newest record holds no valid settings.
    Record(RecordError),
    /// A record that was written reads back differently.
    VerifyFailed,
}

impl<E: fmt::Display> fmt::Display for StoreError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flash(error) => error.fmt(f),
            Self::Corrupt => f.write_str("the flash is in disorder"),
            Self::Record(error) => error.fmt(f),
            Self::VerifyFailed => f.write_str("the flash does not keep what it is given"),
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

impl<F: NorFlash, const FINGERS: usize> SettingsStore<F, FINGERS> {
    /// A store in the first three sectors of `flash`.
    pub const fn new(flash: F) -> Self {
        Self {
            flash: RedundantSectors::new(flash),
            buffer: [0; RECORD_MAX_BYTES],
        }
    }

    /// Returns the log of records in the flash and the buffer for one record; both come from one call, so that they can be
    /// borrowed together. The log's cache is empty, so that it reads the flash as after power-up.
    fn log(
        &mut self,
    ) -> (
        MapStorage<(), &mut RedundantSectors<F>, LogCache>,
        &mut [u8],
    ) {
        let end = (SECTOR_COUNT * RedundantSectors::<F>::SECTOR_BYTES) as u32;
        let empty_cache = Cache::new(
            ArrayPageStates::new(),
            ArrayPagePointers::new(),
            ArrayKeyPointers::new(),
        );
        let log = MapStorage::new(&mut self.flash, MapConfig::new(0..end), empty_cache);
        (log, &mut self.buffer)
    }

    /// The settings that were saved last; `None` means factory defaults, which an empty flash holds too.
    ///
    /// # Errors
    /// The flash cannot be read, or the newest record holds no valid settings of this device.
    #[inline(never)]
    pub fn load(&mut self) -> Result<Option<[StoredSettings; FINGERS]>, StoreError<F::Error>> {
        let (mut log, buffer) = self.log();
        let record = block_on(log.fetch_item::<&[u8]>(buffer, &()))?;
        record.map_or(Ok(None), |bytes| decode(bytes).map_err(StoreError::Record))
    }

    /// Saves settings, or factory defaults for `None`, and verifies them, whatever the flash held before.
    ///
    /// Only if the log is damaged beyond repair is all of it erased first; a power failure in the middle of that loses the
    /// old settings. A power failure by itself causes no such damage.
    ///
    /// # Errors
    /// The settings are not saved. The previous ones remain, unless they were unreadable or all was erased.
    #[inline(never)]
    pub fn save(
        &mut self,
        settings: Option<&[StoredSettings; FINGERS]>,
    ) -> Result<(), StoreError<F::Error>> {
        let bytes = encode(settings);
        let mut saved = self.append(&bytes);
        if matches!(saved, Err(StoreError::VerifyFailed)) {
            // Some bits at that place were no longer erased; the next place may be intact.
            saved = self.append(&bytes);
        }
        if matches!(saved, Err(StoreError::Corrupt | StoreError::VerifyFailed)) {
            // The log can be damaged though a record is found: two sectors both look like the newest.
            block_on(self.log().0.erase_all())?;
            saved = self.append(&bytes);
        }
        saved
    }

    /// Appends a record, and verifies it with an empty cache, as after power-up.
    #[inline(never)]
    fn append(&mut self, bytes: &[u8]) -> Result<(), StoreError<F::Error>> {
        let (mut log, buffer) = self.log();
        // Fills the cache with the position of the newest record, whose content no longer matters.
        let _newest = block_on(log.fetch_item::<&[u8]>(buffer, &()));
        block_on(log.store_item(buffer, &(), &bytes))?;
        let (mut log, buffer) = self.log();
        match block_on(log.fetch_item::<&[u8]>(buffer, &()))? {
            Some(read) if read == bytes => Ok(()),
            _ => Err(StoreError::VerifyFailed),
        }
    }
}
