//! The mean of a steady force.

use contact_model::fixed_point::{Celsius, Force};

/// A force this far from the mean is a new force, not noise.
const NEW_FORCE_FLOOR: Force = Force::lit("0.01");
const NEW_FORCE_SHIFT: u32 = 4;
/// The mean reaches back over this part of the time since the force was new, as a power of two, and within
/// these limits in ticks. What a force has done to the set-point follows the logarithm of time, so late noise
/// may be averaged for longer.
const REACH_SHIFT: u32 = 2;
const SHORTEST: u32 = 64;
const LONGEST: u32 = 4096;
/// Change of the set-point that matters.
const MATTERS: Celsius = Celsius::lit("0.0001");

/// Running mean that starts anew when the force changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ForceMean {
    mean: Force,
    /// Ticks since the force was new; stops where the mean reaches back no further.
    ticks: u32,
}

/// What a tick's force is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    /// The same as before, and noise.
    Noise,
    /// A new force, which is the mean from now on.
    New,
}

impl ForceMean {
    pub(super) const fn new(force: Force) -> Self {
        Self {
            mean: force,
            ticks: 1,
        }
    }

    pub(super) const fn mean(&self) -> Force {
        self.mean
    }

    /// Takes the force of one tick.
    pub(super) fn update(&mut self, force: Force) -> Change {
        let (low, high) = (force.min(self.mean), force.max(self.mean));
        if high - low > (self.mean >> NEW_FORCE_SHIFT).max(NEW_FORCE_FLOOR) {
            *self = Self::new(force);
            return Change::New;
        }
        self.ticks = (self.ticks + 1).min(LONGEST << REACH_SHIFT);
        let reach = self.ticks.min(SHORTEST.max(self.ticks >> REACH_SHIFT));
        let part = Force::from_bits((high - low).to_bits() / reach);
        self.mean = if force >= self.mean {
            self.mean.saturating_add(part)
        } else {
            self.mean.saturating_sub(part)
        };
        Change::Noise
    }
}

/// Whether contact resistance must be computed again after a change of the mean from `before`.
///
/// R moves by 0.95 of the force's relative change (Eq. 6-8), `E` by at most 0.277 of R's, and the set-point by
/// `gain` times as much: 0.264 in all, rounded up.
pub(super) fn matters(now: Force, before: Force, gain: Celsius) -> bool {
    let change =
        u64::from((now.max(before) - now.min(before)).to_bits()) * u64::from(gain.to_bits().unsigned_abs());
    change * 17 > u64::from(before.to_bits()) * (u64::from(MATTERS.to_bits().unsigned_abs()) * 64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_averages_noise_and_follows_steps_at_once() {
        let mut mean = ForceMean::new(Force::lit("2"));
        for i in 0..500 {
            let noisy = if i % 2 == 0 {
                Force::lit("2.01")
            } else {
                Force::lit("1.99")
            };
            assert_eq!(mean.update(noisy), Change::Noise);
        }
        mean.update(Force::lit("2"));
        let error = mean.mean().to_num::<f64>() - 2.0;
        assert!(error.abs() < 5e-4, "{error}");
        assert_eq!(mean.update(Force::lit("1")), Change::New);
        assert_eq!(mean.mean(), Force::lit("1"));
    }
}
