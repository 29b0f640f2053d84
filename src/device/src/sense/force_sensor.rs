//! The force sensor: conversion of its sums to newtons, tracking of its zero, and detection of a finger's contact.

use contact_model::fixed_point::{Force, Fraction, saturating_product, to_fixed, truncated_units};
use fixed::types::I18F14;

use thermal_settings::ForceSensor;

/// Smallest force, N, that counts as off zero: a finger may be landing. Noise is smaller: 0.7 to 1.2 counts RMS a
/// conversion make about 0.6 to 1 mN RMS in the force of a tick.
const NONZERO_FORCE_MIN: Force = Force::lit("0.003");
/// Smallest force, N, at which a contact begins. The force must also have been off zero, at least
/// [`NONZERO_FORCE_MIN`], for [`CONTACT_DEBOUNCE_TICKS`] ticks in a row, so that one noisy tick begins no contact.
const CONTACT_BEGIN_FORCE: Force = Force::lit("0.02");
/// Force, N, below which a contact ends. It is half of the force at which a contact begins (hysteresis), so that noise
/// does not end a light contact.
const CONTACT_END_FORCE: Force = Force::lit("0.01");
/// Largest valid sum of 16 conversions of the force sensor: 4060 of 4095 counts a conversion. Above it the sensor's
/// wire counts as shorted to the supply, and the station trips.
const FORCE_SHORTED_ABOVE_SUM: u16 = 4060 * 16;
/// Ticks of 1 ms in a row, 2, in which the force must be off zero (3 mN or more) before a contact begins, or below 10
/// mN before a contact ends. So one noisy tick neither begins nor ends a contact.
pub const CONTACT_DEBOUNCE_TICKS: u32 = 2;
/// Upper limit, ticks of 1 ms, of the counted delay from the tick in which the force left zero to the detection of a
/// contact. The estimate of the finger dates the landing back by the counted delay. A force that takes longer to rise
/// does not show when the finger landed.
const COUNTED_DETECTION_DELAY_MAX_TICKS: u32 = 32;

/// Largest difference, N, between the force sensor's tracked zero and the zero in the settings. Covers a sensor whose
/// zero of 410 counts is off by 2 % (0.027 N), and a reference voltage that is off by 2 % (as much again). A smaller
/// force that is present from switch-on is taken for the zero.
const FORCE_ZERO_TRACKING_RANGE_N: f64 = 0.06;
/// Ticks of 1 ms after switch-on over which the force sensor's zero is the plain mean of its sums; afterwards the zero
/// is tracked by a low-pass filter. Only ticks count in which no finger touches and the signal is within 0.06 N of the
/// zero in the settings.
const INITIAL_ZERO_MEAN_TICKS: i32 = 256;
/// Time constant, as a power of two of ticks of 1 ms (2^10, 1 s), of the low-pass filter by which the force sensor's
/// zero tracks the signal while the force is below 3 mN.
const FAST_ZERO_TRACKING_TICKS_LOG2: u32 = 10;
/// Time constant, as a power of two of ticks of 1 ms (2^14, 16 s), of the low-pass filter by which the force sensor's
/// zero tracks the signal while the force is 3 mN or more but no contact is detected. Slow, because the force may be
/// that of a finger.
const SLOW_ZERO_TRACKING_TICKS_LOG2: u32 = 14;

/// A sum of 16 conversions of the force sensor with 14 fractional bits, range ±131072. At this resolution a difference
/// of one unit of the sum still moves the sensor's zero when the zero is tracked with the time constant of 2^14 ticks.
type FineForceSum = I18F14;

/// Converts the sums of a linear force sensor to newtons. The sensor's output without force, its zero, is well above 0
/// counts and may drift; it is tracked while no finger touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ForceChannel {
    /// Sum of 16 conversions below which the sensor's wire counts as broken: half of the zero in the settings.
    broken_below: u16,
    /// The sensor's tracked zero: sum of 16 conversions without force. Starts at the zero in the settings, and follows
    /// the signal while no finger touches: as the plain mean of the first 256 ticks, then through a low-pass filter.
    zero: FineForceSum,
    /// Smallest sum of 16 conversions that the sensor's tracked zero follows: 0.06 N below the zero in the settings. A
    /// smaller sum leaves the zero unchanged.
    min_zero: FineForceSum,
    /// Largest sum of 16 conversions that the sensor's tracked zero follows: 0.06 N above the zero in the settings. A
    /// larger sum leaves the zero unchanged.
    max_zero: FineForceSum,
    /// Number of ticks of 1 ms, 0 to 256, from which the zero has been computed as their plain mean so far. From
    /// [`INITIAL_ZERO_MEAN_TICKS`] (256) on, this number stays, and the zero is tracked by a low-pass filter.
    initial_ticks: i32,
    /// Force, N, per unit of the sensor's sum of 16 conversions; nominally 1/4800 N.
    n_per_unit: Fraction,
}

impl ForceChannel {
    /// A channel with zero and sensitivity of the force sensor from the settings. Computes in `f64`, so it is for
    /// start-up and not for the control tick.
    pub fn new(settings: &ForceSensor) -> Self {
        let zero = settings.zero_counts * 16.0;
        let max_change = FORCE_ZERO_TRACKING_RANGE_N * settings.counts_per_n * 16.0;
        let fine = |sum| FineForceSum::from_bits(truncated_units(sum, FineForceSum::FRAC_NBITS));
        Self {
            broken_below: (zero / 2.0) as u16,
            zero: fine(zero),
            min_zero: fine(zero - max_change),
            max_zero: fine(zero + max_change),
            initial_ticks: 0,
            n_per_unit: to_fixed(1.0 / (settings.counts_per_n * 16.0)),
        }
    }

    /// Force on the display, N, for a sum of 16 conversions; 0 for a sum below the tracked zero. `None` if the sensor's
    /// wire is broken (sum below half of the zero in the settings) or shorted (more than 4060 counts a conversion).
    pub fn force_of_sum(&self, sum: u16) -> Option<Force> {
        if sum < self.broken_below || sum > FORCE_SHORTED_ABOVE_SUM {
            return None;
        }
        let change = FineForceSum::from(sum).saturating_sub(self.zero);
        let above_zero = change.max(FineForceSum::ZERO);
        Some(saturating_product(above_zero, self.n_per_unit))
    }

    /// Moves the zero towards `sum`, the sum of 16 conversions of a tick in which no finger touches: the first 256
    /// times as their plain mean, later with a time constant of 1 s, or of 16 s if the force `is_force_nonzero`. Ignores a
    /// sum that is more than 0.06 N from the zero in the settings.
    pub fn track_zero(&mut self, sum: u16, is_force_nonzero: bool) {
        let sum = FineForceSum::from(sum);
        if !(self.min_zero..=self.max_zero).contains(&sum) {
            return;
        }
        let error = sum.saturating_sub(self.zero);
        self.zero += if self.initial_ticks < INITIAL_ZERO_MEAN_TICKS {
            self.initial_ticks += 1;
            error.checked_div_int(self.initial_ticks).unwrap_or(error)
        } else {
            let shifts = [FAST_ZERO_TRACKING_TICKS_LOG2, SLOW_ZERO_TRACKING_TICKS_LOG2];
            error >> shifts[usize::from(is_force_nonzero)]
        };
    }
}

/// Detects from the force whether a finger touches the display, with debouncing and hysteresis, and counts for how many
/// ticks the force had been off zero when it detected the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactDetector {
    touching: bool,
    /// Number of ticks of 1 ms in a row in which the force has been off zero (3 mN or more), up to
    /// [`COUNTED_DETECTION_DELAY_MAX_TICKS`]. During a contact it keeps its value from the contact's detection.
    off_zero_ticks: u32,
    /// Number of ticks of 1 ms in a row, during a contact, in which the force has been below [`CONTACT_END_FORCE`].
    release_ticks: u32,
}

impl ContactDetector {
    /// Decides from the force of this tick, N, whether a finger touches the display. To be called in each tick with
    /// valid readings; other ticks do not count.
    ///
    /// A contact begins at 20 mN or more, at the earliest in the second tick in a row with 3 mN or more. It ends in the
    /// second tick in a row below 10 mN. So one noisy tick neither begins nor ends a contact.
    pub fn update_contact(&mut self, force: Force) {
        if self.touching {
            let low = force < CONTACT_END_FORCE;
            self.release_ticks = if low { self.release_ticks + 1 } else { 0 };
            if self.release_ticks == CONTACT_DEBOUNCE_TICKS {
                *self = Self::default();
            }
        } else {
            self.off_zero_ticks = if force >= NONZERO_FORCE_MIN {
                (self.off_zero_ticks + 1).min(COUNTED_DETECTION_DELAY_MAX_TICKS)
            } else {
                0
            };
            self.touching = self.is_force_nonzero_debounced() && force >= CONTACT_BEGIN_FORCE;
        }
    }

    /// Whether a finger touches the display, after debouncing, as of the last call of [`Self::update_contact`].
    pub const fn touching(&self) -> bool {
        self.touching
    }

    /// Whether the force of the last call of [`Self::update_contact`] was off zero, 3 mN or more. Always true during a
    /// contact; false in the call that ends a contact. While it is true without a contact, the force may be that of a
    /// finger, so the zero of the force sensor is tracked with a time constant of 16 s instead of 1 s.
    pub const fn is_force_nonzero(&self) -> bool {
        self.off_zero_ticks > 0
    }

    /// Whether the force has been off zero (3 mN or more) for at least two ticks in a row, which noise seldom causes: a
    /// finger may be landing. Stays true during a contact. The self-test treats this like a contact, and measures its
    /// baseline again.
    pub const fn is_force_nonzero_debounced(&self) -> bool {
        self.off_zero_ticks >= CONTACT_DEBOUNCE_TICKS
    }

    /// Delay of the contact's detection, ticks of 1 ms, 2 to 32: for how long the force had been off zero when the
    /// contact was detected. By this delay the estimate of the finger dates the landing back. Meaningful only while a
    /// finger touches.
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
            let force =
                channel.force_of_sum((counts * 16.0) as u16).expect("in range").to_num::<f64>();
            assert!((force - newton).abs() < 1e-5 * newton.max(1e-3), "{newton}: {force}");
        }
        assert_eq!(channel.force_of_sum(300 * 16).expect("in range"), Force::ZERO);
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
        for _ in 0..INITIAL_ZERO_MEAN_TICKS {
            channel.track_zero(sum(418.0), true);
        }
        assert_eq!(channel.force_of_sum(sum(418.0)), Some(Force::ZERO));
        // 0.03 counts a second for ten minutes.
        for second in 0..600 {
            for _ in 0..1000 {
                channel.track_zero(sum(418.0 - 0.03 * f64::from(second)), false);
            }
        }
        let force = channel.force_of_sum(sum(400.0 + 30.0)).expect("in range").to_num::<f64>();
        assert!((force - 0.1).abs() < 5e-4, "{force}");
    }

    /// Exponential with a time constant of 16.4 s: 0.01 N for 2 s moves the zero by an eighth of it.
    #[test]
    fn a_small_force_of_2_s_moves_the_zero_by_an_eighth_of_it() {
        let mut channel = ForceChannel::new(&Settings::default().force);
        for _ in 0..INITIAL_ZERO_MEAN_TICKS {
            channel.track_zero(sum(410.0), false);
        }
        for _ in 0..2000 {
            channel.track_zero(sum(413.0), true);
        }
        let force = channel.force_of_sum(sum(413.0)).expect("in range").to_num::<f64>();
        let expected = 0.01 * (-2000.0 / 16384.0f64).exp();
        assert!((force - expected).abs() < 1e-4, "{force}, expected {expected}");
    }

    #[test]
    fn a_force_of_70_mn_from_switch_on_is_not_taken_for_zero() {
        let mut channel = ForceChannel::new(&Settings::default().force);
        for _ in 0..10_000 {
            channel.track_zero(sum(431.0), false);
        }
        let force = channel.force_of_sum(sum(431.0)).expect("in range").to_num::<f64>();
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
