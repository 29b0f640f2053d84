//! Equal steps of positions that are printed more coarsely than they were measured.

/// Largest unit of the last digit, as a fraction of the usual step, with which a gap is told from a rounded step.
const COARSEST_OF_GAPS: f64 = 0.25;
/// Half a unit of the last digit, as a fraction of the unit, and the rounding of `f64` where a position is exactly between two
/// digits.
const HALF: f64 = 0.5 + 1e-6;
/// Ternary sections of the range of the step, each by a third: to 1e-14 of the range.
const SECTIONS: usize = 80;

/// Equal steps that stand in place of the printed positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EqualSteps {
    /// Length of a step, m.
    pub step_m: f64,
    /// Largest error of this length, m.
    pub uncertainty_m: f64,
    /// Unit of the last printed digit of the positions, m.
    pub unit_m: f64,
}

/// Equidistant positions, m, of which the printed ones are within half a unit of their last digit; points may be missing.
pub(super) fn recognise(x_m: &[f64], unit_m: &[f64]) -> Option<(Vec<f64>, EqualSteps)> {
    let every = (0..x_m.len()).map(|place| place as f64).collect();
    let places = [Some(every), with_gaps(x_m, unit_m)];
    places.into_iter().flatten().find_map(|places| fit(x_m, unit_m, &places))
}

/// Number of each point, where points may be missing; none if the digits are too coarse to see which.
fn with_gaps(x_m: &[f64], unit_m: &[f64]) -> Option<Vec<f64>> {
    let steps_m = || x_m.windows(2).map(|x| x[1] - x[0]);
    let mut sorted: Vec<f64> = steps_m().collect();
    sorted.sort_by(f64::total_cmp);
    let median_m = *sorted.get(sorted.len() / 2)?;
    // The median is a printed step, whose rounding would add up over a long gap; the mean of those without a gap hardly has it.
    let single = || sorted.iter().filter(|step_m| (0.5..1.5).contains(&(**step_m / median_m)));
    let usual_m = single().sum::<f64>() / single().count() as f64;
    let shows_gaps = coarsest(unit_m) <= COARSEST_OF_GAPS * usual_m;
    let mut places = vec![0.0];
    for step_m in steps_m() {
        let advance = (step_m / usual_m).round();
        if !shows_gaps || advance < 1.0 {
            return None;
        }
        places.push(places[places.len() - 1] + advance);
    }
    Some(places)
}

/// The line through all intervals of half a unit around the printed positions that has the largest distance from their ends.
fn fit(x_m: &[f64], unit_m: &[f64], places: &[f64]) -> Option<(Vec<f64>, EqualSteps)> {
    let last = x_m.len() - 1;
    let uncertainty_m = HALF * (unit_m[0] + unit_m[last]) / places[last];
    let mean_m = (x_m[last] - x_m[0]) / places[last];
    // Highest and lowest start with which no position is beyond half a unit.
    let starts = |step_m: f64| {
        let bounds = x_m.iter().zip(unit_m).zip(places).map(|((x, unit), place)| {
            let start = x - place * step_m;
            (start - HALF * unit, start + HALF * unit)
        });
        bounds.fold((f64::NEG_INFINITY, f64::INFINITY), |(lowest, highest), (low, high)| {
            (low.max(lowest), high.min(highest))
        })
    };
    let room = |step_m: f64| {
        let (lowest, highest) = starts(step_m);
        highest - lowest
    };
    // The room is a concave function of the step.
    let (mut low_m, mut high_m) = (mean_m - uncertainty_m, mean_m + uncertainty_m);
    for _ in 0..SECTIONS {
        let third_m = (high_m - low_m) / 3.0;
        if room(low_m + third_m) < room(high_m - third_m) {
            low_m += third_m;
        } else {
            high_m -= third_m;
        }
    }
    let step_m = 0.5 * (low_m + high_m);
    let (lowest, highest) = starts(step_m);
    let start_m = 0.5 * (lowest + highest);
    let positions = places.iter().map(|place| start_m + place * step_m).collect();
    let steps = EqualSteps { step_m, uncertainty_m, unit_m: coarsest(unit_m) };
    (highest >= lowest && step_m > 0.0).then_some((positions, steps))
}

/// The coarsest of the units.
pub(super) fn coarsest(units: &[f64]) -> f64 {
    units.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Positions n times a step, printed to a unit.
    fn rounded(places: impl Iterator<Item = u32>, step: f64, unit: f64) -> (Vec<f64>, Vec<f64>) {
        let x: Vec<f64> =
            places.map(|place| (f64::from(place) * step / unit).round() * unit).collect();
        let units = vec![unit; x.len()];
        (x, units)
    }

    #[test]
    fn steps_are_recognised_from_rounded_positions() {
        for (step, unit) in [(1.5625, 1.0), (1.0, 1.0), (1.01, 1.0), (0.7, 0.1), (3.3, 1e-3)] {
            let (x, units) = rounded(0..400, step, unit);
            let (positions, found) = recognise(&x, &units).expect("equal steps");
            assert!((found.step_m - step).abs() <= found.uncertainty_m, "{step} {unit}: {found:?}");
            assert!((found.uncertainty_m / (unit / 399.0) - 1.0).abs() < 1e-5);
            for (place, position) in positions.iter().enumerate() {
                let error = position - place as f64 * step;
                assert!(error.abs() <= unit, "{step} {unit} {place}: {error}");
            }
        }
    }

    #[test]
    fn missing_points_leave_a_gap_where_the_digits_show_it() {
        let present = || (0..200).filter(|place| ![7, 50, 51, 120].contains(place));
        let (x, units) = rounded(present(), 0.53, 0.1);
        let (positions, found) = recognise(&x, &units).expect("equal steps");
        assert!((found.step_m - 0.53).abs() <= found.uncertainty_m, "{found:?}");
        assert!((positions[7] - positions[6] - 2.0 * found.step_m).abs() < 1e-9);
        // A gap of 30 steps of 5.3 units, most of which are printed as 5.
        let with_long_gap = || (0..200).filter(|place| !(71..100).contains(place));
        let (x, units) = rounded(with_long_gap(), 0.53, 0.1);
        let (positions, found) = recognise(&x, &units).expect("equal steps");
        assert!((positions[71] - positions[70] - 30.0 * found.step_m).abs() < 1e-9);
        let (x, units) = rounded(present(), 1.53, 1.0);
        assert_eq!(recognise(&x, &units), None);
    }

    #[test]
    fn a_position_beyond_half_a_unit_is_not_of_equal_steps() {
        let (mut x, units) = rounded(0..40, 1.5625, 1.0);
        x[20] += 1.0;
        assert_eq!(recognise(&x, &units), None);
    }
}
