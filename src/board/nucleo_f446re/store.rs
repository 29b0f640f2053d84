//! Settings from one start to the next.
//!
//! What is to be stored waits in RAM that a reset does not clear; the start that follows stores it while the bridges are off by
//! their hardware, and before anything runs that the flash could delay: the watchdogs, the sampling, the host. A reset meanwhile
//! leads to a second attempt, which stores the same, and no third: it may be storing that brings the reset about.

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

/// Says that something waits; and one more for each attempt that has begun. What power-up leaves in the RAM is not that, and
/// not followed by its checksum.
const WAITING: u32 = 0x7361_7665;
/// Attempts at storing it.
const ATTEMPTS: u32 = 2;
/// Longer than a frame and what the USART holds take at 1 Mbaud, at 180 MHz: 1.74 ms.
const LAST_FRAME_CYCLES: u32 = 180_000_000 / 1000 * 2;

/// What waits for the next start.
struct Handover {
    waiting: AtomicU32,
    length: AtomicU32,
    record: [AtomicU8; RECORD_MAX_BYTES],
}

// SAFETY: the section is left alone by the start-up code, and nothing else is in it; any bits are a handover.
#[unsafe(link_section = ".uninit.settings")]
static HANDOVER: Handover = Handover {
    waiting: AtomicU32::new(0),
    length: AtomicU32::new(0),
    record: [const { AtomicU8::new(0) }; RECORD_MAX_BYTES],
};

impl Handover {
    /// Attempts that have begun, if something waits.
    fn attempts(&self) -> Option<u32> {
        let begun = self.waiting.load(Relaxed).wrapping_sub(WAITING);
        (begun <= ATTEMPTS).then_some(begun)
    }

    /// What waits, for one more attempt.
    fn begin(&self) -> Option<Result<SettingsRecord, NotStored>> {
        let begun = self.attempts()?;
        if begun == ATTEMPTS {
            return Some(Err(NotStored::Interrupted));
        }
        self.waiting.store(WAITING + begun + 1, Relaxed);
        let record = self.record.get(..self.length.load(Relaxed) as usize);
        let bytes = record.map(|record| record.iter().map(|byte| byte.load(Relaxed)).collect());
        Some(bytes.ok_or(NotStored::Damaged))
    }

    fn put(&self, record: &SettingsRecord) {
        for (place, byte) in self.record.iter().zip(record) {
            place.store(*byte, Relaxed);
        }
        self.length.store(record.len() as u32, Relaxed);
        self.waiting.store(WAITING, Relaxed);
    }

    fn clear(&self) {
        self.waiting.store(0, Relaxed);
    }
}

/// Why settings could not be read or stored.
type Failure = StoreError<FlashError>;

/// Why what waited was not stored.
pub enum NotStored {
    /// By the store.
    Failed(Failure),
    /// Each attempt has ended in a reset; the flash has the old settings or these.
    Interrupted,
    /// It is no record any more.
    Damaged,
}

impl fmt::Display for NotStored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(error) => error.fmt(f),
            Self::Interrupted => f.write_str("interrupted by a reset, twice"),
            Self::Damaged => f.write_str("damaged in the RAM"),
        }
    }
}

/// What a start has found.
pub struct Found {
    /// The settings of all fingers; none are factory defaults.
    pub kept: Result<Option<[StoredSettings; FINGERS]>, Failure>,
    /// How storing went, if something waited to be stored.
    pub stored: Option<Result<(), NotStored>>,
}

/// Whether the device was started anew to store something.
pub fn is_planned() -> bool {
    HANDOVER.attempts().is_some()
}

/// Stores what waits, and reads what is stored. To be called before anything is set up.
#[inline(never)]
pub fn at_start(registers: &FLASH) -> Found {
    let mut store = SettingsStore::<_, FINGERS>::new(SettingsFlash::new(registers));
    let stored = HANDOVER.begin().map(|record| {
        let kept = decode::<FINGERS>(&record?).map_err(|_| NotStored::Damaged)?;
        store.save(kept.as_ref()).map_err(NotStored::Failed)
    });
    HANDOVER.clear();
    let kept = store.load();
    if let Err(error) = &kept {
        defmt::error!("{}", defmt::Display2Format(error));
    }
    if let Some(Err(error)) = &stored {
        defmt::error!("not stored: {}", defmt::Display2Format(error));
    }
    Found { kept, stored }
}

/// Starts the device anew, with a record to be stored. Bridges are off, and the line to the host has its last frame.
pub fn restart(record: &SettingsRecord) -> ! {
    cortex_m::asm::delay(LAST_FRAME_CYCLES);
    HANDOVER.put(record);
    SCB::sys_reset()
}
