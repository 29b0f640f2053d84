//! Means of the thermistors' sums over half a second, for calibration.

use super::THERMISTORS;

/// Ticks of 1 ms whose sums are added in one block; two blocks, half a second, make an average.
const AVERAGED_BLOCK_TICKS: u32 = 256;

/// Mean of one thermistor's sums over the last two complete blocks, 512 ticks of 1 ms, from which a calibration is
/// computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermistorAverage {
    /// Total over the last two complete blocks: [`Self::TICKS`] sums of 16 conversions each. The block in progress is
    /// not included.
    total: u32,
    /// Total of the later block minus that of the earlier one, which tells whether the reading is steady.
    change: i32,
}

impl ThermistorAverage {
    /// Ticks of 1 ms that the mean covers: those of two blocks.
    pub const TICKS: u32 = 2 * AVERAGED_BLOCK_TICKS;
    /// Largest difference of the two blocks' totals, in units of a sum, for a steady reading: 0.12 counts (3 mK) in a
    /// quarter of a second, which is four standard deviations if the converter's noise is 1.2 counts.
    const STEADY_CHANGE_MAX: u32 = AVERAGED_BLOCK_TICKS * 16 * 12 / 100;

    /// Mean of the sums of 16 conversions of 12 bits, 0 to 65520.
    #[must_use]
    pub fn mean_sum(&self) -> f64 {
        f64::from(self.total) / f64::from(Self::TICKS)
    }

    /// Whether the two blocks differ by at most 0.12 counts, about 3 mK; only a steady reading may serve for a
    /// calibration.
    #[must_use]
    pub const fn is_steady(&self) -> bool {
        self.change.unsigned_abs() <= Self::STEADY_CHANGE_MAX
    }
}

/// Running sums from which the averages of all five thermistors follow, for the calibration. A station adds its ticks
/// while it presents no object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermistorAverages {
    /// Ticks in the block in progress, below 256.
    ticks: u32,
    /// Blocks completed since the start; an average needs two.
    complete_blocks: u32,
    /// Totals of each thermistor over the block in progress; 256 sums of 16 bits fit.
    current: [u32; THERMISTORS],
    /// Totals over the last complete block.
    last: [u32; THERMISTORS],
    /// Totals over the complete block before that.
    second_last: [u32; THERMISTORS],
}

impl ThermistorAverages {
    /// Adds the five thermistors' sums of one tick, in the order display, second display, sink, skin, room.
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

    /// The average of one thermistor by its index (0 to 4: display, second display, sink, skin, room); `None` for a
    /// larger index, and before two blocks are complete.
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
