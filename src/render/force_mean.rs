//! The mean of a steady force.

use contact_model::fixed_point::Force;

/// Ticks over which the mean reaches back.
const WINDOW: u32 = 64;
/// A force this far from the mean is a new force, not noise.
const NEW_FORCE_FLOOR: Force = Force::lit("0.01");
const NEW_FORCE_SHIFT: u32 = 4;
/// Relative change that changes the set-point by about 1 mK per 10 K: R by 2^-9 moves E by at most 5e-4.
const MATTERS_SHIFT: u32 = 9;

/// Running mean that starts anew when the force changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ForceMean {
    mean: Force,
    ticks: u32,
}

impl ForceMean {
    pub(super) const fn new(force: Force) -> Self {
        Self {
            mean: force,
            ticks: 0,
        }
    }

    /// Takes the force of one tick, gives the mean.
    pub(super) fn update(&mut self, force: Force) -> Force {
        let (low, high) = (force.min(self.mean), force.max(self.mean));
        if high - low > (self.mean >> NEW_FORCE_SHIFT).max(NEW_FORCE_FLOOR) {
            *self = Self {
                mean: force,
                ticks: 1,
            };
            return force;
        }
        self.ticks = (self.ticks + 1).min(WINDOW);
        let part = Force::from_bits((high - low).to_bits() / self.ticks);
        self.mean = if force >= self.mean {
            self.mean.saturating_add(part)
        } else {
            self.mean.saturating_sub(part)
        };
        self.mean
    }

    /// Whether contact resistance must be computed again after a change from `before`.
    pub(super) fn matters(now: Force, before: Force) -> bool {
        now.max(before) - now.min(before) > before >> MATTERS_SHIFT
    }
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
            mean.update(noisy);
        }
        let error = mean.update(Force::lit("2")).to_num::<f64>() - 2.0;
        assert!(error.abs() < 5e-4, "{error}");
        assert_eq!(mean.update(Force::lit("1")), Force::lit("1"));
    }
}
