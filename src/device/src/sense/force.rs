//! The force sensor: sums to newtons, zero tracking, and detection of a finger's contact.

use contact_model::fixed_point::{Force, Fraction, saturating_product, to_fixed};
use fixed::types::I18F14;

use thermal_settings::ForceSensor;

/// Force, N, from which the signal counts as off its zero: a finger may be landing. Noise of 0.7 to 1.2 counts a
/// conversion is 0.6 to 1.1 mN here.
const OFF_ZERO_FROM: Force = Force::lit("0.003");
/// Force, N, from which on a contact begins, provided that the force has been at least [`OFF_ZERO_FROM`] for
/// [`CONTACT_DEBOUNCE_TICKS`] ticks, so that one noisy tick begins no contact.
const CONTACT_BEGINS_FROM: Force = Force::lit("0.02");
/// Force, N, below which a finger that touches has lifted; half of that at which it begins (hysteresis), so that noise
/// does not end a light contact.
const CONTACT_ENDS_BELOW: Force = Force::lit("0.01");
/// Sum of 16 conversions above which the force sensor's wire counts as shorted to the supply: 4060 of 4095 counts,
/// where the converter's range ends. The station then trips.
const SHORTED_WIRE_ABOVE: u16 = 4060 * 16;
/// Ticks of 1 ms for which the force must be off its zero before a contact begins, or below its threshold before a
/// contact ends.
const CONTACT_DEBOUNCE_TICKS: u32 = 2;
/// Largest time, ticks of 1 ms, by which the detection of a contact is dated back to when the force left its zero. A
/// force that has been off its zero for longer rose too slowly to tell when the finger landed.
const DATED_RISE_MAX_TICKS: u32 = 32;

/// Largest difference, N, of the tracked zero from that of the settings: 2 % of it, and 2 % of the reference. A smaller
/// force that is there from switch-on is taken for zero.
const ZERO_CHANGE_MAX_N: f64 = 0.06;
/// Ticks after switch-on over which the zero is the plain mean of the signal. Only ticks count in which nothing touches
/// and the signal is within 0.06 N of the stored zero.
const INITIAL_ZERO_TICKS: i32 = 256;
/// Time constant, as a power of two of ticks (1 s), with which the zero then tracks a signal within 3 mN of it.
const AT_ZERO_TRACKING_SHIFT: u32 = 10;
/// Time constant, as a power of two of ticks (16 s), with which the zero tracks a signal that is off it, yet below the
/// force of a contact: slower, because it may be a finger.
const OFF_ZERO_TRACKING_SHIFT: u32 = 14;

/// A sum of 16 conversions, or its zero, with 14 binary places, at which slow tracking does not stop by rounding; the
/// largest sum fits.
type FineSum = I18F14;

/// Converts the signal of a linear force sensor with a live zero, which is tracked while nothing touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ForceChannel {
    /// Sum of 16 conversions below which the sensor's wire counts as broken: half of the zero.
    broken_below: u16,
    /// Sum of 16 conversions without force; follows the signal slowly while nothing touches.
    zero: FineSum,
    /// Smallest signal that is still tracked as zero: 0.06 N below that of the settings.
    min_zero: FineSum,
    /// Largest signal that is still tracked as zero: 0.06 N above that of the settings.
    max_zero: FineSum,
    /// Ticks since switch-on of which the zero is the mean, up to [`INITIAL_ZERO_TICKS`]; then the zero is tracked.
    initial_ticks: i32,
    /// Force, N, that one unit of the sensor's sum of 16 conversions stands for.
    n_per_unit: Fraction,
}

impl ForceChannel {
    /// Converts zero and sensitivity from the settings in `f64`, so it is for start-up and not for the tick.
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

    /// Force, N, for the sum of 16 conversions; 0 below the zero. `None`: the wire is broken or shorted, because the
    /// sum is below half of the settings' zero or at the end of the converter's range.
    #[must_use]
    pub fn force_of_sum(&self, sum: u16) -> Option<Force> {
        if sum < self.broken_below || sum > SHORTED_WIRE_ABOVE {
            return None;
        }
        let change = FineSum::from(sum).saturating_sub(self.zero);
        let above_zero = change.max(FineSum::ZERO);
        Some(saturating_product(above_zero, self.n_per_unit))
    }

    /// Moves the zero towards the sum of a tick in which nothing touches, more slowly if the force is off the zero. A
    /// sum more than 0.06 N from the settings' zero is ignored.
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

/// Detects from the force whether a finger touches the display, with debouncing and hysteresis, and since when.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactDetector {
    /// Whether a finger touches the display, after debouncing.
    touching: bool,
    /// Ticks of 1 ms for which the force has been off its zero, up to [`DATED_RISE_MAX_TICKS`]; holds its value during
    /// a contact.
    off_zero_ticks: u32,
    /// Ticks of 1 ms for which the force has been below [`CONTACT_ENDS_BELOW`] during a contact.
    release_ticks: u32,
}

impl ContactDetector {
    /// Takes the force of one tick, N, and decides whether a finger touches.
    ///
    /// A contact begins at 20 mN and ends below 10 mN. It begins in the second tick off zero at the earliest, and ends
    /// in the second tick below, so that one noisy tick does neither.
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

    /// Whether a finger touches the display, since the force of the last tick.
    #[must_use]
    pub const fn touching(&self) -> bool {
        self.touching
    }

    /// Whether the force is 3 mN or more, in the last tick or, during a contact, when it began; the zero is then
    /// tracked more slowly.
    #[must_use]
    pub const fn is_off_zero(&self) -> bool {
        self.off_zero_ticks > 0
    }

    /// Whether the force has been off its zero for two ticks, which noise seldom causes: a finger may be landing. The
    /// self-test takes it for a touch.
    #[must_use]
    pub const fn may_be_landing(&self) -> bool {
        self.off_zero_ticks >= CONTACT_DEBOUNCE_TICKS
    }

    /// Ticks of 1 ms from a landing, when the force left its zero, to its detection, 2 to 32; of use in the first tick
    /// of a contact.
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
