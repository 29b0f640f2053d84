//! Detects a display that moves against the current.
//!
//! While current cools a display that is above its set-point, the reading must fall or stay; while current warms one that is
//! below, it must rise or stay. A reading that returns by 2.5 K from its best value is driven by something else: quickly, if
//! the polarity is wrong or the thermistor is misplaced; slowly, if the current warms the sink more than it cools the
//! display. A finger of 36 °C that lands with 5 N while a hot sink limits the current causes 2 K. The test needs no model of
//! the tile, so it holds for every law and every tile.

use contact_model::fixed_point::Celsius;

use super::Fault;
use crate::drive::Current;

/// Rise of the display's reading above the lowest one so far while cooling, or fall below the highest one while
/// warming, K, that trips the station. A finger that lands while the current is at its limit causes 2 K.
const TRIP_REVERSAL: Celsius = Celsius::lit("2.5");
/// Magnitude of the mean demanded current, A, from which on the direction of the reading is tested; while the mean is
/// smaller, its sign may not be that of the current that flows, and the best reading is forgotten.
const MIN_TESTED_CURRENT: Current = Current::lit("1");
/// Time constant of the mean demanded current, as a power of two of ticks of 1 ms: 8 gives 0.26 s. The mean is used
/// because the reading goes on in its old direction for the thermistor's lag of up to 0.5 s after the current has
/// changed sign.
const MEAN_CURRENT_SHIFT: u32 = 8;
/// Ticks of 1 ms since the best reading from which on a reversal is named [`Fault::Runaway`]; a quicker one is named
/// [`Fault::Polarity`].
const RUNAWAY_FROM_TICKS: u16 = 2000;

/// Detects a display that warms while it is cooled above its set-point, or cools while it is warmed below it: keeps the
/// mean demanded current, and the lowest (while warming highest) reading since the test began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrongWayDetector {
    /// Mean of the demanded current, A; positive cools.
    mean_current: Current,
    /// Lowest reading while cooling, or highest while warming, with its sign inverted, °C; `None` while nothing is
    /// tested.
    best: Option<Celsius>,
    /// Ticks of 1 ms since the best reading.
    ticks_since_best: u16,
}

impl WrongWayDetector {
    /// Tests one tick: `demanded` is the current demanded in the tick before, A, positive if it cools and zero if the
    /// bridge was off; `display` is the reading, °C; `above_setpoint` is the reading less the set-point, K, and zero,
    /// which ends the test, if no set-point is followed.
    ///
    /// # Errors
    /// The reading has moved against the mean current by 2.5 K from its best value: [`Fault::Polarity`] within 2 s,
    /// later [`Fault::Runaway`].
    pub fn check_direction(
        &mut self,
        demanded: Current,
        display: Celsius,
        above_setpoint: Celsius,
    ) -> Result<(), Fault> {
        self.mean_current = self
            .mean_current
            .saturating_add(demanded.saturating_sub(self.mean_current) >> MEAN_CURRENT_SHIFT);
        // Warming is mirrored, so that a lower reading is better for both signs.
        let (display, above_setpoint) = if self.mean_current < 0 {
            (display.saturating_neg(), above_setpoint.saturating_neg())
        } else {
            (display, above_setpoint)
        };
        if self.mean_current.saturating_abs() < MIN_TESTED_CURRENT || above_setpoint <= 0 {
            self.best = None;
            return Ok(());
        }
        match self.best {
            Some(best) if display >= best => {
                self.ticks_since_best = self.ticks_since_best.saturating_add(1);
                if display.saturating_sub(best) < TRIP_REVERSAL {
                    Ok(())
                } else if self.ticks_since_best < RUNAWAY_FROM_TICKS {
                    Err(Fault::Polarity)
                } else {
                    Err(Fault::Runaway)
                }
            }
            _ => {
                self.best = Some(display);
                self.ticks_since_best = 0;
                Ok(())
            }
        }
    }
}
