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
    RECORD_MAX_BYTES, SettingsRecord, SettingsStore, StoreError, StoredSettings, decode,
};

use super::FINGERS;
use super::flash::{FlashError, SettingsFlash};

/// Value of [`PendingSave::state`] when settings wait and no attempt has begun; each attempt
/// increments it. The RAM is unlikely to hold such a value after power-up, and even then the
/// checksum of the bytes would not match.
const WAITING: u32 = 0x7361_7665;
/// Attempts to store the settings.
const ATTEMPTS: u32 = 2;
/// 2 ms at 180 MHz. The last frame and the bytes in the USART take 1.74 ms at 1 Mbaud.
const LAST_FRAME_CYCLES: u32 = 180_000_000 / 1000 * 2;

/// Settings that wait to be stored by the next start.
struct PendingSave {
    state: AtomicU32,
    length_bytes: AtomicU32,
    bytes: [AtomicU8; RECORD_MAX_BYTES],
}

// SAFETY: the start-up code does not initialise the section, which holds nothing else; all bit
// patterns are valid.
#[unsafe(link_section = ".uninit.settings")]
static PENDING: PendingSave = PendingSave {
    state: AtomicU32::new(0),
    length_bytes: AtomicU32::new(0),
    bytes: [const { AtomicU8::new(0) }; RECORD_MAX_BYTES],
};

impl PendingSave {
    /// Number of attempts that have begun, if settings wait.
    fn attempts(&self) -> Option<u32> {
        let begun = self.state.load(Relaxed).wrapping_sub(WAITING);
        (begun <= ATTEMPTS).then_some(begun)
    }

    /// Begins an attempt: counts it and returns the bytes to be stored. `None` if no settings wait.
    fn begin(&self) -> Option<Result<SettingsRecord, SaveError>> {
        let begun = self.attempts()?;
        if begun == ATTEMPTS {
            return Some(Err(SaveError::Interrupted));
        }
        self.state.store(WAITING + begun + 1, Relaxed);
        let bytes = self.bytes.get(..self.length_bytes.load(Relaxed) as usize);
        let bytes = bytes.map(|bytes| bytes.iter().map(|byte| byte.load(Relaxed)).collect());
        Some(bytes.ok_or(SaveError::Damaged))
    }

    fn put(&self, bytes: &SettingsRecord) {
        for (place, byte) in self.bytes.iter().zip(bytes) {
            place.store(*byte, Relaxed);
        }
        self.length_bytes.store(bytes.len() as u32, Relaxed);
        self.state.store(WAITING, Relaxed);
    }

    fn clear(&self) {
        self.state.store(0, Relaxed);
    }
}

/// Why settings could not be read from the flash or written to it.
type FlashStoreError = StoreError<FlashError>;

/// Why waiting settings were not stored.
pub enum SaveError {
    /// The flash could not be written.
    Failed(FlashStoreError),
    /// A reset has interrupted every attempt; the flash holds either the old or the new settings.
    Interrupted,
    /// The bytes in RAM have been changed.
    Damaged,
}

impl fmt::Display for SaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(error) => error.fmt(f),
            Self::Interrupted => f.write_str("interrupted by a reset, twice"),
            Self::Damaged => f.write_str("damaged in the RAM"),
        }
    }
}

/// Stored settings, and the result of the last request to store some.
pub struct StartupStorage {
    /// The stored settings of all fingers; `None` stands for factory defaults.
    pub settings: Result<Option<[StoredSettings; FINGERS]>, FlashStoreError>,
    /// Whether the waiting settings were stored; `None` if no settings waited.
    pub save_result: Option<Result<(), SaveError>>,
}

/// Whether the device was restarted to store settings.
pub fn save_is_pending() -> bool {
    PENDING.attempts().is_some()
}

/// Stores settings if any wait, and reads the stored ones. Must be called before peripherals are
/// set up.
#[inline(never)]
pub fn save_pending_and_load(registers: &FLASH) -> StartupStorage {
    let mut store = SettingsStore::<_, FINGERS>::new(SettingsFlash::new(registers));
    let save_result = PENDING.begin().map(|bytes| {
        let settings = decode::<FINGERS>(&bytes?).map_err(|_| SaveError::Damaged)?;
        store.save(settings.as_ref()).map_err(SaveError::Failed)
    });
    PENDING.clear();
    let settings = store.load();
    if let Err(error) = &settings {
        defmt::error!("{}", defmt::Display2Format(error));
    }
    if let Some(Err(error)) = &save_result {
        defmt::error!("not stored: {}", defmt::Display2Format(error));
    }
    StartupStorage {
        settings,
        save_result,
    }
}

/// Resets the device, which then stores `bytes`. The bridges must be off, and the last frame to the
/// host must be in the stream.
pub fn restart_to_save(bytes: &SettingsRecord) -> ! {
    cortex_m::asm::delay(LAST_FRAME_CYCLES);
    PENDING.put(bytes);
    SCB::sys_reset()
}
