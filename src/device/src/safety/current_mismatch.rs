//! Detects a measured current that differs from the demanded one.

use super::Fault;
use super::debounce::DebounceCounter;
use crate::drive::Current;

/// Largest difference: this, plus a quarter of the demand as a power of two. Modules, leads and supply differ from their class
/// by 10 %, the mirror by 5 %, and the bridge's dead times cause up to 0.5 A near zero.
const TOLERANCE: Current = Current::lit("1");
const TOLERANCE_SHIFT: u32 = 2;
/// Ticks for which the difference must last: an overloaded bridge driver retries every 4 ms, and first reports so itself.
const TICKS: u8 = 30;

/// One counter for both signs, because a stuck leg causes a difference whose sign follows the demand's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CurrentMismatchDetector(DebounceCounter);

impl CurrentMismatchDetector {
    /// Takes one tick: the current demanded in the tick before, zero while the bridge was off, and the magnitude measured
    /// since.
    ///
    /// # Errors
    /// Too much or too little current has flowed for 30 ms, named after the last tick.
    pub fn check(&mut self, demanded: Current, measured: Current) -> Result<(), Fault> {
        let demanded = demanded.saturating_abs();
        let tolerance = TOLERANCE.saturating_add(demanded >> TOLERANCE_SHIFT);
        let high = measured > demanded.saturating_add(tolerance);
        let low = measured < demanded.saturating_sub(tolerance);
        if !self.0.update(high || low, TICKS) {
            Ok(())
        } else if high {
            Err(Fault::CurrentHigh)
        } else {
            Err(Fault::CurrentLow)
        }
    }
}
