//! Storage of the settings in flash, by means of a restart.
//!
//! The flash stalls the processor while it is written, so settings are stored only at the start of
//! the program, before anything runs that must not be delayed (watchdogs, sampling, host link) and
//! while the hardware keeps the bridges off. To store settings, the running program writes their
//! bytes to RAM that a reset does not clear, and resets the device.
//!
//! If a reset interrupts the storing, the next start tries a second time. There is no third
//! attempt, because the storing itself may cause the resets.

use core::fmt;
use core::sync::atomic::Ordering::Relaxed;
use core::sync::atomic::{AtomicU8, AtomicU32};

use cortex_m::peripheral::SCB;
use stm32f4xx_hal::pac::FLASH;
use thermal_display::settings::{
    RECORD_MAX_BYTES, SettingsRecord, SettingsStore, StoreError, StoredDevice,
    decode_settings_record,
};

use super::FINGERS;
use super::settings_flash::{FlashError, SettingsFlash};

/// Value of [`PendingSave::state`] when settings wait in RAM and no attempt to store them has
/// begun; each attempt adds one. After power-up the RAM is unlikely to hold such a value by chance,
/// and even then the checksum of the settings would not match.
const SAVE_PENDING_MAGIC: u32 = 0x7361_7665;
/// Number of program starts that may try to store the same settings. If a reset interrupts both
/// attempts, there is no third, because the storing itself may cause the resets.
const MAX_SAVE_ATTEMPTS: u32 = 2;
/// Delay before the device restarts to store settings: 3 ms, in cycles of 180 MHz. The longest last
/// line to the host, and the two bytes before it in the USART, take 2.9 ms at 1 Mbaud.
const LAST_LINE_DELAY_CYCLES: u32 = 180_000_000 / 1000 * 3;

/// Settings in RAM that a reset does not clear, which the next start is to store in flash.
struct PendingSave {
    state: AtomicU32,
    length_bytes: AtomicU32,
    bytes: [AtomicU8; RECORD_MAX_BYTES],
}

// SAFETY: the start-up code does not initialise the section, which holds nothing else; all bit
// patterns are valid.
#[unsafe(link_section = ".uninit.settings")]
static PENDING_SAVE: PendingSave = PendingSave {
    state: AtomicU32::new(0),
    length_bytes: AtomicU32::new(0),
    bytes: [const { AtomicU8::new(0) }; RECORD_MAX_BYTES],
};

impl PendingSave {
    /// Number of attempts to store the settings that have begun, 0 to 2; `None` if no settings
    /// wait.
    fn attempts_begun(&self) -> Option<u32> {
        let begun = self.state.load(Relaxed).wrapping_sub(SAVE_PENDING_MAGIC);
        (begun <= MAX_SAVE_ATTEMPTS).then_some(begun)
    }

    /// Begins an attempt to store the waiting settings: counts it and returns their bytes. `None`
    /// if no settings wait; [`PendingSaveError::Interrupted`] if both attempts are used up,
    /// [`PendingSaveError::Damaged`] if the length is damaged.
    fn count_attempt_and_read_settings(&self) -> Option<Result<SettingsRecord, PendingSaveError>> {
        let begun = self.attempts_begun()?;
        if begun == MAX_SAVE_ATTEMPTS {
            return Some(Err(PendingSaveError::Interrupted));
        }
        self.state.store(SAVE_PENDING_MAGIC + begun + 1, Relaxed);
        let bytes = self.bytes.get(..self.length_bytes.load(Relaxed) as usize);
        let bytes = bytes.map(|bytes| bytes.iter().map(|byte| byte.load(Relaxed)).collect());
        Some(bytes.ok_or(PendingSaveError::Damaged))
    }

    fn write_to_ram(&self, bytes: &SettingsRecord) {
        for (place, byte) in self.bytes.iter().zip(bytes) {
            place.store(*byte, Relaxed);
        }
        self.length_bytes.store(bytes.len() as u32, Relaxed);
        self.state.store(SAVE_PENDING_MAGIC, Relaxed);
    }

    fn clear(&self) {
        self.state.store(0, Relaxed);
    }
}

/// Why settings could not be read from the flash or written to it.
type SettingsStoreError = StoreError<FlashError>;

/// Why the settings that waited in RAM were not stored in flash.
pub enum PendingSaveError {
    /// The flash could not be written, for the reason given.
    Failed(SettingsStoreError),
    /// Resets have interrupted both attempts to store the settings, and there is no third attempt.
    /// The flash holds either the old or the new settings, unless its content was damaged before.
    Interrupted,
    /// The settings in RAM were damaged between the restart and the attempt to store them: length
    /// or checksum is wrong.
    Damaged,
}

impl fmt::Display for PendingSaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(error) => error.fmt(f),
            Self::Interrupted => f.write_str("interrupted by a reset, twice"),
            Self::Damaged => f.write_str("damaged in the RAM"),
        }
    }
}

/// What [`save_pending_and_load`] has found and done at the start: the settings that the flash
/// holds, and whether waiting settings were stored.
pub struct SaveAndLoadResult {
    /// The settings of all fingers and the persons that the flash holds; `None` if it holds none or factory
    /// defaults were stored. An error if the flash cannot be read or holds no valid settings.
    pub settings: Result<Option<StoredDevice<FINGERS>>, SettingsStoreError>,
    /// Whether the settings that waited in RAM were stored in flash at this start; `None` if none
    /// waited.
    pub save_result: Option<Result<(), PendingSaveError>>,
}

/// Whether settings wait in RAM to be stored in flash. A reset by the program is then no fault: the
/// host has requested the restart by `save` or `forget`.
pub fn save_is_pending() -> bool {
    PENDING_SAVE.attempts_begun().is_some()
}

/// Stores the settings that wait in RAM, if any, in flash, then reads the settings from the flash.
/// Must be called at the start, before peripherals are set up, because the processor stalls while
/// the flash is written.
#[inline(never)]
pub fn save_pending_and_load(registers: &FLASH) -> SaveAndLoadResult {
    let mut store = SettingsStore::<_, FINGERS>::new(SettingsFlash::new(registers));
    let save_result = PENDING_SAVE.count_attempt_and_read_settings().map(|bytes| {
        let settings =
            decode_settings_record::<FINGERS>(&bytes?).map_err(|_| PendingSaveError::Damaged)?;
        store.save(settings.as_ref()).map_err(PendingSaveError::Failed)
    });
    PENDING_SAVE.clear();
    let settings = store.load();
    if let Err(error) = &settings {
        defmt::error!("{}", defmt::Display2Format(error));
    }
    if let Some(Err(error)) = &save_result {
        defmt::error!("not stored: {}", defmt::Display2Format(error));
    }
    SaveAndLoadResult { settings, save_result }
}

/// Waits 3 ms for the end of the last line to the host, copies `bytes`, the record of the settings,
/// to RAM that a reset does not clear, and resets the device. The next start stores the settings in
/// flash. The bridges must be off, and the DMA stream must already have the last line.
pub fn restart_to_save(bytes: &SettingsRecord) -> ! {
    cortex_m::asm::delay(LAST_LINE_DELAY_CYCLES);
    PENDING_SAVE.write_to_ram(bytes);
    SCB::sys_reset()
}
