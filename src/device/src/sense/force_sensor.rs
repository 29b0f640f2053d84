//! The force sensor: conversion of its sums to newtons, and tracking of its zero.

use contact_model::fixed_point::{Force, Fraction, saturating_product, to_fixed, truncated_units};
use fixed::types::I18F14;

use thermal_settings::ForceSensor;

use crate::safety::UpDownDebounceCounter;

/// Largest valid sum of 16 conversions of the force sensor: 4060 of 4095 counts a conversion. Above it the sensor's
/// wire counts as shorted to the supply, and the station trips.
const FORCE_SHORTED_ABOVE_SUM: u16 = 4060 * 16;
/// Ticks of 1 ms, 30, by which those with an invalid signal must outnumber those with a valid one until the wire counts as broken or
/// shorted. A stack of 0.5 kg that rings at 41 Hz after a finger of 5 N has lifted is below half of the live zero for up to 11 ms
/// of each 24.
const INVALID_SIGNAL_DEBOUNCE_TICKS: u8 = 30;
/// Force, N, below the zero that noise does not reach: the stack on the load cell swings, or the zero has moved.
const BELOW_ZERO_N: f64 = 0.008;

/// Largest difference, N, between the force sensor's tracked zero and the zero in the settings. Covers a sensor whose
/// zero of 410 counts is off by 2 % (0.027 N), a reference voltage that is off by 2 % (as much again), and a drift of 0.15 N. A
/// smaller force that is present from switch-on is taken for the zero, until it ends.
const FORCE_ZERO_TRACKING_RANGE_N: f64 = 0.21;
/// Ticks of 1 ms after switch-on over which the force sensor's zero is the plain mean of its sums; afterwards the zero
/// is tracked by a low-pass filter. Only ticks count in which no finger touches and the signal is within 0.21 N of the
/// zero in the settings.
const INITIAL_ZERO_MEAN_TICKS: i32 = 256;
/// Time constant, as a power of two of ticks of 1 ms (2^8, 0.26 s), of the low-pass filter by which the force sensor's
/// zero tracks the signal while the force is below 3 mN.
const FAST_ZERO_TRACKING_TICKS_LOG2: u32 = 8;
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
    /// Smallest sum of 16 conversions that the sensor's tracked zero follows: 0.21 N below the zero in the settings. A
    /// smaller sum leaves the zero unchanged.
    min_zero: FineForceSum,
    /// Largest sum of 16 conversions that the sensor's tracked zero follows: 0.21 N above the zero in the settings. A
    /// larger sum leaves the zero unchanged.
    max_zero: FineForceSum,
    /// Number of ticks of 1 ms, 0 to 256, from which the zero has been computed as their plain mean so far. From
    /// [`INITIAL_ZERO_MEAN_TICKS`] (256) on, this number stays, and the zero is tracked by a low-pass filter.
    initial_ticks: i32,
    /// Sum of 16 conversions that corresponds to -8 mN.
    below_zero: FineForceSum,
    is_below_zero: bool,
    invalid_signal: UpDownDebounceCounter,
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
            below_zero: fine(-BELOW_ZERO_N * settings.counts_per_n * 16.0),
            is_below_zero: false,
            invalid_signal: UpDownDebounceCounter::default(),
            n_per_unit: to_fixed(1.0 / (settings.counts_per_n * 16.0)),
        }
    }

    /// Force on the display, N, for a sum of 16 conversions; 0 for a sum below the tracked zero. To be called in each tick. `None` if the
    /// sensor's wire is broken (sum below half of the zero in the settings) or shorted (more than 4060 counts a conversion), once
    /// this has lasted for 30 ticks; until then the force of the nearest valid sum.
    pub fn force_of_sum(&mut self, sum: u16) -> Option<Force> {
        if sum < self.broken_below || sum > FORCE_SHORTED_ABOVE_SUM {
            return self.force_of_invalid_signal(sum);
        }
        if self.invalid_signal != UpDownDebounceCounter::default() {
            self.invalid_signal.count(false, INVALID_SIGNAL_DEBOUNCE_TICKS);
        }
        Some(self.force_of_valid_sum(sum))
    }

    #[inline(always)]
    fn force_of_valid_sum(&mut self, sum: u16) -> Force {
        let change = FineForceSum::from(sum).saturating_sub(self.zero);
        self.is_below_zero = change < self.below_zero;
        saturating_product(change.max(FineForceSum::ZERO), self.n_per_unit)
    }

    #[cold]
    #[inline(never)]
    fn force_of_invalid_signal(&mut self, sum: u16) -> Option<Force> {
        let is_broken = self.invalid_signal.count(true, INVALID_SIGNAL_DEBOUNCE_TICKS);
        let nearest = sum.max(self.broken_below).min(FORCE_SHORTED_ABOVE_SUM);
        (!is_broken).then(|| self.force_of_valid_sum(nearest))
    }

    /// Whether the sum of the last tick was below the zero by more than 8 mN, which noise is not.
    pub const fn is_below_zero(&self) -> bool {
        self.is_below_zero
    }

    /// Takes the coming sums for the zero, as after switch-on.
    pub const fn restart_zero(&mut self) {
        self.initial_ticks = 0;
    }

    /// Moves the zero towards `sum`, the sum of 16 conversions of a tick in which no finger touches: the first 256
    /// times as their plain mean, later with a time constant of 0.26 s, or of 16 s if the force `may_be_of_finger`. Ignores a
    /// sum that is more than 0.21 N from the zero in the settings.
    pub fn track_zero(&mut self, sum: u16, may_be_of_finger: bool) {
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
            error >> shifts[usize::from(may_be_of_finger)]
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_settings::Settings;

    #[test]
    fn force_is_linear_above_the_live_zero_and_none_with_a_broken_wire() {
        let mut channel = ForceChannel::new(&Settings::default().force);
        for (counts, newton) in [(410.0, 0.0), (440.0, 0.1), (1010.0, 2.0), (3410.0, 10.0)] {
            let force =
                channel.force_of_sum((counts * 16.0) as u16).expect("in range").to_num::<f64>();
            assert!((force - newton).abs() < 1e-5 * newton.max(1e-3), "{newton}: {force}");
        }
        assert_eq!(channel.force_of_sum(300 * 16).expect("in range"), Force::ZERO);
        assert!(channel.is_below_zero());
    }

    /// 30 ticks more invalid than valid ones; an oscillation that spends less than half of its time there is none.
    #[test]
    fn a_wire_is_broken_or_shorted_after_30_ms_and_meanwhile_shows_the_nearest_valid_force() {
        for (invalid, nearest_n) in [(sum(100.0), 0.0), (sum(4095.0), (4060.0 - 410.0) / 300.0)] {
            let mut channel = ForceChannel::new(&Settings::default().force);
            let one_newton = channel.force_of_sum(sum(710.0));
            for tick in 1..60 {
                let force_n = channel.force_of_sum(invalid).map(|force| force.to_num::<f64>());
                assert_eq!(force_n.is_some(), tick < 30, "tick {tick}");
                assert!(force_n.is_none_or(|force_n| (force_n - nearest_n).abs() < 1e-4));
            }
            assert_eq!(channel.force_of_sum(sum(710.0)), one_newton, "connected again");
            let mut channel = ForceChannel::new(&Settings::default().force);
            for tick in 0..1000 {
                let swings = if tick % 24 < 11 { invalid } else { sum(710.0) };
                assert!(channel.force_of_sum(swings).is_some(), "tick {tick}");
            }
        }
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
    fn a_force_of_220_mn_from_switch_on_is_not_taken_for_zero() {
        let mut channel = ForceChannel::new(&Settings::default().force);
        for _ in 0..10_000 {
            channel.track_zero(sum(476.0), false);
        }
        let force = channel.force_of_sum(sum(476.0)).expect("in range").to_num::<f64>();
        assert!((force - 0.22).abs() < 1e-5, "{force}");
    }
}
