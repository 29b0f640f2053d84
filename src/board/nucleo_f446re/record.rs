//! The first cause, where resets do not reach it.

use core::sync::atomic::{AtomicU32, Ordering};

use thermal_display::device::safety::Cause;

use super::reset::Reset;

/// What makes it unlikely that noise is taken for a record, or that of a firmware whose records mean something else.
const SALT: u32 = 0x5afe_d15b ^ Cause::LAYOUT;
const LENGTH: usize = Cause::WORDS + 1;

/// Words of the cause and their check. Neither the loader nor the start-up code writes to `.uninit`; only a loss of
/// power does.
#[unsafe(link_section = ".uninit.cause")]
static KEPT: [AtomicU32; LENGTH] = [const { AtomicU32::new(0) }; LENGTH];

pub fn check(words: &[u32]) -> u32 {
    words.iter().fold(SALT, |sum, word| {
        sum.rotate_left(5)
            .wrapping_add(*word)
            .wrapping_mul(0x9e37_79b1)
    })
}

/// What is kept, if anything.
pub fn kept() -> Option<Cause> {
    let words: [u32; LENGTH] = core::array::from_fn(|i| KEPT[i].load(Ordering::Relaxed));
    let [cause @ .., sum] = words;
    if check(&cause) == sum {
        Cause::from_words(cause)
    } else {
        None
    }
}

/// Keeps a cause, unless there is one: the first one counts.
pub fn keep(cause: &Cause) {
    if kept().is_some() {
        return;
    }
    let words = cause.to_words();
    for (place, word) in KEPT.iter().zip(words.into_iter().chain([check(&words)])) {
        place.store(word, Ordering::Relaxed);
    }
}

/// Keeps nothing.
pub fn forget() {
    let [.., sum] = &KEPT;
    sum.fetch_xor(SALT, Ordering::Relaxed);
    // By chance that may be the check of something else.
    if kept().is_some() {
        sum.fetch_add(1, Ordering::Relaxed);
    }
}

/// Why the device has tripped before it started: what was kept, or the reset itself if that is a fault.
pub fn of_reset(reset: Reset, is_planned: bool) -> Option<Cause> {
    if reset == Reset::PowerOn {
        // RAM is noise.
        forget();
    }
    if let Some(fault) = reset.fault(is_planned) {
        keep(&Cause::alone(fault));
    }
    kept()
}

/// Keeps what trips while the program runs, and forgets it when the host has cleared it.
pub struct Record {
    kept: Option<Cause>,
}

impl Record {
    /// After a start with or without a cause.
    pub const fn new(kept: Option<Cause>) -> Self {
        Self { kept }
    }

    /// Something has tripped, and was not cleared when this was last followed.
    pub const fn keeps(&self) -> bool {
        self.kept.is_some()
    }

    /// Follows the stations of one tick.
    pub fn follow(&mut self, tripped: Option<&Cause>) {
        if tripped == self.kept.as_ref() {
            return;
        }
        // It was cleared, whether or not something has tripped since.
        forget();
        if let Some(cause) = tripped {
            keep(cause);
        }
        self.kept = tripped.copied();
    }
}
