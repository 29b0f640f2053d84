//! The settings in flash: a log of records, of which only the newest counts.

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
    RECORD_MAX_BYTES, RecordError, StoredDevice, TriplicatedSealedFlash,
    TriplicatedSealedFlashError, decode_settings_record, encode_settings_record,
};

/// Number of flash sectors that the log of records fills one after the other, in a circle.
const RECORD_LOG_SECTOR_COUNT: usize = 3;

/// Cache in RAM of the position of the newest record in the flash, used during one operation. Without this cache,
/// erasing a full sector for reuse would search the whole flash once for every record in that sector, which takes
/// seconds.
type RecordLogPositionCache = Cache<
    ArrayPageStates<RECORD_LOG_SECTOR_COUNT>,
    ArrayPagePointers<RECORD_LOG_SECTOR_COUNT>,
    ArrayKeyPointers<(), 1>,
    (),
>;

/// The stored settings of a device with `FINGERS` fingers, in three sectors of the flash `F`.
///
/// Every operation blocks until the flash has finished. After a power failure the flash holds either the previous
/// settings or the new ones; [`Self::save`] describes the exception, a flash that was damaged before.
pub struct SettingsStore<F: NorFlash, const FINGERS: usize> {
    flash: TriplicatedSealedFlash<F>,
    buffer: [u8; RECORD_MAX_BYTES],
}

/// Why settings could not be loaded from flash or saved to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoreError<E> {
    /// Reading, programming or erasing the flash failed, for this reason.
    Flash(TriplicatedSealedFlashError<E>),
    /// The log of records in the flash is damaged: its newest record cannot be found, or no record can be appended.
    Corrupt,
    /// The newest record in the flash holds no valid settings of this device, for this reason.
    Record(RecordError),
    /// A record that was written to the flash reads back differently. [`SettingsStore::save`] returns this error only
    /// if that also happens after it has erased all records.
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

impl<E: fmt::Debug> From<Error<TriplicatedSealedFlashError<E>>> for StoreError<E> {
    fn from(error: Error<TriplicatedSealedFlashError<E>>) -> Self {
        match error {
            Error::Storage { value } => Self::Flash(value),
            _ => Self::Corrupt,
        }
    }
}

impl<F: NorFlash, const FINGERS: usize> SettingsStore<F, FINGERS> {
    /// A store of settings in the first three sectors of `flash`, which is neither read nor written yet.
    pub const fn new(flash: F) -> Self {
        Self { flash: TriplicatedSealedFlash::new(flash), buffer: [0; RECORD_MAX_BYTES] }
    }

    /// Returns the log of records in the flash and the buffer for one record; both come from one call, so that they can
    /// be borrowed together. The log starts with an empty cache, and so reads the flash as after power-up.
    fn record_log_and_buffer(
        &mut self,
    ) -> (MapStorage<(), &mut TriplicatedSealedFlash<F>, RecordLogPositionCache>, &mut [u8]) {
        let end =
            (RECORD_LOG_SECTOR_COUNT * TriplicatedSealedFlash::<F>::DATA_BYTES_PER_SECTOR) as u32;
        let empty_cache =
            Cache::new(ArrayPageStates::new(), ArrayPagePointers::new(), ArrayKeyPointers::new());
        let log = MapStorage::new(&mut self.flash, MapConfig::new(0..end), empty_cache);
        (log, &mut self.buffer)
    }

    /// Reads the settings of all fingers that were saved last; `None` if factory defaults were saved last, or if
    /// nothing was ever saved.
    ///
    /// # Errors
    /// [`StoreError::Flash`]: reading the flash failed. [`StoreError::Corrupt`]: the log of records is damaged, so that
    /// its newest record cannot be found. [`StoreError::Record`]: the newest record holds no valid settings of a device
    /// with `FINGERS` fingers.
    #[inline(never)]
    pub fn load(&mut self) -> Result<Option<StoredDevice<FINGERS>>, StoreError<F::Error>> {
        let (mut log, buffer) = self.record_log_and_buffer();
        let record = block_on(log.fetch_item::<&[u8]>(buffer, &()))?;
        record.map_or(Ok(None), |bytes| decode_settings_record(bytes).map_err(StoreError::Record))
    }

    /// Saves the settings of all fingers, or factory defaults for `None`, as the newest record, and verifies the record
    /// by reading it back. Works whatever the flash held before.
    ///
    /// If the log of records is damaged beyond repair, or if the record has twice been read back differently, all
    /// records are erased first; a power failure before the new record is written then loses the previous settings. A
    /// power failure alone never damages the log in this way.
    ///
    /// # Errors
    /// The settings are not saved, because reading, programming or erasing the flash failed ([`StoreError::Flash`]), or
    /// because the log is damaged or the record reads back differently even after all records were erased. The previous
    /// settings remain in the flash, unless they were unreadable or all records were erased.
    #[inline(never)]
    pub fn save(
        &mut self,
        settings: Option<&StoredDevice<FINGERS>>,
    ) -> Result<(), StoreError<F::Error>> {
        let bytes = encode_settings_record(settings);
        let mut saved = self.append_and_verify(&bytes);
        if matches!(saved, Err(StoreError::VerifyFailed)) {
            // Some bits at that place were no longer erased; the next place may be intact.
            saved = self.append_and_verify(&bytes);
        }
        if matches!(saved, Err(StoreError::Corrupt | StoreError::VerifyFailed)) {
            // The log can be damaged though a record is found: two sectors both look like the newest.
            block_on(self.record_log_and_buffer().0.erase_all())?;
            saved = self.append_and_verify(&bytes);
        }
        saved
    }

    /// Appends a record to the log, and compares it with the newest record that is then read from the flash. The cache
    /// is emptied before this reading, so that the newest record is searched for as after power-up.
    #[inline(never)]
    fn append_and_verify(&mut self, bytes: &[u8]) -> Result<(), StoreError<F::Error>> {
        let (mut log, buffer) = self.record_log_and_buffer();
        // Fills the cache with the position of the newest record, whose content no longer matters.
        let _newest = block_on(log.fetch_item::<&[u8]>(buffer, &()));
        block_on(log.store_item(buffer, &(), &bytes))?;
        let (mut log, buffer) = self.record_log_and_buffer();
        match block_on(log.fetch_item::<&[u8]>(buffer, &()))? {
            Some(read) if read == bytes => Ok(()),
            _ => Err(StoreError::VerifyFailed),
        }
    }
}
