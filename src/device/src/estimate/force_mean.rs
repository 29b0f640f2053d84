//! Running mean of the force, which starts again when the force changes.

use core::num::NonZeroU32;

use contact_model::fixed_point::Force;

/// A force that differs from the recent mean by more than this has changed; less is noise.
const NEW_FORCE_THRESHOLD: ForceThreshold = ForceThreshold {
    shift: 4,
    floor: Force::lit("0.01"),
};
/// A recent mean that differs from the force in use by more than this has drifted; its noise is smaller than a tick's.
const DRIFT_THRESHOLD: ForceThreshold = ForceThreshold {
    shift: 11,
    floor: Force::lit("0.00025"),
};
/// Ticks of the recent mean.
const RECENT_MEAN_TICKS: u32 = 64;
/// The mean reaches back over this part, as a power of two, of the time since the force changed, and over
/// `RECENT_MEAN_TICKS` to `LONGEST_MEAN_TICKS`. The set-point depends on the logarithm of time, so late noise may be averaged longer.
const AVERAGED_PART_SHIFT: u32 = 2;
const LONGEST_MEAN_TICKS: u32 = 4096;
/// Ticks after a change until the mean is first more accurate than the force that it began with.
const FIRST_USEFUL_MEAN_TICKS: u32 = 16;

/// The larger of a relative difference, as a power of two, and an absolute one.
struct ForceThreshold {
    shift: u32,
    floor: Force,
}

impl ForceThreshold {
    fn is_exceeded(&self, force: Force, from: Force) -> bool {
        force.max(from) - force.min(from) > (from >> self.shift).max(self.floor)
    }
}

/// Running mean of a force, N, and the mean for which set-points are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForceMean {
    /// Mean of the recent ticks.
    recent: Force,
    mean: Force,
    in_use: Force,
    /// Ticks since the force changed; stops where the mean reaches back no further.
    ticks: u32,
}

/// How a tick's force differs from those before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceChange {
    /// The force differs from its mean by no more than noise.
    Noise,
    /// The mean differs from the force in use: it is more accurate, or the force drifts.
    Drifted,
    /// A new force; the mean has started again.
    New,
}

impl ForceMean {
    /// A mean of one tick.
    #[must_use]
    pub const fn new(force: Force) -> Self {
        Self {
            recent: force,
            mean: force,
            in_use: force,
            ticks: 1,
        }
    }

    /// Mean force since it changed last, N.
    #[must_use]
    pub const fn mean(&self) -> Force {
        self.mean
    }

    /// The mean at the last call of [`Self::use_present_mean`].
    #[must_use]
    pub const fn mean_in_use(&self) -> Force {
        self.in_use
    }

    /// Takes the mean into use.
    pub const fn use_present_mean(&mut self) {
        self.in_use = self.mean;
    }

    /// Whether the mean covers twice as many ticks as when this was last true, or all that it reaches back over. In between
    /// it is hardly more accurate.
    #[must_use]
    pub const fn has_doubled_ticks(&self) -> bool {
        self.ticks >= FIRST_USEFUL_MEAN_TICKS && self.ticks.is_power_of_two()
    }

    /// Takes the force of one tick.
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

/// The mean of `ticks` values (1 at least), the last of which is `force`.
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
