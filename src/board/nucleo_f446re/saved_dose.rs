//! The thermal dose of each finger, in RAM that a reset does not clear.

use core::sync::atomic::{AtomicU32, Ordering};

use thermal_display::device::Finger;
use thermal_display::device::safety::ThermalDose;

use super::FINGERS;
use super::fault_record::checksum;

/// Thermal dose of each finger and its checksum. The start-up code does not initialise `.uninit`.
#[unsafe(link_section = ".uninit.dose")]
static SAVED: [[AtomicU32; 2]; FINGERS] = [const { [const { AtomicU32::new(0) }; 2] }; FINGERS];

/// The thermal dose of a finger that was saved before the reset; zero if its checksum does not match.
pub fn saved_dose(finger: Finger<FINGERS>) -> ThermalDose {
    let [dose, sum] = &SAVED[finger.index()];
    let word = dose.load(Ordering::Relaxed);
    if checksum(&[word]) == sum.load(Ordering::Relaxed) {
        ThermalDose::from_word(word)
    } else {
        ThermalDose::default()
    }
}

/// Saves the thermal dose of a finger in RAM that a reset does not clear; called in every tick.
pub fn save_dose(finger: Finger<FINGERS>, dose: &ThermalDose) {
    let saved = &SAVED[finger.index()];
    // The dose changes every 256 ticks only; the comparison is faster than the checksum.
    if saved[0].load(Ordering::Relaxed) != dose.to_word() {
        store(saved, dose);
    }
}

fn store([saved, sum]: &[AtomicU32; 2], dose: &ThermalDose) {
    let word = dose.to_word();
    saved.store(word, Ordering::Relaxed);
    sum.store(checksum(&[word]), Ordering::Relaxed);
}

/// Sets the saved dose of all fingers to zero, after a loss of power, when the content of the RAM
/// is arbitrary.
pub fn clear_doses() {
    SAVED
        .iter()
        .for_each(|saved| store(saved, &ThermalDose::default()));
}
