//! The dose of each finger, where resets do not reach it.

use core::sync::atomic::{AtomicU32, Ordering};

use thermal_display::device::safety::Dose;

use super::FINGERS;
use super::record::check;

/// The dose and its check, of each finger.
#[unsafe(link_section = ".uninit.dose")]
static KEPT: [[AtomicU32; 2]; FINGERS] = [const { [const { AtomicU32::new(0) }; 2] }; FINGERS];

/// What is kept of a finger; nothing if that is noise.
pub fn kept(finger: usize) -> Dose {
    let Some([dose, sum]) = KEPT.get(finger) else {
        return Dose::default();
    };
    let word = dose.load(Ordering::Relaxed);
    if check(&[word]) == sum.load(Ordering::Relaxed) {
        Dose::from_word(word)
    } else {
        Dose::default()
    }
}

/// Keeps a finger's.
pub fn keep(finger: usize, dose: &Dose) {
    let Some(place) = KEPT.get(finger) else {
        return;
    };
    let [kept, _] = place;
    // It changes four times a second.
    if kept.load(Ordering::Relaxed) != dose.to_word() {
        store(place, dose);
    }
}

fn store([kept, sum]: &[AtomicU32; 2], dose: &Dose) {
    let word = dose.to_word();
    kept.store(word, Ordering::Relaxed);
    sum.store(check(&[word]), Ordering::Relaxed);
}

/// Forgets all: the power was lost, and the RAM is noise.
pub fn forget() {
    KEPT.iter().for_each(|place| store(place, &Dose::default()));
}
