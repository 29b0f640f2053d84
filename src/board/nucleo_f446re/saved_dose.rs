//! The thermal dose of each finger, in RAM that a reset does not clear.

use core::sync::atomic::{AtomicU32, Ordering};

use thermal_display::device::FingerIndex;
use thermal_display::device::safety::ThermalDose;

use super::FINGERS;
use super::trip_cause_recorder::checksum_of_words;

/// Thermal dose of each finger, in 2^-8 ms at 43 °C, and its checksum. The start-up code does not
/// initialise the section `.uninit`, so that a dose survives a reset.
#[unsafe(link_section = ".uninit.dose")]
static SAVED_DOSES: [[AtomicU32; 2]; FINGERS] =
    [const { [const { AtomicU32::new(0) }; 2] }; FINGERS];

/// The thermal dose of a finger that was saved in RAM before the last reset. Zero if its checksum
/// does not match, because the RAM has lost its content or firmware with another checksum has saved
/// the dose.
pub fn saved_dose_or_zero(finger: FingerIndex<FINGERS>) -> ThermalDose {
    let [dose, sum] = &SAVED_DOSES[finger.index()];
    let word = dose.load(Ordering::Relaxed);
    if checksum_of_words(&[word]) == sum.load(Ordering::Relaxed) {
        ThermalDose::from_any_retained_word(word)
    } else {
        ThermalDose::default()
    }
}

/// Saves the thermal dose of a finger in RAM that a reset does not clear; called in every control
/// tick of that finger.
pub fn save_dose_if_changed(finger: FingerIndex<FINGERS>, dose: &ThermalDose) {
    let saved = &SAVED_DOSES[finger.index()];
    // The dose changes every 256 ticks only; the comparison is faster than the checksum.
    if saved[0].load(Ordering::Relaxed) != dose.to_retained_word() {
        write_dose_and_checksum(saved, dose);
    }
}

fn write_dose_and_checksum([saved, sum]: &[AtomicU32; 2], dose: &ThermalDose) {
    let word = dose.to_retained_word();
    saved.store(word, Ordering::Relaxed);
    sum.store(checksum_of_words(&[word]), Ordering::Relaxed);
}

/// Sets the saved thermal doses of all fingers to zero. Called after power-on, when the content of
/// the RAM is arbitrary.
pub fn zero_saved_doses() {
    SAVED_DOSES.iter().for_each(|saved| write_dose_and_checksum(saved, &ThermalDose::default()));
}
