//! The fault record: the cause of the earliest trip, in RAM that a reset does not clear.

use core::sync::atomic::{AtomicU32, Ordering};

use thermal_display::device::safety::TripCause;

use super::reset::ResetCause;

/// Initial value of the checksum. It differs between versions of the firmware whose stored trip
/// causes have different layouts, so that no version accepts the words of another.
const CHECKSUM_INITIAL_VALUE: u32 = 0x5afe_d15b ^ TripCause::LAYOUT_HASH;
const STORED_WORDS: usize = TripCause::WORD_COUNT + 1;

/// The words of the stored trip cause and their checksum. Neither the loader nor the start-up code
/// writes to the section `.uninit`, so that its content is lost only with the power.
#[unsafe(link_section = ".uninit.cause")]
static STORED_CAUSE: [AtomicU32; STORED_WORDS] = [const { AtomicU32::new(0) }; STORED_WORDS];

/// Checksum of 32-bit words in RAM that a reset does not clear. After power-up the content of this
/// RAM is arbitrary, which a wrong checksum shows.
pub fn checksum_of_words(words: &[u32]) -> u32 {
    words.iter().fold(CHECKSUM_INITIAL_VALUE, |sum, word| {
        sum.rotate_left(5)
            .wrapping_add(*word)
            .wrapping_mul(0x9e37_79b1)
    })
}

/// The trip cause in RAM that a reset does not clear; `None` if no cause is stored there, which a
/// wrong checksum shows.
pub fn stored_cause() -> Option<TripCause> {
    let words: [u32; STORED_WORDS] =
        core::array::from_fn(|i| STORED_CAUSE[i].load(Ordering::Relaxed));
    let [cause @ .., sum] = words;
    if checksum_of_words(&cause) == sum {
        TripCause::from_words(cause)
    } else {
        None
    }
}

/// Stores a trip cause in RAM that a reset does not clear, unless a cause is stored there already:
/// an earlier cause explains the later ones.
pub fn store_cause_if_none(cause: &TripCause) {
    if stored_cause().is_some() {
        return;
    }
    let words = cause.to_words();
    for (place, word) in STORED_CAUSE
        .iter()
        .zip(words.into_iter().chain([checksum_of_words(&words)]))
    {
        place.store(word, Ordering::Relaxed);
    }
}

/// Erases the stored cause by making its checksum invalid.
pub fn erase_stored_trip_cause() {
    let [.., sum] = &STORED_CAUSE;
    sum.fetch_xor(CHECKSUM_INITIAL_VALUE, Ordering::Relaxed);
    // The words may have been invalid before, and valid with the changed checksum.
    if stored_cause().is_some() {
        sum.fetch_add(1, Ordering::Relaxed);
    }
}

/// The cause by which all fingers must be tripped when the device starts after `reset`: the stored
/// cause or, if none is stored, the fault that the reset itself indicates, which is then stored
/// too. After power-on the old cause is erased first. `restart_is_planned`: settings wait in RAM to
/// be stored, so a reset by the program is no fault.
pub fn trip_cause_after_reset(reset: ResetCause, restart_is_planned: bool) -> Option<TripCause> {
    if reset == ResetCause::PowerOn {
        // The content of the RAM is arbitrary.
        erase_stored_trip_cause();
    }
    if let Some(fault) = reset.indicated_fault(restart_is_planned) {
        store_cause_if_none(&TripCause::without_readings(fault));
    }
    stored_cause()
}

/// Keeps the stored trip cause up to date while the program runs: stores the cause when a finger
/// trips, and erases it when no finger is tripped any more.
pub struct TripCauseRecorder {
    stored: Option<TripCause>,
}

impl TripCauseRecorder {
    /// Creates the record. `stored` is the cause by which the device is tripped at the start,
    /// `None` if it is not tripped. This cause counts as stored: only a later, different one is
    /// written to RAM.
    pub const fn new(stored: Option<TripCause>) -> Self {
        Self { stored }
    }

    /// Whether a trip cause counts as stored. If so, it must be erased once no finger is tripped
    /// any more.
    pub const fn has_stored_cause(&self) -> bool {
        self.stored.is_some()
    }

    /// Makes the stored cause equal to `earliest`, the earliest trip cause of those fingers that
    /// are tripped now: replaces it if it differs, and erases it if `earliest` is `None`.
    pub fn store_or_erase(&mut self, earliest: Option<&TripCause>) {
        if earliest == self.stored.as_ref() {
            return;
        }
        // The stored cause has been cleared, even if another fault has tripped since.
        erase_stored_trip_cause();
        if let Some(cause) = earliest {
            store_cause_if_none(cause);
        }
        self.stored = earliest.copied();
    }
}
