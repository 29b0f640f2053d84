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

/// Return from the best reading that trips.
const RETURN_MAX: Celsius = Celsius::lit("2.5");
/// Mean current from which on its sign is certain.
const CERTAIN_SIGN: Current = Current::lit("1");
/// Time constant of the mean, as a power of two of ticks: after the current changes sign, the thermistor's reading continues
/// for its lag of up to 0.5 s.
const MEAN_SHIFT: u32 = 8;
/// Ticks since the best reading that separate a quick return from a slow one.
const SLOW_TICKS: u16 = 2000;

/// The mean current, and the best reading since its sign is certain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrongWayDetector {
    mean_current: Current,
    best: Option<Celsius>,
    /// Ticks since the best reading.
    ticks: u16,
}

impl WrongWayDetector {
    /// Takes one tick: the current demanded in the tick before, positive if it cools, the reading, and by how much it is
    /// above the set-point; current and difference are zero while the bridge is off.
    ///
    /// # Errors
    /// The display has moved against the current.
    pub fn check(
        &mut self,
        demanded: Current,
        display: Celsius,
        above_setpoint: Celsius,
    ) -> Result<(), Fault> {
        self.mean_current = self
            .mean_current
            .saturating_add(demanded.saturating_sub(self.mean_current) >> MEAN_SHIFT);
        // Warming is mirrored, so that a lower reading is better for both signs.
        let (display, above_setpoint) = if self.mean_current < 0 {
            (display.saturating_neg(), above_setpoint.saturating_neg())
        } else {
            (display, above_setpoint)
        };
        if self.mean_current.saturating_abs() < CERTAIN_SIGN || above_setpoint <= 0 {
            self.best = None;
            return Ok(());
        }
        match self.best {
            Some(best) if display >= best => {
                self.ticks = self.ticks.saturating_add(1);
                if display.saturating_sub(best) < RETURN_MAX {
                    Ok(())
                } else if self.ticks < SLOW_TICKS {
                    Err(Fault::Polarity)
                } else {
                    Err(Fault::Runaway)
                }
            }
            _ => {
                self.best = Some(display);
                self.ticks = 0;
                Ok(())
            }
        }
    }
}
