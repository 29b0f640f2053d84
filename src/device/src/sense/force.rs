//! The force sensor: sums to newtons, zero tracking, and detection of a finger's contact.

use contact_model::fixed_point::{Force, Fraction, saturating_product, to_fixed};
use fixed::types::I18F14;

use thermal_settings::ForceSensor;

/// From this force on the signal counts as off its zero. Noise of 0.7 to 1.2 counts a conversion is 0.6 to 1.1 mN here.
const OFF_ZERO_FROM: Force = Force::lit("0.003");
/// A contact begins from the first force on and ends below the second (hysteresis).
const CONTACT_BEGINS_FROM: Force = Force::lit("0.02");
const CONTACT_ENDS_BELOW: Force = Force::lit("0.01");
/// Sum beyond which the signal is at the end of the converter's range.
const SHORTED_WIRE_ABOVE: u16 = 4060 * 16;
/// Ticks for which a change must last.
const CONTACT_DEBOUNCE_TICKS: u32 = 2;
/// A signal that has been off its zero for longer, ticks, rose too slowly to tell when the finger landed.
const DATED_RISE_MAX_TICKS: u32 = 32;

/// Largest difference of the zero from that of the settings: 2 % of it, and 2 % of the reference. A smaller force that is
/// there from switch-on is taken for zero.
const ZERO_CHANGE_MAX_N: f64 = 0.06;
/// Ticks after switch-on whose mean is the first zero, whatever the signal.
const INITIAL_ZERO_TICKS: i32 = 256;
/// Time constants with which the zero then tracks a signal at its zero (1 s) and one off its zero (16 s), as powers of two
/// of ticks.
const AT_ZERO_TRACKING_SHIFT: u32 = 10;
const OFF_ZERO_TRACKING_SHIFT: u32 = 14;

/// A sum of conversions, or its zero, at a resolution at which slow tracking does not stop; the largest sum fits.
type FineSum = I18F14;

/// Converts the signal of a linear sensor with a live zero, which is tracked while nothing touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ForceChannel {
    /// Sum below which the wire is broken.
    broken_below: u16,
    zero: FineSum,
    min_zero: FineSum,
    max_zero: FineSum,
    /// Ticks of which the zero is the mean, until it is tracked.
    initial_ticks: i32,
    n_per_unit: Fraction,
}

impl ForceChannel {
    /// Converts the settings from `f64`: for set-up, not for the tick.
    #[must_use]
    pub fn new(settings: &ForceSensor) -> Self {
        let zero = settings.zero_counts * 16.0;
        let max_change = ZERO_CHANGE_MAX_N * settings.counts_per_n * 16.0;
        let fine = |sum| FineSum::from_bits(libm::ldexp(sum, FineSum::FRAC_NBITS as i32) as i32);
        Self {
            broken_below: (zero / 2.0) as u16,
            zero: fine(zero),
            min_zero: fine(zero - max_change),
            max_zero: fine(zero + max_change),
            initial_ticks: 0,
            n_per_unit: to_fixed(1.0 / (settings.counts_per_n * 16.0)),
        }
    }

    /// Force for the sum of 16 conversions; 0 below the zero. `None`: the wire is broken or shorted, because the signal is
    /// below half of its live zero or at the end of the range.
    #[must_use]
    pub fn force_of_sum(&self, sum: u16) -> Option<Force> {
        if sum < self.broken_below || sum > SHORTED_WIRE_ABOVE {
            return None;
        }
        let change = FineSum::from(sum).saturating_sub(self.zero);
        let above_zero = change.max(FineSum::ZERO);
        Some(saturating_product(above_zero, self.n_per_unit))
    }

    /// Tracks the zero by the sum of a tick in which nothing touches, slower if its force is off the zero.
    pub fn track_zero(&mut self, sum: u16, is_off_zero: bool) {
        let sum = FineSum::from(sum);
        if !(self.min_zero..=self.max_zero).contains(&sum) {
            return;
        }
        let error = sum.saturating_sub(self.zero);
        self.zero += if self.initial_ticks < INITIAL_ZERO_TICKS {
            self.initial_ticks += 1;
            error.checked_div_int(self.initial_ticks).unwrap_or(error)
        } else {
            let shifts = [AT_ZERO_TRACKING_SHIFT, OFF_ZERO_TRACKING_SHIFT];
            error >> shifts[usize::from(is_off_zero)]
        };
    }
}

/// Debounced contact of a finger, with hysteresis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactDetector {
    touching: bool,
    /// Ticks for which the force has been off its zero, up to [`DATED_RISE_MAX_TICKS`]; holds its value during a contact.
    off_zero_ticks: u32,
    /// Ticks for which the force has been below [`CONTACT_ENDS_BELOW`] during a contact.
    release_ticks: u32,
}

impl ContactDetector {
    /// Updates the contact by the force of one tick.
    ///
    /// A contact begins in the second tick off zero at the earliest, so that one noisy tick does not begin one.
    pub fn update_contact(&mut self, force: Force) {
        if self.touching {
            let low = force < CONTACT_ENDS_BELOW;
            self.release_ticks = if low { self.release_ticks + 1 } else { 0 };
            if self.release_ticks == CONTACT_DEBOUNCE_TICKS {
                *self = Self::default();
            }
        } else {
            self.off_zero_ticks = if force >= OFF_ZERO_FROM {
                (self.off_zero_ticks + 1).min(DATED_RISE_MAX_TICKS)
            } else {
                0
            };
            self.touching = self.may_be_landing() && force >= CONTACT_BEGINS_FROM;
        }
    }

    /// A finger touches.
    #[must_use]
    pub const fn touching(&self) -> bool {
        self.touching
    }

    /// The force is off its zero.
    #[must_use]
    pub const fn is_off_zero(&self) -> bool {
        self.off_zero_ticks > 0
    }

    /// The force has been off its zero for the debounce time, which noise seldom causes: a finger may be landing.
    #[must_use]
    pub const fn may_be_landing(&self) -> bool {
        self.off_zero_ticks >= CONTACT_DEBOUNCE_TICKS
    }

    /// Ticks from a landing, when the force left its zero, to its detection: 2 to 32.
    #[must_use]
    pub const fn detection_delay_ticks(&self) -> u32 {
        self.off_zero_ticks
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_settings::Settings;

    #[test]
    fn force_is_linear_above_the_live_zero_and_none_with_a_broken_wire() {
        let channel = ForceChannel::new(&Settings::default().force);
        for (counts, newton) in [(410.0, 0.0), (440.0, 0.1), (1010.0, 2.0), (3410.0, 10.0)] {
            let force = channel
                .force_of_sum((counts * 16.0) as u16)
                .expect("in range")
                .to_num::<f64>();
            assert!(
                (force - newton).abs() < 1e-5 * newton.max(1e-3),
                "{newton}: {force}"
            );
        }
        assert_eq!(
            channel.force_of_sum(300 * 16).expect("in range"),
            Force::ZERO
        );
        assert_eq!(channel.force_of_sum(100 * 16), None);
        assert_eq!(channel.force_of_sum(4095 * 16), None);
    }

    /// The sum of one tick for a steady signal.
    fn sum(counts: f64) -> u16 {
        (counts * 16.0) as u16
    }

    #[test]
    fn the_zero_is_found_at_switch_on_and_tracks_a_drift() {
        let mut channel = ForceChannel::new(&Settings::default().force);
        for _ in 0..INITIAL_ZERO_TICKS {
            channel.track_zero(sum(418.0), true);
        }
        assert_eq!(channel.force_of_sum(sum(418.0)), Some(Force::ZERO));
        // 0.03 counts a second for ten minutes.
        for second in 0..600 {
            for _ in 0..1000 {
                channel.track_zero(sum(418.0 - 0.03 * f64::from(second)), false);
            }
        }
        let force = channel
            .force_of_sum(sum(400.0 + 30.0))
            .expect("in range")
            .to_num::<f64>();
        assert!((force - 0.1).abs() < 5e-4, "{force}");
    }

    /// Exponential with a time constant of 16.4 s: 0.01 N for 2 s moves the zero by an eighth of it.
    #[test]
    fn a_small_force_of_2_s_moves_the_zero_by_an_eighth_of_it() {
        let mut channel = ForceChannel::new(&Settings::default().force);
        for _ in 0..INITIAL_ZERO_TICKS {
            channel.track_zero(sum(410.0), false);
        }
        for _ in 0..2000 {
            channel.track_zero(sum(413.0), true);
        }
        let force = channel
            .force_of_sum(sum(413.0))
            .expect("in range")
            .to_num::<f64>();
        let expected = 0.01 * (-2000.0 / 16384.0f64).exp();
        assert!(
            (force - expected).abs() < 1e-4,
            "{force}, expected {expected}"
        );
    }

    #[test]
    fn a_force_of_70_mn_from_switch_on_is_not_taken_for_zero() {
        let mut channel = ForceChannel::new(&Settings::default().force);
        for _ in 0..10_000 {
            channel.track_zero(sum(431.0), false);
        }
        let force = channel
            .force_of_sum(sum(431.0))
            .expect("in range")
            .to_num::<f64>();
        assert!((force - 0.07).abs() < 1e-5, "{force}");
    }

    #[test]
    fn one_noisy_tick_neither_begins_nor_ends_a_contact() {
        let (mut detector, high, low) =
            (ContactDetector::default(), Force::lit("0.1"), Force::ZERO);
        for force in [high, low, high, low] {
            detector.update_contact(force);
            assert!(!detector.touching());
        }
        detector.update_contact(high);
        detector.update_contact(high);
        assert!(detector.touching());
        detector.update_contact(low);
        detector.update_contact(high);
        assert!(detector.touching());
        detector.update_contact(low);
        detector.update_contact(low);
        assert!(!detector.touching());
    }

    #[test]
    fn a_landing_is_dated_back_to_when_the_force_left_its_zero() {
        for (rise, delay_ticks) in [
            (&["0.5", "0.9"][..], 2),
            (&["0.001", "0.005", "0.02"], 2),
            (&["0.005", "0.011", "0.016", "0.02"], 4),
            (&["0.005", "0.001", "0.004", "0.03"], 2),
        ] {
            let mut detector = ContactDetector::default();
            for (i, force) in rise.iter().enumerate() {
                assert!(!detector.touching(), "{rise:?}, tick {i}");
                detector.update_contact(Force::from_str(force).expect("a force"));
            }
            assert!(detector.touching(), "{rise:?}");
            assert_eq!(detector.detection_delay_ticks(), delay_ticks, "{rise:?}");
        }
    }
}
