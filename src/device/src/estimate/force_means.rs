//! Running means of the finger's force, which start again when the force jumps.

use core::num::NonZeroU32;

use contact_model::fixed_point::Force;

/// Threshold of a jump: a tick's force that differs from the mean of the last 64 ticks by more than 1/16 of that mean,
/// and by more than 10 mN, is a new force, and the means start again from it. A smaller difference is no jump.
const FORCE_JUMP_FROM_RECENT_MEAN: RelativeForceThresholdWithFloor =
    RelativeForceThresholdWithFloor { shift: 4, floor: Force::lit("0.01") };
/// Threshold of drift: the mean of the last 64 ticks has drifted if it differs from the mean for which the set-points
/// were computed by more than 1/2048 of that mean, and by more than 0.25 mN. Smaller than the threshold of a jump,
/// because a mean has less noise than the force of a single tick.
const RECENT_MEAN_DRIFT_THRESHOLD: RelativeForceThresholdWithFloor =
    RelativeForceThresholdWithFloor { shift: 11, floor: Force::lit("0.00025") };
/// Ticks of 1 ms (64 ms) over which the recent mean of the force averages. Jumps and drift of the force are detected by
/// comparison with the recent mean.
const RECENT_MEAN_TICKS: u32 = 64;
/// The long running mean of the force averages over the last quarter (2^-2, this power of two) of the ticks since the
/// last jump of the force, but over at least 64 and at most 4096 ticks. The set-point changes with the logarithm of
/// time, so late in a contact noise may be averaged over a longer time. A drift sets the count of ticks since the jump
/// back to 64.
const LONG_MEAN_WINDOW_FRACTION_SHIFT: u32 = 2;
/// Largest number of ticks of 1 ms over which the long running mean of the force averages (4.1 s).
const LONG_MEAN_MAX_TICKS: u32 = 4096;
/// Fewest ticks of 1 ms since the last jump of the force after which a better mean may cause new set-points. A mean of
/// fewer ticks is hardly more accurate than the force of the single tick with which it began.
const MIN_TICKS_SINCE_JUMP_FOR_NEW_SETPOINT: u32 = 16;

/// Threshold for the difference between a force and a force of comparison: a fraction of the force of comparison, but
/// at least a constant number of newtons.
struct RelativeForceThresholdWithFloor {
    /// Fraction of the force of comparison, as a right shift in bits: 4 stands for 1/16.
    shift: u32,
    /// Smallest threshold, N; used where the fraction of the force of comparison is smaller.
    floor: Force,
}

impl RelativeForceThresholdWithFloor {
    /// Whether the forces `force` and `from`, N, differ by more than the threshold, in either direction. The threshold
    /// is a fraction of `from`, the force of comparison, but at least the constant `floor`.
    fn is_exceeded(&self, force: Force, from: Force) -> bool {
        force.max(from) - force.min(from) > (from >> self.shift).max(self.floor)
    }
}

/// Running means of a finger's force, N, during one contact. They start again when the force jumps. Also holds the mean
/// for which the present set-points are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForceMeans {
    /// Mean force, N, of the last 64 ticks, or of the ticks since the last jump if they are fewer. Jumps of the force
    /// and drift are detected by comparison with this mean.
    recent_mean: Force,
    /// Running mean of the force, N, over the last quarter of the ticks since the last jump of the force, but over at
    /// least 64 and at most 4096 ticks; over all ticks since the jump while these are fewer than 64. A drift starts
    /// this mean again from the mean of the last 64 ticks.
    long_mean: Force,
    mean_for_setpoints: Force,
    /// Number of ticks of 1 ms since the last jump of the force, the tick of the jump included. Stops at 16384, where a
    /// quarter of it reaches the largest length of the long mean; a drift sets it back to 64.
    ticks: u32,
}

/// Whether the force of one tick is noise, a jump, or completes a drift of the mean force. After a jump or a drift the
/// set-points must be computed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceChange {
    /// The force differs from the mean of the last 64 ticks by at most 1/16 of that mean, or by at most 10 mN, and that
    /// mean has not drifted. A force like this does not require new set-points.
    Noise,
    /// The force has drifted: the mean of the last 64 ticks differs from the mean for which the set-points were
    /// computed by more than 1/2048 of the latter and more than 0.25 mN. The long mean has started again from the mean
    /// of the last 64 ticks.
    Drifted,
    /// The force has jumped: it differs from the mean of the last 64 ticks by more than 1/16 of that mean and more than
    /// 10 mN; or the finger has just landed. All means have started again from this force.
    New,
}

impl ForceMeans {
    /// Starts the means with a single force, N, at landing and after each jump of the force.
    pub const fn new(force: Force) -> Self {
        Self { recent_mean: force, long_mean: force, mean_for_setpoints: force, ticks: 1 }
    }

    /// Long running mean of the force, N: over all ticks since the last jump of the force while these are fewer than
    /// 64, later over the last quarter of them, with at least 64 and at most 4096 ticks. A drift starts this mean again
    /// from the mean of the last 64 ticks.
    pub const fn long_mean(&self) -> Force {
        self.long_mean
    }

    /// Mean force, N, for which the present set-points are computed. A landing or a jump of the force sets it to the
    /// force of that tick; [`Self::use_long_mean_for_setpoints`] sets it to the long mean.
    pub const fn mean_for_setpoints(&self) -> Force {
        self.mean_for_setpoints
    }

    /// Sets the mean force for which set-points are computed to the present long mean.
    pub const fn use_long_mean_for_setpoints(&mut self) {
        self.mean_for_setpoints = self.long_mean;
    }

    /// Whether the number of ticks since the last jump of the force, the tick of the jump included, is a power of two
    /// from 16 on: 16, 32, 64 … 16384, where the number stops. The mean has then become more accurate, so new
    /// set-points may be worth the computing time. True also in the tick of a drift, which sets the number back to 64.
    pub const fn ticks_since_jump_are_power_of_two(&self) -> bool {
        self.ticks >= MIN_TICKS_SINCE_JUMP_FOR_NEW_SETPOINT && self.ticks.is_power_of_two()
    }

    /// Whether the force has jumped in one of the last `ticks` ticks, at most 64; a landing counts as a jump.
    pub const fn have_jumped_within(&self, ticks: u32) -> bool {
        self.ticks <= ticks
    }

    /// Adds the force of one tick, N, to the running means, or starts them again if the force has jumped. Returns
    /// whether the force has jumped, has drifted, or shows only noise.
    pub fn add_force(&mut self, force: Force) -> ForceChange {
        if FORCE_JUMP_FROM_RECENT_MEAN.is_exceeded(force, self.recent_mean) {
            *self = Self::new(force);
            return ForceChange::New;
        }
        self.ticks = (self.ticks + 1).min(LONG_MEAN_MAX_TICKS << LONG_MEAN_WINDOW_FRACTION_SHIFT);
        let reach_ticks = RECENT_MEAN_TICKS.max(self.ticks >> LONG_MEAN_WINDOW_FRACTION_SHIFT);
        self.recent_mean = updated_mean(self.recent_mean, force, self.ticks.min(RECENT_MEAN_TICKS));
        self.long_mean = updated_mean(self.long_mean, force, self.ticks.min(reach_ticks));
        if self.ticks >= RECENT_MEAN_TICKS
            && RECENT_MEAN_DRIFT_THRESHOLD.is_exceeded(self.recent_mean, self.mean_for_setpoints)
        {
            self.long_mean = self.recent_mean;
            self.ticks = RECENT_MEAN_TICKS;
            return ForceChange::Drifted;
        }
        ForceChange::Noise
    }
}

/// Running mean, N, of the last `ticks` forces (at least 1): the previous `mean` moves towards the new `force` by
/// 1/`ticks` of their difference. With constant `ticks` this is a low-pass filter with a time constant of that many
/// ticks.
fn updated_mean(mean: Force, force: Force, ticks: u32) -> Force {
    let ticks = NonZeroU32::new(ticks).unwrap_or(NonZeroU32::MIN);
    let part = Force::from_bits((force.max(mean) - force.min(mean)).to_bits() / ticks);
    if force >= mean { mean.saturating_add(part) } else { mean.saturating_sub(part) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_averages_noise_and_takes_a_step_at_once() {
        let mut mean = ForceMeans::new(Force::lit("2"));
        for i in 0..500 {
            let noisy = if i % 2 == 0 { Force::lit("2.01") } else { Force::lit("1.99") };
            assert_eq!(mean.add_force(noisy), ForceChange::Noise);
        }
        mean.add_force(Force::lit("2"));
        let error = mean.long_mean().to_num::<f64>() - 2.0;
        assert!(error.abs() < 5e-4, "{error}");
        assert_eq!(mean.add_force(Force::lit("1")), ForceChange::New);
        assert_eq!(mean.long_mean(), Force::lit("1"));
    }
}
