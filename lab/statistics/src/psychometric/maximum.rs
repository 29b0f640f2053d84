//! The most likely psychometric function.
//!
//! The likelihood may have several maxima, and its least upper bound may be that of a step or of a constant, which no finite,
//! positive slope has: the data then do not determine the slope. So Newton's method, with Fisher's scoring where it fails, climbs
//! from the best places of a grid, and the best of the maxima is compared with those limits.

use super::{Line, Model, Point, Shape, term};

/// By how much more likely, as a difference of logarithms, a function must be than each step and each constant.
const MARGIN: f64 = 1e-6;
/// Slopes of the grid, powers of two on the standardised scale: from nearly level to a step between two of ten levels.
const SLOPE_EXPONENTS: std::ops::RangeInclusive<i32> = -2..=6;
/// Arguments of `G` of the grid at a level, and most levels at which it has them.
const ARGUMENTS: [f64; 4] = [-2.5, -1.2, -0.3, 0.6];
const PLACES_MAX: usize = 8;
/// Gain of a step of log-likelihood below which a first climb ends; the best one goes on.
const GAIN: f64 = 1e-5;
/// Slope from which a function is a step for all levels, and climbing ends.
const SLOPE_MAX: f64 = 1e4;

/// A line and its log-likelihood.
type Found = (Line, f64);

impl Model {
    /// The most likely line that rises; `None` if steps or constants are as likely.
    pub(super) fn maximise(&self, start: Line, points: &[Point]) -> Option<Line> {
        let (line, likelihood) = self.best_maximum(start, points)?;
        (likelihood > self.limit(points) + MARGIN).then_some(line)
    }

    /// Least upper bound of the log-likelihood.
    pub(super) fn supremum(&self, start: Line, points: &[Point]) -> f64 {
        let limit = self.limit(points);
        self.best_maximum(start, points).map_or(limit, |(_, maximum)| maximum.max(limit))
    }

    /// Largest log-likelihood of a step, which rises between two levels or at one of them, and of a constant.
    fn limit(&self, points: &[Point]) -> f64 {
        let (low, high) = (self.guess, 1.0 - self.lapse);
        let at = |&(_, correct, wrong): &Point, p: f64| term(correct, p) + term(wrong, 1.0 - p);
        let likely = |correct: f64, wrong: f64| (correct / (correct + wrong)).clamp(low, high);
        let (correct, wrong) =
            points.iter().fold((0.0, 0.0), |(k, w), point| (k + point.1, w + point.2));
        let constant = likely(correct, wrong);
        let of_constant = points.iter().map(|point| at(point, constant)).sum();
        // Sums of the levels below the step and above it.
        let mut below = 0.0;
        let mut above: Vec<f64> = points
            .iter()
            .rev()
            .scan(0.0, |sum, point| {
                let of_higher = *sum;
                *sum += at(point, high);
                Some(of_higher)
            })
            .collect();
        let steps = points.iter().map(|point| {
            let step = below + at(point, likely(point.1, point.2)) + above.pop().unwrap_or(0.0);
            below += at(point, low);
            step
        });
        steps.fold(of_constant, f64::max)
    }

    /// The most likely of the maxima that are reached from the peaks of a grid of slopes and levels, and from the best of each slope.
    fn best_maximum(&self, start: Line, points: &[Point]) -> Option<Found> {
        let every = points.len().div_ceil(PLACES_MAX);
        let likeliest = |found: &mut dyn Iterator<Item = Found>| {
            found.max_by(|one, other| one.1.total_cmp(&other.1))
        };
        let of_slope = |exponent: i32| -> Vec<Found> {
            let slope = 2f64.powi(exponent);
            let places = points.iter().step_by(every).map(|point| point.0);
            let at = |x: f64| {
                let lines = ARGUMENTS.map(|z| Line { intercept: z - slope * x, slope, ..start });
                let mut found =
                    lines.into_iter().map(|line| (line, self.log_likelihood(&line, points)));
                likeliest(&mut found)
            };
            places.filter_map(at).collect()
        };
        let grid: Vec<Vec<Found>> = SLOPE_EXPONENTS.map(of_slope).collect();
        let is_peak = |slope: usize, place: usize| {
            let neighbours = [
                (slope.wrapping_sub(1), place),
                (slope + 1, place),
                (slope, place.wrapping_sub(1)),
                (slope, place + 1),
            ];
            let at = |(slope, place): (usize, usize)| grid.get(slope)?.get(place);
            neighbours.into_iter().filter_map(at).all(|found| found.1 <= grid[slope][place].1)
        };
        let starts = grid.iter().enumerate().flat_map(|(slope, row)| {
            let best = likeliest(&mut row.iter().copied()).map(|(_, likelihood)| likelihood);
            let is_start =
                move |place: &usize| Some(row[*place].1) == best || is_peak(slope, *place);
            (0..row.len()).filter(is_start).map(|place| row[place])
        });
        let climbs = starts.filter_map(|found| self.climb(found, points, GAIN));
        let mut climbs: Vec<Found> = climbs.collect();
        climbs.sort_by(|one, other| other.1.total_cmp(&one.1));
        climbs.into_iter().find_map(|found| self.climb(found, points, 0.0))
    }

    /// The maximum that is reached by steps, or where one gains less than `gain`; `None` if the slope leaves the
    /// range from 0 to a step.
    fn climb(&self, (mut line, mut best): Found, points: &[Point], gain: f64) -> Option<Found> {
        const ITERATIONS_MAX: u32 = 500;
        const HALVINGS_MAX: u32 = 12;
        for _ in 0..ITERATIONS_MAX {
            let ([of_a, of_b], expected) = self.score(&line, points);
            let observed = self.observed_information(&line, points);
            let determinant = |[aa, bb, ab]: [f64; 3]| aa * bb - ab * ab;
            // Newton's method where the likelihood is concave, otherwise Fisher's scoring, which climbs everywhere.
            let is_concave = observed[0] > 0.0 && determinant(observed) > 0.0;
            let [aa, bb, ab] = if is_concave { observed } else { expected };
            let determinant = determinant([aa, bb, ab]);
            let step_a = (bb * of_a - ab * of_b) / determinant;
            let step_b = (aa * of_b - ab * of_a) / determinant;
            if !(step_a.is_finite() && step_b.is_finite() && line.slope < SLOPE_MAX) {
                return None;
            }
            let size = step_a.abs().max(step_b.abs());
            let scale = 1.0 + line.intercept.abs() + line.slope.abs();
            if size < 1e-12 * scale {
                return Some((line, best));
            }
            let mut part = 1.0;
            let better = (0..HALVINGS_MAX).find_map(|_| {
                let (intercept, slope) =
                    (line.intercept + part * step_a, line.slope + part * step_b);
                part *= 0.5;
                let tried = Line { intercept, slope, ..line };
                let reached = self.log_likelihood(&tried, points);
                (slope > 0.0 && reached > best).then_some((tried, reached))
            });
            match better {
                Some(found) if found.1 < best + gain => return Some(found),
                Some(found) => (line, best) = found,
                // The likelihood is level to rounding. Far from its maximum it is not.
                None if size < 1e-5 * scale => return Some((line, best)),
                None => return None,
            }
        }
        None
    }

    /// Observed information: the negative second derivatives of the log-likelihood by intercept and slope, in the order of those of
    /// the expected one.
    fn observed_information(&self, line: &Line, points: &[Point]) -> [f64; 3] {
        let mut information = [0.0; 3];
        for &(x, correct, wrong) in points {
            let z = line.at(x);
            let (p, q, derivative) = self.probabilities(z);
            if derivative == 0.0 || p * q == 0.0 {
                continue;
            }
            let second = derivative * self.shape.density_change(z);
            let of_correct = (derivative / p) * (derivative / p) - second / p;
            let of_wrong = (derivative / q) * (derivative / q) + second / q;
            let weight = correct * of_correct + wrong * of_wrong;
            information[0] += weight;
            information[1] += weight * x * x;
            information[2] += weight * x;
        }
        information
    }
}

impl Shape {
    /// Derivative of the logarithm of the density of `G`.
    fn density_change(self, z: f64) -> f64 {
        match self {
            Self::Weibull => 1.0 - z.exp(),
            Self::CumulativeNormal => -z,
        }
    }
}
