//! Means of what the converter reads, for calibration.

use super::THERMISTORS;

/// Ticks of one block.
const BLOCK_TICKS: u32 = 256;

/// Means of a thermistor's sums over the last two blocks that are complete.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Average {
    /// Totals of both blocks: sums of [`Self::TICKS`] sums of conversions.
    pub total: u32,
    /// What the later block has more than the earlier.
    pub rise: i32,
}

impl Average {
    /// Ticks of both blocks.
    pub const TICKS: u32 = 2 * BLOCK_TICKS;
    /// Largest [rise](Self::rise) of a steady reading: 0.12 counts, 3 mK, in a quarter of a second. That is four
    /// standard deviations of a converter with a noise of 1.2 counts.
    const STEADY: u32 = BLOCK_TICKS * 16 * 12 / 100;

    /// The mean sum of 16 conversions.
    #[must_use]
    pub fn sum(&self) -> f64 {
        f64::from(self.total) / f64::from(Self::TICKS)
    }

    /// The reading does not move.
    #[must_use]
    pub const fn is_steady(&self) -> bool {
        self.rise.unsigned_abs() <= Self::STEADY
    }
}

/// Means of all thermistors; none before the device has run for [`Average::TICKS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Averages {
    ticks: u32,
    blocks: u32,
    /// The block that is being filled, and the two before it; totals fit, 256 times 16 bits.
    filling: [u32; THERMISTORS],
    last: [u32; THERMISTORS],
    before: [u32; THERMISTORS],
}

impl Averages {
    /// Takes the thermistors' sums of one tick.
    pub fn take(&mut self, sums: &[u16; THERMISTORS]) {
        for (total, sum) in self.filling.iter_mut().zip(sums) {
            *total += u32::from(*sum);
        }
        self.ticks += 1;
        if self.ticks == BLOCK_TICKS {
            (self.before, self.last) = (self.last, self.filling);
            (self.filling, self.ticks) = ([0; THERMISTORS], 0);
            self.blocks = self.blocks.saturating_add(1);
        }
    }

    /// The mean of one thermistor; `None` until it was watched for long enough.
    #[must_use]
    pub fn of(&self, thermistor: usize) -> Option<Average> {
        let (last, before) = (*self.last.get(thermistor)?, *self.before.get(thermistor)?);
        (self.blocks >= 2).then_some(Average {
            total: last + before,
            rise: last as i32 - before as i32,
        })
    }
}
