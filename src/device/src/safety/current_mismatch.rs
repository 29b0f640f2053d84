//! Detects a measured current that differs from the demanded one.

use super::Fault;
use super::debounce::DebounceCounter;
use crate::drive::Current;

/// Part of the tolerated difference between measured and demanded current that does not depend on the demand, A: the
/// dead times of the bridge's switches alone cause up to 0.5 A near zero.
const CONSTANT_TOLERANCE: Current = Current::lit("1");
/// Part of the tolerated difference that grows with the demanded current, as a shift to the right: 2 gives a quarter.
/// Modules, leads and supply differ from their class by 10 %, the current mirror by 5 %.
const DEMAND_TOLERANCE_SHIFT: u32 = 2;
/// Ticks of 1 ms for which measured and demanded current must differ before the station trips: an overloaded bridge
/// driver switches off and retries every 4 ms, and has first reported that itself, as [`Fault::Bridge`].
const MISMATCH_TICKS: u8 = 30;

/// Compares the magnitude of the measured current with that of the demanded one in every tick. One counter serves too
/// much and too little current, because a leg of the bridge that is stuck causes the one or the other, depending on the
/// demand's sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CurrentMismatchDetector(DebounceCounter);

impl CurrentMismatchDetector {
    /// Compares the magnitude of `measured`, A, in this tick with `demanded`, A of either sign, which the tick before
    /// demanded of the bridge (zero if it was off). To be called once in every tick with valid readings.
    ///
    /// # Errors
    /// The currents have differed by more than 1 A plus a quarter of the demand for 30 ms: [`Fault::CurrentHigh`] if
    /// too much flows in this tick, else [`Fault::CurrentLow`].
    pub fn check_current(&mut self, demanded: Current, measured: Current) -> Result<(), Fault> {
        let demanded = demanded.saturating_abs();
        let tolerance = CONSTANT_TOLERANCE.saturating_add(demanded >> DEMAND_TOLERANCE_SHIFT);
        let high = measured > demanded.saturating_add(tolerance);
        let low = measured < demanded.saturating_sub(tolerance);
        if !self.0.count_tick(high || low, MISMATCH_TICKS) {
            Ok(())
        } else if high {
            Err(Fault::CurrentHigh)
        } else {
            Err(Fault::CurrentLow)
        }
    }
}
