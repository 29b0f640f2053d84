//! The recorder of the earliest trip cause, in RAM that a reset does not clear.

use core::sync::atomic::{AtomicU32, Ordering};

use thermal_display::device::safety::TripCause;

use super::reset_cause::ResetCause;

/// Initial value of the checksum. It differs between versions of the firmware whose stored trip
/// causes have different layouts, so that no version accepts the words of another.
const CHECKSUM_INITIAL_VALUE: u32 = 0x5afe_d15b ^ TripCause::LAYOUT_HASH;
const STORED_WORD_COUNT: usize = TripCause::WORD_COUNT + 1;

/// The words of the stored trip cause and their checksum. Neither the loader nor the start-up code
/// writes to the section `.uninit`, so that its content is lost only with the power.
#[unsafe(link_section = ".uninit.cause")]
static STORED_TRIP_CAUSE: [AtomicU32; STORED_WORD_COUNT] =
    [const { AtomicU32::new(0) }; STORED_WORD_COUNT];

/// Checksum of 32-bit words in RAM that a reset does not clear. After power-up the content of this
/// RAM is arbitrary, which a wrong checksum shows.
pub fn checksum_of_words(words: &[u32]) -> u32 {
    words.iter().fold(CHECKSUM_INITIAL_VALUE, |sum, word| {
        sum.rotate_left(5).wrapping_add(*word).wrapping_mul(0x9e37_79b1)
    })
}

/// The trip cause in RAM that a reset does not clear; `None` if no cause is stored there, which a
/// wrong checksum shows.
pub fn stored_trip_cause() -> Option<TripCause> {
    let words: [u32; STORED_WORD_COUNT] =
        core::array::from_fn(|i| STORED_TRIP_CAUSE[i].load(Ordering::Relaxed));
    let [cause @ .., sum] = words;
    if checksum_of_words(&cause) == sum { TripCause::from_retained_words(cause) } else { None }
}

/// Stores a trip cause in RAM that a reset does not clear, unless a cause is stored there already:
/// an earlier cause explains the later ones.
pub fn store_trip_cause_if_none(cause: &TripCause) {
    if stored_trip_cause().is_some() {
        return;
    }
    let words = cause.to_retained_words();
    for (place, word) in
        STORED_TRIP_CAUSE.iter().zip(words.into_iter().chain([checksum_of_words(&words)]))
    {
        place.store(word, Ordering::Relaxed);
    }
}

/// Erases the trip cause that is kept in RAM through a reset, so that the next start does not trip
/// the fingers by it: makes its checksum invalid. Called after power-on, when no finger is tripped
/// any more, and before another cause replaces it.
pub fn erase_stored_trip_cause() {
    let [.., sum] = &STORED_TRIP_CAUSE;
    sum.fetch_xor(CHECKSUM_INITIAL_VALUE, Ordering::Relaxed);
    // The words may have been invalid before, and valid with the changed checksum.
    if stored_trip_cause().is_some() {
        sum.fetch_add(1, Ordering::Relaxed);
    }
}

/// The cause by which all fingers must be tripped when the device starts after `reset`: the stored
/// cause or, if none is stored, the fault that the reset itself indicates, which is then stored
/// too. After power-on the old cause is erased first. `restart_is_planned`: the program has requested
/// the reset, so it is no fault.
pub fn store_reset_fault_and_load_cause(
    reset: ResetCause,
    restart_is_planned: bool,
) -> Option<TripCause> {
    if reset == ResetCause::PowerOn {
        // The content of the RAM is arbitrary.
        erase_stored_trip_cause();
    }
    if let Some(fault) = reset.indicated_fault(restart_is_planned) {
        store_trip_cause_if_none(&TripCause::without_readings(fault));
    }
    stored_trip_cause()
}

/// Keeps the stored trip cause up to date while the program runs: stores the cause when a finger
/// trips, and erases it when no finger is tripped any more.
pub struct TripCauseRecorder {
    stored: Option<TripCause>,
}

impl TripCauseRecorder {
    /// Creates the recorder. `stored` is the cause by which the device is tripped at the start,
    /// `None` if it is not tripped. This cause counts as stored: only a different one is written to
    /// RAM.
    pub const fn new(stored: Option<TripCause>) -> Self {
        Self { stored }
    }

    /// Whether the recorder treats a trip cause as stored: the one given to [`new`](Self::new), or
    /// the last one that [`store_or_erase`](Self::store_or_erase) has stored. If so, every control
    /// tick must call `store_or_erase`, which erases the cause once no finger is tripped any more.
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
            store_trip_cause_if_none(cause);
        }
        self.stored = earliest.copied();
    }
}
