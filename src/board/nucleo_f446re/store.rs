//! Settings from one start to the next.
//!
//! What is to be stored waits in RAM that a reset does not clear; the start that follows stores it while the bridges are off by
//! their hardware, and before anything runs that the flash could delay: the watchdogs, the sampling, the host.

use core::sync::atomic::Ordering::Relaxed;
use core::sync::atomic::{AtomicU8, AtomicU32};

use cortex_m::peripheral::SCB;
use stm32f4xx_hal::pac::FLASH;
use thermal_display::settings::{Kept, LONGEST, Store, StoreError, StoredBytes, decode};

use super::FINGERS;
use super::flash::{FlashError, SettingsFlash};

/// Says that something waits. What power-up leaves in the RAM is not that, and not followed by its checksum.
const WAITING: u32 = 0x7361_7665;
/// Longer than a frame and what the USART holds take at 1 Mbaud, at 180 MHz: 1.74 ms.
const LAST_FRAME_CYCLES: u32 = 180_000_000 / 1000 * 2;

/// What waits for the next start.
struct Handover {
    waiting: AtomicU32,
    length: AtomicU32,
    record: [AtomicU8; LONGEST],
}

// SAFETY: the section is left alone by the start-up code, and nothing else is in it; any bits are a handover.
#[unsafe(link_section = ".uninit.settings")]
static HANDOVER: Handover = Handover {
    waiting: AtomicU32::new(0),
    length: AtomicU32::new(0),
    record: [const { AtomicU8::new(0) }; LONGEST],
};

impl Handover {
    /// What waits.
    fn record(&self) -> Option<StoredBytes> {
        if self.waiting.load(Relaxed) != WAITING {
            return None;
        }
        let record = self.record.get(..self.length.load(Relaxed) as usize)?;
        Some(record.iter().map(|byte| byte.load(Relaxed)).collect())
    }

    fn put(&self, record: &StoredBytes) {
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

/// What a start has found.
pub struct Found {
    /// The settings of all fingers; none are factory defaults.
    pub kept: Result<Option<[Kept; FINGERS]>, Failure>,
    /// How storing went, if something waited to be stored.
    pub stored: Option<Result<(), Failure>>,
}

/// Stores what waits, and reads what is stored. To be called first of all.
#[inline(never)]
pub fn at_start(registers: &FLASH) -> Found {
    let mut store = Store::<_, FINGERS>::new(SettingsFlash::new(registers));
    let waiting = HANDOVER
        .record()
        .and_then(|record| decode::<FINGERS>(&record).ok());
    let stored = waiting.map(|kept| store.save(kept.as_ref()));
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
pub fn restart(record: &StoredBytes) -> ! {
    cortex_m::asm::delay(LAST_FRAME_CYCLES);
    HANDOVER.put(record);
    SCB::sys_reset()
}
