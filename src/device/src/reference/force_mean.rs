//! The mean of a steady force.

use core::num::NonZeroU32;
use core::ops::RangeInclusive;

use contact_model::fixed_point::{Celsius, Force};

/// A force this far from that of the last ticks is a new force, not noise: this part of it, and this much at least.
const NEW: Threshold = Threshold {
    shift: 4,
    floor: Force::lit("0.01"),
};
/// The same for the mean of the last ticks against the force in use: noise is smaller there.
const MOVED: Threshold = Threshold {
    shift: 11,
    floor: Force::lit("0.00025"),
};
/// Ticks that count as the last ones.
const LAST: u32 = 64;
/// The mean reaches back over this part of the time since the force was new, as a power of two, and within
/// `LAST` and `LONGEST` ticks. What a force has done to the set-point follows the logarithm of time, so late noise
/// may be averaged for longer.
const REACH_SHIFT: u32 = 2;
const LONGEST: u32 = 4096;
/// Ticks after which a mean is first better than the force it began with.
const FIRST_LOOK: u32 = 16;
/// Change of the set-point that matters.
const MATTERS: Celsius = Celsius::lit("0.0001");

/// A part of a force as a power of two, and an amount below which it does not fall.
struct Threshold {
    shift: u32,
    floor: Force,
}

impl Threshold {
    fn tells(&self, force: Force, from: Force) -> bool {
        force.max(from) - force.min(from) > (from >> self.shift).max(self.floor)
    }
}

/// Running mean that starts anew when the force changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ForceMean {
    /// Of the last ticks.
    recent: Force,
    mean: Force,
    in_use: Force,
    /// Ticks since the force was new; stops where the mean reaches back no further.
    ticks: u32,
}

/// What a tick's force is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    /// The same as before, and noise.
    Noise,
    /// The mean is not what it was in use for any more: it is better known, or drifts.
    Moved,
    /// A new force; the mean has started anew.
    New,
}

impl ForceMean {
    pub(super) const fn new(force: Force) -> Self {
        Self {
            recent: force,
            mean: force,
            in_use: force,
            ticks: 1,
        }
    }

    pub(super) const fn mean(&self) -> Force {
        self.mean
    }

    /// The mean that was last taken.
    pub(super) const fn in_use(&self) -> Force {
        self.in_use
    }

    /// Takes the mean into use.
    pub(super) const fn take(&mut self) {
        self.in_use = self.mean;
    }

    /// Whether the mean is worth a look: each time it has seen twice as much, and always once it has seen all that it
    /// reaches back over. In between it is hardly better than it was.
    pub(super) const fn is_better(&self) -> bool {
        self.ticks >= FIRST_LOOK && self.ticks.is_power_of_two()
    }

    /// Takes the force of one tick.
    pub(super) fn update(&mut self, force: Force) -> Change {
        if NEW.tells(force, self.recent) {
            *self = Self::new(force);
            return Change::New;
        }
        self.ticks = (self.ticks + 1).min(LONGEST << REACH_SHIFT);
        self.recent = towards(self.recent, force, self.ticks.min(LAST));
        self.mean = towards(
            self.mean,
            force,
            self.ticks.min(LAST.max(self.ticks >> REACH_SHIFT)),
        );
        if self.ticks >= LAST && MOVED.tells(self.recent, self.in_use) {
            self.mean = self.recent;
            self.ticks = LAST;
            return Change::Moved;
        }
        Change::Noise
    }
}

/// A mean over `ticks` (1 at least) after one more.
fn towards(mean: Force, force: Force, ticks: u32) -> Force {
    let ticks = NonZeroU32::new(ticks).unwrap_or(NonZeroU32::MIN);
    let part = Force::from_bits((force.max(mean) - force.min(mean)).to_bits() / ticks);
    if force >= mean {
        mean.saturating_add(part)
    } else {
        mean.saturating_sub(part)
    }
}

/// Forces around `force` for which contact resistance need not be computed again, where `gain` is what `E` is
/// multiplied with in the set-point.
///
/// R moves by 0.95 of the force's relative change (Eq. 6-8), `E` by at most 0.277 of R's, and the set-point by
/// `gain` times as much: 0.264 in all, rounded up to 17/64.
pub(super) fn all_the_same(force: Force, gain: Celsius) -> RangeInclusive<Force> {
    // Of a gain in 2^-14 K, rounded up, so that one short division holds the part of the force, in 2^-29.
    const PART: u32 = (((MATTERS.to_bits() as u64 * 64) << (29 - GAIN_SHIFT)) / 17) as u32;
    const GAIN_SHIFT: u32 = 8;
    let gain = gain.to_bits().unsigned_abs().div_ceil(1 << GAIN_SHIFT);
    let allowed = PART
        .checked_div(gain)
        .and_then(|part| u32::try_from((u64::from(force.to_bits()) * u64::from(part)) >> 29).ok())
        .map_or(Force::MAX, Force::from_bits);
    force.saturating_sub(allowed)..=force.saturating_add(allowed)
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
    fn what_is_the_same_is_so_to_a_tenth_of_a_millikelvin() {
        for (name, material) in MATERIALS {
            for force_n in [0.1, 0.5, 2.0] {
                let contact = |force_n| {
                    let pressure_pa = pressure::pressure_pa(2.0) * force_n / 2.0;
                    Contact::<f64>::new(
                        (&SKIN, 34.0),
                        (&material, 24.0),
                        &REFERENCE_DISPLAY,
                        pressure_pa,
                    )
                };
                let gain = Celsius::from_num(10.0 * (contact(1.0).weight - contact(1.0).ratio));
                let before = Force::from_num(force_n);
                let same = all_the_same(before, gain.abs());
                let relative = (1..4000).find(|&i| {
                    let now = Force::from_num(force_n * (1.0 + f64::from(i) / 65536.0));
                    !same.contains(&now)
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
