//! Force counts to newtons, the zero that drifts, and whether a finger touches.

use contact_model::fixed_point::Force;

use thermal_settings::ForceSensor;

/// The signal has left its zero. Noise of 0.7 to 1.2 counts a conversion is 0.6 to 1.1 mN here.
const LEFT_ZERO: Force = Force::lit("0.003");
/// A finger has landed from this force on, and has lifted below the second.
const LANDED_FROM: Force = Force::lit("0.02");
const LIFTED_BELOW: Force = Force::lit("0.01");
/// Sum beyond which the signal is at the end of the converter's range.
const TOP: u16 = 4060 * 16;
/// Ticks for which a change must last.
const DEBOUNCE_TICKS: u32 = 2;
/// Signals that left their zero longer ago than this, in ticks, rose too slowly to tell.
const LONGEST_RISE: u32 = 32;

/// How far the zero may be from that of the settings: 2 % of it, and 2 % of the reference. A finger that rests there from
/// switch-on with less is not seen.
const ZERO_WITHIN_N: f64 = 0.06;
/// Ticks after switch-on in which the zero is found, whatever the signal.
const FOUND_AFTER: i32 = 256;
/// Time constants with which it then follows a signal at rest and one that has left it, as powers of two of ticks (1 s,
/// 16 s).
const AT_REST_SHIFT: u32 = 10;
const LEFT_SHIFT: u32 = 14;
/// Binary places of the zero below one unit of a sum: the largest sum still fits.
const ZERO_BITS: u32 = 14;

/// Linear sensor with a live zero that is followed while nothing touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForceScale {
    /// Sum below which the wire is broken.
    broken_below: u16,
    /// Zero in 2^-14 of a sum's unit, and where it may be.
    zero: i32,
    least: i32,
    most: i32,
    /// Ticks of which it is the mean, until it is found.
    ticks: i32,
    /// Force of one unit of the sum, in 2^-32 N.
    per_unit: u32,
}

impl ForceScale {
    /// `f64`, once.
    #[must_use]
    pub fn new(settings: &ForceSensor) -> Self {
        let zero_sum = settings.zero_counts * 16.0;
        let within = ZERO_WITHIN_N * settings.counts_per_n * 16.0;
        let fine = |sum: f64| libm::ldexp(sum, ZERO_BITS as i32) as i32;
        let scale = libm::round(libm::ldexp(1.0, 32) / (settings.counts_per_n * 16.0));
        Self {
            broken_below: (zero_sum / 2.0) as u16,
            zero: fine(zero_sum),
            least: fine(zero_sum - within),
            most: fine(zero_sum + within),
            ticks: 0,
            per_unit: scale as u32,
        }
    }

    /// Force for the sum of 16 conversions; nothing below zero force. `None`: the signal is below half of
    /// its live zero or at the end of the range, a broken or shorted wire.
    #[must_use]
    pub fn force(&self, sum: u16) -> Option<Force> {
        if sum < self.broken_below || sum > TOP {
            return None;
        }
        let beyond = u64::from(fine(sum).saturating_sub(self.zero).max(0).unsigned_abs());
        // 30 bits times 32: no overflow.
        let bits = (beyond * u64::from(self.per_unit)) >> (8 + ZERO_BITS);
        Some(Force::from_bits(bits.min(u64::from(u32::MAX)) as u32))
    }

    /// Follows the zero by the sum of a tick in which nothing touches; `left`: its force has left the zero.
    pub fn follow_zero(&mut self, sum: u16, left: bool) {
        let at = fine(sum);
        if !(self.least..=self.most).contains(&at) {
            return;
        }
        let off = at.saturating_sub(self.zero);
        self.zero += if self.ticks < FOUND_AFTER {
            self.ticks += 1;
            off.checked_div(self.ticks).unwrap_or(off)
        } else {
            off >> if left { LEFT_SHIFT } else { AT_REST_SHIFT }
        };
    }
}

/// A sum in 2^-14 of its unit.
const fn fine(sum: u16) -> i32 {
    (sum as i32) << ZERO_BITS
}

/// Debounced contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Touch {
    touching: bool,
    /// Ticks for which the force has been off its zero, while nothing touches; then those at landing.
    off_zero: u32,
    /// Ticks for which the force has said that the finger lifted.
    lifted: u32,
}

impl Touch {
    /// Takes the force of one tick.
    ///
    /// A finger lands in the second tick off zero at the earliest, so one tick alone starts nothing.
    pub fn update(&mut self, force: Force) {
        if self.touching {
            self.lifted = if force < LIFTED_BELOW {
                self.lifted + 1
            } else {
                0
            };
            if self.lifted == DEBOUNCE_TICKS {
                *self = Self::default();
            }
        } else {
            self.off_zero = match force >= LEFT_ZERO {
                true => (self.off_zero + 1).min(LONGEST_RISE),
                false => 0,
            };
            self.touching = self.off_zero >= DEBOUNCE_TICKS && force >= LANDED_FROM;
        }
    }

    /// A finger touches.
    #[must_use]
    pub const fn touching(&self) -> bool {
        self.touching
    }

    /// The force is off its zero.
    #[must_use]
    pub const fn left_zero(&self) -> bool {
        self.off_zero > 0
    }

    /// The force has been off its zero for as long as a landing takes, which noise seldom is.
    #[must_use]
    pub const fn lands(&self) -> bool {
        self.off_zero >= DEBOUNCE_TICKS
    }

    /// How long ago the finger had landed when it was noticed, ticks, 2 to 32: since the force left its zero.
    #[must_use]
    pub const fn landed_ticks(&self) -> u32 {
        self.off_zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_settings::Settings;

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

    /// The sum of a tick at so many counts.
    fn sum(counts: f64) -> u16 {
        (counts * 16.0) as u16
    }

    #[test]
    fn zero_is_found_at_switch_on_and_followed_at_rest() {
        let mut scale = ForceScale::new(&Settings::default().force);
        for _ in 0..FOUND_AFTER {
            scale.follow_zero(sum(418.0), true);
        }
        assert_eq!(scale.force(sum(418.0)), Some(Force::ZERO));
        // 0.03 counts a second for ten minutes.
        for second in 0..600 {
            for _ in 0..1000 {
                scale.follow_zero(sum(418.0 - 0.03 * f64::from(second)), false);
            }
        }
        let force = scale
            .force(sum(400.0 + 30.0))
            .expect("in range")
            .to_num::<f64>();
        assert!((force - 0.1).abs() < 5e-4, "{force}");
    }

    /// By the exponential: off its zero by 0.01 N for 2 s, the zero has taken 2/16.4 of it.
    #[test]
    fn a_signal_off_its_zero_is_hardly_followed() {
        let mut scale = ForceScale::new(&Settings::default().force);
        for _ in 0..FOUND_AFTER {
            scale.follow_zero(sum(410.0), false);
        }
        for _ in 0..2000 {
            scale.follow_zero(sum(413.0), true);
        }
        let force = scale.force(sum(413.0)).expect("in range").to_num::<f64>();
        let expected = 0.01 * (-2000.0 / 16384.0f64).exp();
        assert!(
            (force - expected).abs() < 1e-4,
            "{force}, expected {expected}"
        );
    }

    #[test]
    fn a_finger_that_rests_there_from_switch_on_is_no_zero() {
        let mut scale = ForceScale::new(&Settings::default().force);
        for _ in 0..10_000 {
            scale.follow_zero(sum(431.0), false);
        }
        let force = scale.force(sum(431.0)).expect("in range").to_num::<f64>();
        assert!((force - 0.07).abs() < 1e-5, "{force}");
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

    #[test]
    fn landing_was_when_the_force_left_its_zero() {
        for (rise, landed_ticks) in [
            (&["0.5", "0.9"][..], 2),
            (&["0.001", "0.005", "0.02"], 2),
            (&["0.005", "0.011", "0.016", "0.02"], 4),
            (&["0.005", "0.001", "0.004", "0.03"], 2),
        ] {
            let mut touch = Touch::default();
            for (i, force) in rise.iter().enumerate() {
                assert!(!touch.touching(), "{rise:?}, tick {i}");
                touch.update(Force::from_str(force).expect("a force"));
            }
            assert!(touch.touching(), "{rise:?}");
            assert_eq!(touch.landed_ticks(), landed_ticks, "{rise:?}");
        }
    }
}
