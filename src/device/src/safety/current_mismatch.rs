//! Detects a measured current that differs from the demanded one.

use super::Fault;
use super::UpDownDebounceCounter;
use super::detectors::EVALUATION_INTERVAL_TICKS;
use crate::drive::Current;

/// Part of the tolerated difference between measured and demanded current that does not depend on the demand, A. At
/// small currents the dead times of the bridge's switches alone cause a difference of up to 0.5 A.
const CONSTANT_CURRENT_TOLERANCE: Current = Current::lit("1");
/// Part of the tolerated difference between measured and demanded current that grows with the demand, as a right shift
/// of the demanded current: 2 tolerates a quarter of it. Module, leads and supply deviate from their nominal values by
/// up to 10 %, the current mirror by up to 5 %.
const PROPORTIONAL_TOLERANCE_SHIFT: u32 = 2;
/// Net ticks of 1 ms at which [`Fault::CurrentHigh`] or [`Fault::CurrentLow`] trips the station: each tick in which
/// measured and demanded current differ too much counts up, each other tick counts down. It is long enough for an
/// overloaded bridge driver, which switches off and retries every 3 ms, to pull its fault line first, which trips the
/// station by [`Fault::Bridge`].
const MISMATCH_TRIP_NET_TICKS: u8 = 30;
/// The same as a number of evaluations.
const MISMATCH_TRIP_NET_EVALUATIONS: u8 = MISMATCH_TRIP_NET_TICKS / EVALUATION_INTERVAL_TICKS;

/// Detects a measured current that differs from the demanded one in magnitude. One counter serves both too much and too
/// little current, because a leg of the bridge that is stuck causes one or the other, depending on the sign of the
/// demand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CurrentMismatchDetector(UpDownDebounceCounter);

impl CurrentMismatchDetector {
    /// Compares the magnitude of `measured`, A, the current of this tick, with that of `demanded`, A (positive cools,
    /// zero if the bridge was off), the current that the tick before demanded of the bridge. To be called in every second
    /// tick with valid readings.
    ///
    /// # Errors
    /// The two magnitudes have differed by more than 1 A plus a quarter of the demanded one for 30 net ticks of 1 ms (a
    /// tick within the tolerance counts down): [`Fault::CurrentHigh`] if too much flows in this tick, else
    /// [`Fault::CurrentLow`].
    pub fn check_current(&mut self, demanded: Current, measured: Current) -> Result<(), Fault> {
        // Fewer instructions than `saturating_abs`.
        let demanded = demanded.max(Current::ZERO.saturating_sub(demanded));
        let tolerance =
            CONSTANT_CURRENT_TOLERANCE.saturating_add(demanded >> PROPORTIONAL_TOLERANCE_SHIFT);
        let high = measured > demanded.saturating_add(tolerance);
        let low = measured < demanded.saturating_sub(tolerance);
        let limit = MISMATCH_TRIP_NET_EVALUATIONS;
        if !self.0.count(high || low, limit) {
            Ok(())
        } else if high {
            Err(Fault::CurrentHigh)
        } else {
            Err(Fault::CurrentLow)
        }
    }
}
