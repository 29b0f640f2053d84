//! The thermal dose that a course would give.

use contact_model::fixed_point::{Celsius, exp2};

use super::CoursePoint;
use crate::safety::PredictedDose;
use crate::safety::limits::DOSE_REFERENCE_TEMPERATURE;

/// Longest part of a segment, K, whose dose is computed from its two ends. The weight of the dose is convex in the
/// temperature, so the mean of the ends is too large, here by at most 0.25 %.
const PART_K: Celsius = Celsius::lit("0.125");

/// A time at the largest temperature of a course that gives the dose of the course, in units of 2^-8 ms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EquivalentTime(u32);

impl EquivalentTime {
    /// No time.
    pub const ZERO: Self = Self(0);

    /// The dose of this time at a temperature, °C, of at most 43 °C.
    pub fn at(self, largest: Celsius) -> PredictedDose {
        let weight = weight_below(DOSE_REFERENCE_TEMPERATURE.saturating_sub(largest));
        PredictedDose::from_sum(((u64::from(self.0) * weight) >> 32) as u32)
    }
}

/// Weight of a temperature that is this much, K, below a reference of at most 43 °C, relative to that of the reference:
/// `4^-below` in units of 2^-32.
#[inline(never)]
fn weight_below(below: Celsius) -> u64 {
    let exponent = -(i64::from(below.to_bits().max(0)) << (33 - Celsius::FRAC_NBITS));
    let whole = (exponent >> 32).unsigned_abs().min(63);
    ((1u64 << 32) + u64::from(exp2(exponent as u32))) >> whole
}

/// Time at `largest`, °C, the largest temperature of these points, that gives their dose. Temperatures below `counted_from`
/// give none. An upper bound that is too large by at most 0.25 % and 2^-8 ms for each point.
pub fn time_equivalent_to_largest(
    points: &[CoursePoint],
    largest: Celsius,
    counted_from: Celsius,
) -> EquivalentTime {
    let mut sum = 0;
    let mut add = |from: Celsius, to: Celsius, duration_ms: u32| {
        sum += equivalent_time_of_segment((from, to), duration_ms.into(), largest, counted_from);
    };
    if let Some(first) = points.first() {
        add(first.temperature, first.temperature, first.time_ms);
    }
    for pair in points.windows(2) {
        if let [from, to] = pair {
            add(from.temperature, to.temperature, to.time_ms.saturating_sub(from.time_ms));
        }
    }
    EquivalentTime(u32::try_from(sum).unwrap_or(u32::MAX))
}

/// The same of a straight line between two temperatures, in units of 2^-8 ms.
#[inline(never)]
fn equivalent_time_of_segment(
    (from, to): (Celsius, Celsius),
    duration_ms: u64,
    largest: Celsius,
    counted_from: Celsius,
) -> u64 {
    let (low, high) = (from.min(to), from.max(to));
    if high < counted_from {
        return 0;
    }
    let counted_low = low.max(counted_from);
    let counted = u64::from(high.abs_diff(counted_low).to_bits());
    let duration_q8 = match u64::from(high.abs_diff(low).to_bits()) {
        0 => duration_ms << 8,
        way => ((duration_ms << 8) * counted).div_ceil(way),
    };
    let parts = counted / u64::from(PART_K.to_bits().unsigned_abs()) + 1;
    let weight_at = |part: u64| {
        let below_high = (counted * part / parts) as i32;
        let at = high.saturating_sub(Celsius::from_bits(below_high));
        weight_below(largest.saturating_sub(at))
    };
    let doubled: u64 = (0..parts).map(|part| weight_at(part) + weight_at(part + 1)).sum();
    // The mean weight is below 2^33, and the duration below 2^31.
    ((doubled / (2 * parts)) * duration_q8).div_ceil(1 << 32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(time_s: f64, celsius: f64) -> CoursePoint {
        CoursePoint { time_ms: (1e3 * time_s) as u32, temperature: Celsius::from_num(celsius) }
    }

    /// CEM43 of a line from `a` to `b`, °C, above 39 °C and below 43 °C, in seconds: the integral of `4^(T - 43)`.
    fn closed_form_s(a: f64, b: f64, duration_s: f64) -> f64 {
        let (low, high) = (a.min(b), a.max(b));
        if high < 39.0 {
            return 0.0;
        }
        if high == low {
            return duration_s * libm::exp2(2.0 * (high - 43.0));
        }
        let counted = low.max(39.0);
        let weight = |celsius: f64| libm::exp2(2.0 * (celsius - 43.0));
        duration_s * (weight(high) - weight(counted)) / (2.0 * libm::log(2.0) * (high - low))
    }

    #[test]
    fn the_dose_of_a_course_is_that_of_the_closed_form() {
        let courses: [&[(f64, f64)]; 6] = [
            &[(0.0, 42.0), (100.0, 42.0)],
            &[(0.0, 39.0), (100.0, 39.0)],
            &[(0.0, 33.0), (9.0, 42.0), (30.0, 42.0), (40.0, 30.0)],
            &[(0.0, 15.0), (1000.0, 42.0), (2000.0, 15.0)],
            &[(5.0, 41.0), (6.0, 41.5), (7.0, 40.2), (500.0, 40.9)],
            &[(0.0, 30.0), (3600.0, 38.9)],
        ];
        for course in courses {
            let points: std::vec::Vec<_> = course.iter().map(|&(t, c)| point(t, c)).collect();
            let largest_c = course.iter().fold(0.0, |max: f64, one| max.max(one.1));
            let largest = Celsius::from_num(largest_c);
            let predicted = time_equivalent_to_largest(&points, largest, Celsius::lit("39"));
            let predicted_s = f64::from(predicted.at(largest).milliseconds_at_43()) / 1e3;
            let first = course[0];
            let before_s = closed_form_s(first.1, first.1, first.0);
            let exact_s: f64 = before_s
                + course
                    .windows(2)
                    .map(|pair| closed_form_s(pair[0].1, pair[1].1, pair[1].0 - pair[0].0))
                    .sum::<f64>();
            let error_s = predicted_s - exact_s;
            assert!(
                (-0.0011..0.003 * exact_s + 0.002).contains(&error_s),
                "{course:?}: {predicted_s}, {exact_s}"
            );
        }
    }

    #[test]
    fn weights_are_powers_of_four() {
        for below_k in [0.0, 0.5, 1.0, 2.3, 4.0, 30.0] {
            let weight = weight_below(Celsius::from_num(below_k)) as f64 / 4_294_967_296.0;
            let exact = libm::exp2(-2.0 * below_k);
            assert!((weight / exact - 1.0).abs() < 1e-5 || weight < 1e-9, "{below_k}: {weight}");
        }
    }
}
