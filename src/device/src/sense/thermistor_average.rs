//! Means of the thermistors' sums over half a second, for calibration.

use super::THERMISTOR_COUNT;

/// Length of one block, ticks of 1 ms. The sums of the ticks of a block are added up, and two blocks (0.5 s) make an
/// average.
const AVERAGED_BLOCK_TICKS: u32 = 256;

/// Mean of one thermistor's sums of 16 conversions over 512 ticks of 1 ms, and the change from the first block of 256
/// ticks to the second. The calibration compares the mean with a reference thermometer, and accepts it only if the
/// change shows a steady temperature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermistorAverage {
    /// Total of [`Self::AVERAGED_TICKS`] sums of 16 conversions each: those of the last two complete blocks.
    total: u32,
    /// Total of the later block minus total of the earlier block, in units of a sum of 16 conversions; small if the
    /// temperature is steady.
    change: i32,
}

impl ThermistorAverage {
    /// Ticks of 1 ms over which the mean is taken, 512: two blocks.
    pub const AVERAGED_TICKS: u32 = 2 * AVERAGED_BLOCK_TICKS;
    /// Largest magnitude of the difference between the totals of the two blocks for a steady reading, in units of a sum
    /// of 16 conversions. It stands for a change of 0.12 counts a conversion (3 mK) in a quarter of a second: more than
    /// four standard deviations if the converter's noise is 1.2 counts.
    const STEADY_BLOCK_TOTALS_CHANGE_MAX: u32 = AVERAGED_BLOCK_TICKS * 16 * 12 / 100;

    /// Mean, over 512 ticks of 1 ms, of the sum of 16 conversions of 12 bits: 0 to 65520.
    pub fn mean_sum(&self) -> f64 {
        f64::from(self.total) / f64::from(Self::AVERAGED_TICKS)
    }

    /// Whether the means of the two blocks differ by at most 0.12 counts a conversion, about 3 mK. A calibration
    /// accepts only a steady reading.
    pub const fn is_steady(&self) -> bool {
        self.change.unsigned_abs() <= Self::STEADY_BLOCK_TOTALS_CHANGE_MAX
    }
}

/// Adds up the sums of all five thermistors in blocks of 256 ticks of 1 ms, and computes from them the half-second
/// averages for the calibration. A station adds each tick in which it presents no object, and begins again when the
/// host sends `start`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermistorAverages {
    /// Number of ticks in the block in progress, 0 to 255.
    ticks: u32,
    /// Number of blocks completed since the start of the program or, if later, since the host's last `start`; stops at
    /// the largest number. An average needs two complete blocks.
    complete_blocks: u32,
    /// Total of each thermistor's sums over the block in progress. 256 sums of 16 bits fit in 32 bits.
    current: [u32; THERMISTOR_COUNT],
    /// Total of each thermistor's sums over the last complete block of 256 ticks.
    last: [u32; THERMISTOR_COUNT],
    /// Total of each thermistor's sums over the block of 256 ticks before the last complete one.
    second_last: [u32; THERMISTOR_COUNT],
}

impl ThermistorAverages {
    /// Adds one tick: the five thermistors' sums of 16 conversions, in the order display, second display, sink, skin,
    /// room. Every 256th tick completes a block.
    pub fn add_tick(&mut self, sums: &[u16; THERMISTOR_COUNT]) {
        for (total, sum) in self.current.iter_mut().zip(sums) {
            *total += u32::from(*sum);
        }
        self.ticks += 1;
        if self.ticks == AVERAGED_BLOCK_TICKS {
            (self.second_last, self.last) = (self.last, self.current);
            (self.current, self.ticks) = ([0; THERMISTOR_COUNT], 0);
            self.complete_blocks = self.complete_blocks.saturating_add(1);
        }
    }

    /// Average of one thermistor over the last two complete blocks, by its index (0 to 4: display, second display,
    /// sink, skin, room). `None` while fewer than two blocks are complete, and for a larger index.
    pub fn of(&self, thermistor: usize) -> Option<ThermistorAverage> {
        let last = *self.last.get(thermistor)?;
        let second_last = *self.second_last.get(thermistor)?;
        (self.complete_blocks >= 2).then_some(ThermistorAverage {
            total: last + second_last,
            change: last as i32 - second_last as i32,
        })
    }
}
