//! Running mean of the force, which starts again when the force changes.

use core::num::NonZeroU32;

use contact_model::fixed_point::Force;

/// A tick's force that differs from the mean of the last 64 ticks by more than this (1/16 of the mean, at least 10 mN)
/// is a new force, and the mean starts again from it; a smaller difference is noise.
const NEW_FORCE_THRESHOLD: ForceThreshold = ForceThreshold {
    shift: 4,
    floor: Force::lit("0.01"),
};
/// The mean of the last 64 ticks has drifted if it differs from the mean in use for set-points by more than this
/// (1/2048 of the latter, at least 0.25 mN). Smaller than the threshold of a new force, because averaging has reduced
/// the noise.
const DRIFT_THRESHOLD: ForceThreshold = ForceThreshold {
    shift: 11,
    floor: Force::lit("0.00025"),
};
/// Ticks (64 ms) over which the recent mean of the force averages; the drift is detected by it.
const RECENT_MEAN_TICKS: u32 = 64;
/// The long mean averages over the last quarter (this power of two) of the ticks since the force changed, limited to 64
/// to 4096 ticks. The set-point depends on the logarithm of time, so noise may be averaged longer in a later contact.
const AVERAGED_PART_SHIFT: u32 = 2;
/// Largest number of ticks (4.1 s) over which the long mean of the force averages.
const LONGEST_MEAN_TICKS: u32 = 4096;
/// Ticks since the force changed from which on a set-point may be computed again for the mean. A mean of fewer is
/// hardly better than the single force that it began with.
const FIRST_USEFUL_MEAN_TICKS: u32 = 16;

/// A threshold for the difference of two forces: the larger of a part of the one that is compared with, and a constant.
struct ForceThreshold {
    /// The part, as a power of two: 4 stands for 1/16.
    shift: u32,
    /// The constant, N.
    floor: Force,
}

impl ForceThreshold {
    /// Whether `force` differs from `from` by more than the threshold, in either direction.
    fn is_exceeded(&self, force: Force, from: Force) -> bool {
        force.max(from) - force.min(from) > (from >> self.shift).max(self.floor)
    }
}

/// Running means of the force of one contact, N, which start again when the force jumps; and the mean for which the
/// set-points are computed now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForceMean {
    /// Mean of the last 64 ticks, or of fewer since the force changed, N.
    recent: Force,
    /// Mean of up to 4096 ticks since the force changed, N.
    mean: Force,
    /// The mean for which the set-points are computed, N.
    in_use: Force,
    /// Ticks of 1 ms since the force changed; stops at 16384, where the long mean has its largest length, and returns
    /// to 64 after a drift.
    ticks: u32,
}

/// How one tick's force compares with the mean of the ticks before it; decides whether set-points are computed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceChange {
    /// The force is within 1/16 (or 10 mN) of the mean of the last 64 ticks, and that mean has not drifted; set-points
    /// need not change.
    Noise,
    /// The mean of the last 64 ticks is more than 1/2048 (or 0.25 mN) away from the mean in use for set-points; the
    /// long mean has started again from the recent one.
    Drifted,
    /// The force differs from the mean of the last 64 ticks by more than 1/16 (or 10 mN), or the finger has just
    /// landed; all means have started again from this force.
    New,
}

impl ForceMean {
    /// Means of one tick, all equal to its force, N: the state at landing and after the force has jumped.
    #[must_use]
    pub const fn new(force: Force) -> Self {
        Self {
            recent: force,
            mean: force,
            in_use: force,
            ticks: 1,
        }
    }

    /// Mean force, N, of the last quarter of the time since the force changed, 64 to 4096 ticks (of all ticks if there
    /// are fewer).
    #[must_use]
    pub const fn mean(&self) -> Force {
        self.mean
    }

    /// The mean force, N, for which set-points are computed: the mean at the last call of [`Self::use_present_mean`],
    /// or the single force with which the means have started since.
    #[must_use]
    pub const fn mean_in_use(&self) -> Force {
        self.in_use
    }

    /// Makes the present mean the one for which set-points are computed.
    pub const fn use_present_mean(&mut self) {
        self.in_use = self.mean;
    }

    /// Whether the mean has become clearly more accurate, so that new set-points for it may be worth their cost: true
    /// in the 16th, 32nd, 64th … tick since the force changed, and in every tick from the 16384th on.
    #[must_use]
    pub const fn has_doubled_ticks(&self) -> bool {
        self.ticks >= FIRST_USEFUL_MEAN_TICKS && self.ticks.is_power_of_two()
    }

    /// Takes the force of one tick, N, into the means, or starts them again if the force has jumped; tells which.
    pub fn add_tick(&mut self, force: Force) -> ForceChange {
        if NEW_FORCE_THRESHOLD.is_exceeded(force, self.recent) {
            *self = Self::new(force);
            return ForceChange::New;
        }
        self.ticks = (self.ticks + 1).min(LONGEST_MEAN_TICKS << AVERAGED_PART_SHIFT);
        let reach_ticks = RECENT_MEAN_TICKS.max(self.ticks >> AVERAGED_PART_SHIFT);
        self.recent = mean_including(self.recent, force, self.ticks.min(RECENT_MEAN_TICKS));
        self.mean = mean_including(self.mean, force, self.ticks.min(reach_ticks));
        if self.ticks >= RECENT_MEAN_TICKS && DRIFT_THRESHOLD.is_exceeded(self.recent, self.in_use)
        {
            self.mean = self.recent;
            self.ticks = RECENT_MEAN_TICKS;
            return ForceChange::Drifted;
        }
        ForceChange::Noise
    }
}

/// The mean, N, of `ticks` forces (at least 1), given the mean without the last one and the last one, `force`. Once
/// `ticks` no longer grows it is a low-pass filter with a time constant of that many ticks.
fn mean_including(mean: Force, force: Force, ticks: u32) -> Force {
    let ticks = NonZeroU32::new(ticks).unwrap_or(NonZeroU32::MIN);
    let part = Force::from_bits((force.max(mean) - force.min(mean)).to_bits() / ticks);
    if force >= mean {
        mean.saturating_add(part)
    } else {
        mean.saturating_sub(part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_averages_noise_and_takes_a_step_at_once() {
        let mut mean = ForceMean::new(Force::lit("2"));
        for i in 0..500 {
            let noisy = if i % 2 == 0 {
                Force::lit("2.01")
            } else {
                Force::lit("1.99")
            };
            assert_eq!(mean.add_tick(noisy), ForceChange::Noise);
        }
        mean.add_tick(Force::lit("2"));
        let error = mean.mean().to_num::<f64>() - 2.0;
        assert!(error.abs() < 5e-4, "{error}");
        assert_eq!(mean.add_tick(Force::lit("1")), ForceChange::New);
        assert_eq!(mean.mean(), Force::lit("1"));
    }
}
