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

/// Whether contact resistance must be computed again after a change of the mean from `before`: the set-point
/// could move by more than 0.1 mK, at the time at which `E` is most sensitive.
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
    use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
    use contact_model::pressure;
    use contact_model::reference::Contact;

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

    /// By Eq. 6-12 in `f64`: the smallest change that matters moves the set-point by 0.1 mK, at the worst time.
    #[test]
    fn what_matters_is_a_tenth_of_a_millikelvin() {
        for (name, material) in MATERIALS {
            for force_n in [0.1, 0.5, 2.0] {
                let contact = |force_n| {
                    let pressure_pa = pressure::pressure_pa(2.0) * force_n / 2.0;
                    Contact::<f64>::new((&SKIN, 34.0), (&material, 24.0), &REFERENCE_DISPLAY, pressure_pa)
                };
                let gain = Celsius::from_num(10.0 * (contact(1.0).weight - contact(1.0).ratio));
                let before = Force::from_num(force_n);
                let relative = (1..4000).find(|&i| {
                    let now = Force::from_num(force_n * (1.0 + f64::from(i) / 65536.0));
                    matters(now, before, gain.abs())
                });
                let relative = f64::from(relative.expect("some change matters")) / 65536.0;
                let (old, new) = (contact(force_n), contact(force_n * (1.0 + relative)));
                let moved_k = (-200..200)
                    .map(|i| (f64::from(i) / 10.0).exp2())
                    .map(|t_s| (old.at(t_s).display_c - new.at(t_s).display_c).abs())
                    .fold(0.0, f64::max);
                // The grid of changes is 0.25 K per 65536.
                let grid_k = gain.abs().to_num::<f64>() / 65536.0;
                assert!(
                    moved_k < 0.1e-3 + grid_k && moved_k > 0.09e-3,
                    "{name}, {force_n} N: {moved_k} K"
                );
            }
        }
    }
}
