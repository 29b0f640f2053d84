//! Force counts to newtons, and whether a finger touches.

use contact_model::fixed_point::Force;

use crate::settings::ForceSensor;

/// A finger has landed from this force on, and has lifted below the second.
const LANDED_FROM: Force = Force::lit("0.04");
const LIFTED_BELOW: Force = Force::lit("0.02");
/// Sum beyond which the signal is at the end of the converter's range.
const TOP: u16 = 4060 * 16;
/// Ticks for which a change must last.
const DEBOUNCE_TICKS: u32 = 2;

/// Linear sensor with a live zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForceScale {
    zero: u16,
    /// Force of one unit of the sum, in 2^-32 N.
    per_unit: u32,
}

impl ForceScale {
    /// `f64`, once.
    #[must_use]
    pub fn new(settings: &ForceSensor) -> Self {
        let scale = libm::round(libm::ldexp(1.0, 32) / (settings.counts_per_n * 16.0));
        Self {
            zero: (settings.zero_counts * 16.0) as u16,
            per_unit: scale as u32,
        }
    }

    /// Force for the sum of 16 conversions; nothing below zero force. `None`: the signal is below half of
    /// its live zero or at the end of the range, a broken or shorted wire.
    #[must_use]
    pub fn force(&self, sum: u16) -> Option<Force> {
        if sum < self.zero / 2 || sum > TOP {
            return None;
        }
        let beyond = u64::from(sum.saturating_sub(self.zero));
        Some(Force::from_bits(
            ((beyond * u64::from(self.per_unit)) >> 8).min(u64::from(u32::MAX)) as u32,
        ))
    }
}

/// Debounced contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Touch {
    touching: bool,
    /// Ticks for which the force has said otherwise.
    contrary: u32,
}

impl Touch {
    /// Takes the force of one tick.
    pub fn update(&mut self, force: Force) {
        let says = if self.touching {
            force >= LIFTED_BELOW
        } else {
            force >= LANDED_FROM
        };
        if says == self.touching {
            self.contrary = 0;
        } else {
            self.contrary += 1;
            if self.contrary == DEBOUNCE_TICKS {
                self.touching = says;
                self.contrary = 0;
            }
        }
    }

    /// A finger touches.
    #[must_use]
    pub const fn touching(&self) -> bool {
        self.touching
    }

    /// Ticks that had passed at the moment of detection.
    #[must_use]
    pub const fn detection_ticks() -> u32 {
        DEBOUNCE_TICKS
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    #[test]
    fn force_is_linear_above_a_live_zero() {
        let scale = ForceScale::new(&Settings::default().force);
        for (counts, newton) in [(410.0, 0.0), (440.0, 0.1), (1010.0, 2.0), (3410.0, 10.0)] {
            let force = scale
                .force((counts * 16.0) as u16)
                .expect("in range")
                .to_num::<f64>();
            assert!(
                (force - newton).abs() < 1e-5 * newton.max(1e-3),
                "{newton}: {force}"
            );
        }
        assert_eq!(scale.force(300 * 16).expect("in range"), Force::ZERO);
        assert_eq!(scale.force(100 * 16), None);
        assert_eq!(scale.force(4095 * 16), None);
    }

    #[test]
    fn one_noisy_tick_neither_lands_nor_lifts() {
        let (mut touch, high, low) = (Touch::default(), Force::lit("0.1"), Force::ZERO);
        for force in [high, low, high, low] {
            touch.update(force);
            assert!(!touch.touching());
        }
        touch.update(high);
        touch.update(high);
        assert!(touch.touching());
        touch.update(low);
        touch.update(high);
        assert!(touch.touching());
        touch.update(low);
        touch.update(low);
        assert!(!touch.touching());
    }
}
