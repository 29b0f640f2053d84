//! Detects a display that moves against the current.
//!
//! While current cools a display that is above its set-point, the reading must fall or stay; while current warms one
//! that is below, it must rise or stay. A reading that returns by 2.5 K from its best value is driven by something
//! else: quickly, if the polarity is wrong or the thermistor is misplaced; slowly, if the current warms the sink more
//! than it cools the display. A finger of 36 °C that lands with 5 N while a hot sink limits the current causes 2 K. The
//! test needs no model of the tile, so it holds for every law and every tile.

use contact_model::fixed_point::Celsius;

use super::Fault;
use super::detectors::EVALUATION_INTERVAL_TICKS;
use crate::drive::Current;

/// Change of the display's reading against the current, K, at which the station trips by [`Fault::Polarity`] or
/// [`Fault::Runaway`]: rise above its lowest value while the display is cooled, or fall below its highest value while
/// the display is warmed. A finger that lands while the current is at its limit causes up to 2 K.
const TRIP_TEMPERATURE_REVERSAL: Celsius = Celsius::lit("2.5");
/// Magnitude of the mean demanded current, A, from which on the direction of the reading is checked. Below it, the sign
/// of the mean may differ from that of the current that flows, so the check starts again later.
const DIRECTION_CHECK_CURRENT_MIN: Current = Current::lit("1");
/// Time constant of the filter of the demanded current, as a power of two of evaluations, 2 ms apart: 7 gives 0.26 s. The filter
/// is needed because the thermistor's lag (up to 0.5 s) lets the reading move in the old direction after the current
/// has changed sign.
const CURRENT_FILTER_SHIFT: u32 = 7;
/// Ticks of 1 ms since the best reading (the lowest while cooling, the highest while warming). If the reading has moved
/// back by [`TRIP_TEMPERATURE_REVERSAL`] after this time or later, the fault is [`Fault::Runaway`]; if earlier,
/// [`Fault::Polarity`].
const RUNAWAY_TICKS_SINCE_BEST_MIN: u16 = 2000;

/// Detects a display that warms while it is cooled and still above its set-point, or cools while it is warmed and still
/// below it. Keeps the filtered demanded current, and the best reading (the lowest while cooling, the highest while
/// warming) since the check began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrongWayDetector {
    /// Demanded current, low-pass filtered with a time constant of 0.26 s, A; positive cools.
    mean_current: Current,
    /// Best reading so far, °C: the lowest while cooling, or, while warming, the negative of the highest, so that lower
    /// is better in both cases. `None` while the direction is not checked: the mean current is below
    /// [`DIRECTION_CHECK_CURRENT_MIN`], no set-point is followed, or the display has reached its set-point.
    best: Option<Celsius>,
    ticks_since_best: u16,
}

impl WrongWayDetector {
    /// Checks, in every second tick, whether the display moves against the mean current. `demanded` is the current of the tick
    /// before, A, positive cools and zero if the bridge was off; `display` is the reading of the display's first
    /// thermistor, °C; `above_setpoint` is that reading minus the set-point, K, or zero if no set-point is followed, in
    /// which case the check starts again later.
    ///
    /// # Errors
    /// The reading has moved back by 2.5 K from its best value (the lowest while cooling, the highest while warming):
    /// [`Fault::Polarity`] within 2 s of that value, later [`Fault::Runaway`].
    pub fn check_direction(
        &mut self,
        demanded: Current,
        display: Celsius,
        above_setpoint: Celsius,
    ) -> Result<(), Fault> {
        self.mean_current = self
            .mean_current
            .saturating_add(demanded.saturating_sub(self.mean_current) >> CURRENT_FILTER_SHIFT);
        // Warming is mirrored, so that a lower reading is better for both signs.
        let (display, above_setpoint) = if self.mean_current < 0 {
            (mirrored(display), mirrored(above_setpoint))
        } else {
            (display, above_setpoint)
        };
        let is_small = self.mean_current > -DIRECTION_CHECK_CURRENT_MIN
            && self.mean_current < DIRECTION_CHECK_CURRENT_MIN;
        if is_small || above_setpoint <= 0 {
            self.best = None;
            return Ok(());
        }
        match self.best {
            Some(best) if display >= best => {
                self.ticks_since_best =
                    (self.ticks_since_best).saturating_add(EVALUATION_INTERVAL_TICKS.into());
                if display.saturating_sub(best) < TRIP_TEMPERATURE_REVERSAL {
                    Ok(())
                } else if self.ticks_since_best < RUNAWAY_TICKS_SINCE_BEST_MIN {
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

/// The negative number; `saturating_neg` takes more instructions.
fn mirrored(temperature: Celsius) -> Celsius {
    Celsius::ZERO.saturating_sub(temperature)
}
