//! Faults that show only over time.

use contact_model::fixed_point::Celsius;

use super::Fault;
use crate::sense::{Readings, Samples};

/// Ticks of identical samples that count as a converter that stands still: seven sums of 16 conversions do not
/// repeat once by chance, let alone 50 times.
const FROZEN_TICKS: u32 = 50;
/// Difference of the display's thermistors that counts, and for how many ticks.
const APART: Celsius = Celsius::lit("3");
const APART_TICKS: u32 = 100;

/// What the guard remembers from tick to tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Watch {
    last: Samples,
    same_ticks: u32,
    apart_ticks: u32,
}

impl Watch {
    /// Takes one tick.
    ///
    /// # Errors
    /// A fault that has lasted.
    pub fn check(&mut self, samples: &Samples, readings: &Readings) -> Result<(), Fault> {
        let same = *samples == self.last;
        if !same {
            self.last = *samples;
        }
        self.same_ticks = lasting(same, self.same_ticks);
        let apart = match (readings.display, readings.display_check) {
            (Ok(a), Ok(b)) => a.saturating_sub(b).saturating_abs() > APART,
            _ => false,
        };
        self.apart_ticks = lasting(apart, self.apart_ticks);
        if self.same_ticks >= FROZEN_TICKS {
            return Err(Fault::SamplesFrozen);
        }
        if self.apart_ticks >= APART_TICKS {
            return Err(Fault::DisplaysDisagree);
        }
        Ok(())
    }
}

/// Ticks for which something has been so.
fn lasting(so: bool, ticks: u32) -> u32 {
    if so { ticks.saturating_add(1) } else { 0 }
}
