//! A display that goes the wrong way.
//!
//! While current cools and the display is warmer than it should be, its reading may fall or stay; while it warms and
//! the display is too cold, rise or stay. A reading that goes back from its best by 2.5 K is driven by something else:
//! at once, the polarity is wrong or the thermistor is elsewhere; slowly, the current heats the sink more than it
//! cools the display. A finger of 36 °C that lands with 5 N while a hot sink limits the current does 2 K. The test needs no
//! model of the tile, so it holds for every law and every tile.

use contact_model::fixed_point::Celsius;

use super::Fault;
use crate::drive::Current;

/// Back from the best.
const BACK: Celsius = Celsius::lit("2.5");
/// Mean current from which on it has a direction.
const DIRECTED: Current = Current::lit("1");
/// Time constant of the mean, as a power of two of ticks: after the current turns, display and thermistor go on for the
/// thermistor's lag of up to 0.5 s.
const MEAN_SHIFT: u32 = 8;
/// Slower than this from the best on, in ticks, the sink does it.
const SLOW_TICKS: u16 = 2000;

/// The mean of the current, and the best reading since it has its direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Response {
    mean: Current,
    best: Option<Celsius>,
    ticks: u16,
}

impl Response {
    /// Takes one tick: the current asked for in the one before, positive if it cools, and by how much the display is
    /// above where it should be; both none while the bridge is off.
    ///
    /// # Errors
    /// The display has gone the wrong way.
    pub fn check(&mut self, asked: Current, display: Celsius, above: Celsius) -> Result<(), Fault> {
        self.mean = self
            .mean
            .saturating_add(asked.saturating_sub(self.mean) >> MEAN_SHIFT);
        // Mirrored, so that lower is better.
        let (display, above) = if self.mean < 0 {
            (display.saturating_neg(), above.saturating_neg())
        } else {
            (display, above)
        };
        if self.mean.saturating_abs() < DIRECTED || above <= 0 {
            self.best = None;
            return Ok(());
        }
        match self.best {
            Some(best) if display >= best => {
                self.ticks = self.ticks.saturating_add(1);
                if display.saturating_sub(best) < BACK {
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
