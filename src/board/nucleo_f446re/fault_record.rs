//! The fault record: the cause of the earliest trip, in RAM that a reset does not clear.

use core::sync::atomic::{AtomicU32, Ordering};

use thermal_display::device::safety::TripCause;

use super::reset::Reset;

/// Initial value of the checksum. It differs between versions of the firmware whose records have
/// different layouts, so that none takes the record of another for its own.
const CHECKSUM_START: u32 = 0x5afe_d15b ^ TripCause::LAYOUT_HASH;
const LENGTH: usize = TripCause::WORD_COUNT + 1;

/// The words of the cause and their checksum. Neither the loader nor the start-up code writes to
/// `.uninit`; its content is lost only with the power.
#[unsafe(link_section = ".uninit.cause")]
static STORED: [AtomicU32; LENGTH] = [const { AtomicU32::new(0) }; LENGTH];

/// Checksum of data in RAM that is not initialised at start.
pub fn checksum(words: &[u32]) -> u32 {
    words.iter().fold(CHECKSUM_START, |sum, word| {
        sum.rotate_left(5)
            .wrapping_add(*word)
            .wrapping_mul(0x9e37_79b1)
    })
}

/// The trip cause that was stored before the reset; `None` if the checksum does not match.
pub fn stored() -> Option<TripCause> {
    let words: [u32; LENGTH] = core::array::from_fn(|i| STORED[i].load(Ordering::Relaxed));
    let [cause @ .., sum] = words;
    if checksum(&cause) == sum {
        TripCause::from_words(cause)
    } else {
        None
    }
}

/// Stores a cause, unless one is stored already: an earlier cause explains the later ones.
pub fn store_if_empty(cause: &TripCause) {
    if stored().is_some() {
        return;
    }
    let words = cause.to_words();
    for (place, word) in STORED
        .iter()
        .zip(words.into_iter().chain([checksum(&words)]))
    {
        place.store(word, Ordering::Relaxed);
    }
}

/// Erases the stored cause by making its checksum invalid.
pub fn erase() {
    let [.., sum] = &STORED;
    sum.fetch_xor(CHECKSUM_START, Ordering::Relaxed);
    // The words may have been invalid before, and valid with the changed checksum.
    if stored().is_some() {
        sum.fetch_add(1, Ordering::Relaxed);
    }
}

/// The cause by which the device is tripped when it starts: the stored one, or else the reset
/// itself if that is a fault.
pub fn cause_at_start(reset: Reset, restart_is_planned: bool) -> Option<TripCause> {
    if reset == Reset::PowerOn {
        // The content of the RAM is arbitrary.
        erase();
    }
    if let Some(fault) = reset.fault(restart_is_planned) {
        store_if_empty(&TripCause::without_readings(fault));
    }
    stored()
}

/// Keeps the stored cause up to date while the program runs: stores it when a finger trips, erases
/// it when the host has cleared the fault.
pub struct FaultRecord {
    stored: Option<TripCause>,
}

impl FaultRecord {
    /// A record of the cause that is stored at the start.
    pub const fn new(stored: Option<TripCause>) -> Self {
        Self { stored }
    }

    /// Whether a trip cause is stored, so that it must be erased once no finger is tripped any more.
    pub const fn is_stored(&self) -> bool {
        self.stored.is_some()
    }

    /// Stores the earliest cause of all fingers, or erases the stored one if no finger is tripped
    /// any more.
    pub fn update(&mut self, earliest: Option<&TripCause>) {
        if earliest == self.stored.as_ref() {
            return;
        }
        // The stored cause has been cleared, even if another fault has tripped since.
        erase();
        if let Some(cause) = earliest {
            store_if_empty(cause);
        }
        self.stored = earliest.copied();
    }
}
