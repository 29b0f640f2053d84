//! Means of the thermistors' sums over half a second, for calibration.

use super::THERMISTORS;

/// Ticks of one block.
const AVERAGED_BLOCK_TICKS: u32 = 256;

/// Mean of one thermistor's sums over the last two complete blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermistorAverage {
    /// Total of both blocks: [`Self::TICKS`] sums of 16 conversions each.
    total: u32,
    /// Total of the later block minus that of the earlier.
    change: i32,
}

impl ThermistorAverage {
    /// Ticks of both blocks.
    pub const TICKS: u32 = 2 * AVERAGED_BLOCK_TICKS;
    /// Largest change of a steady reading: 0.12 counts (3 mK) in a quarter of a second, which is four
    /// standard deviations if the converter's noise is 1.2 counts.
    const STEADY_CHANGE_MAX: u32 = AVERAGED_BLOCK_TICKS * 16 * 12 / 100;

    /// The mean sum of 16 conversions, 0 to 65520.
    #[must_use]
    pub fn mean_sum(&self) -> f64 {
        f64::from(self.total) / f64::from(Self::TICKS)
    }

    /// The two blocks differ by less than 3 mK.
    #[must_use]
    pub const fn is_steady(&self) -> bool {
        self.change.unsigned_abs() <= Self::STEADY_CHANGE_MAX
    }
}

/// Means of all thermistors; `None` in the first [`ThermistorAverage::TICKS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermistorAverages {
    /// Ticks in the current block.
    ticks: u32,
    complete_blocks: u32,
    /// Totals of the current block and of the two before it; 256 sums of 16 bits fit.
    current: [u32; THERMISTORS],
    last: [u32; THERMISTORS],
    second_last: [u32; THERMISTORS],
}

impl ThermistorAverages {
    /// Adds the thermistors' sums of one tick.
    pub fn add_tick(&mut self, sums: &[u16; THERMISTORS]) {
        for (total, sum) in self.current.iter_mut().zip(sums) {
            *total += u32::from(*sum);
        }
        self.ticks += 1;
        if self.ticks == AVERAGED_BLOCK_TICKS {
            (self.second_last, self.last) = (self.last, self.current);
            (self.current, self.ticks) = ([0; THERMISTORS], 0);
            self.complete_blocks = self.complete_blocks.saturating_add(1);
        }
    }

    /// The mean of one thermistor, by its index; `None` before two blocks are complete.
    #[must_use]
    pub fn of(&self, thermistor: usize) -> Option<ThermistorAverage> {
        let last = *self.last.get(thermistor)?;
        let second_last = *self.second_last.get(thermistor)?;
        (self.complete_blocks >= 2).then_some(ThermistorAverage {
            total: last + second_last,
            change: last as i32 - second_last as i32,
        })
    }
}
