//! Reduction of a course to a given number of its points, with the least largest error.

use super::{Course, CoursePoint};

/// Points among which those that stay are chosen; of a longer recording every second one, every third one and so on.
const CANDIDATES_MAX: usize = 20_000;
/// Tolerance within which the least error is found, K.
const RESOLUTION_K: f64 = 1e-7;

/// A course with fewer points.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// Some of the points, among them the first and the last.
    pub course: Course,
    /// Largest difference to the course as it was, K.
    pub error_k: f64,
}

/// Chooses at most `points_max` points (at least 2) of a course of up to 20 000 points so that its largest difference to the
/// line through them is the least of all choices, to 0.1 µK. Of a longer course every second point may be chosen, or
/// every third and so on.
///
/// A bisection over the tolerance; for each the shortest path from the first to the last point, where two points are joined if
/// the line between them passes all others within the tolerance. The cone of slopes that do so is narrowed from point to point,
/// so that each pair costs one division (Imai and Iri, 1986).
pub fn reduce(course: &Course, points_max: usize) -> Reduced {
    let points = course.points();
    let points_max = points_max.max(2);
    if points.len() <= points_max {
        return Reduced { course: course.clone(), error_k: 0.0 };
    }
    let candidates = thinned(points);
    let chosen = |indices: &[usize]| {
        let course = Course(indices.iter().map(|i| candidates[*i]).collect());
        let error_k = course.largest_difference_k(&Course(candidates.clone()));
        (course, error_k)
    };
    // The straight line from first to last has an error that no tolerance need exceed.
    let (mut best, mut too_much_k) = chosen(&[0, candidates.len() - 1]);
    let mut too_little_k = 0.0;
    if let Some(path) = shortest_path(&candidates, 0.0, points_max) {
        (best, too_much_k) = chosen(&path);
    }
    while too_much_k - too_little_k > RESOLUTION_K {
        let tolerance_k = 0.5 * (too_much_k + too_little_k);
        match shortest_path(&candidates, tolerance_k, points_max) {
            Some(path) => {
                let (course, error_k) = chosen(&path);
                best = course;
                too_much_k = error_k.min(tolerance_k);
            }
            None => too_little_k = tolerance_k,
        }
    }
    Reduced { error_k: best.largest_difference_k(course), course: best }
}

/// The points that may be chosen.
fn thinned(points: &[CoursePoint]) -> Vec<CoursePoint> {
    let every = points.len().div_ceil(CANDIDATES_MAX);
    let last = points.len() - 1;
    let kept = points.iter().enumerate();
    let kept = kept.filter(|(i, _)| i % every == 0 || *i == last);
    kept.map(|(_, point)| *point).collect()
}

/// Indices of the fewest points whose lines pass all others within the tolerance, K; `None` if they are more than `points_max`.
fn shortest_path(
    points: &[CoursePoint],
    tolerance_k: f64,
    points_max: usize,
) -> Option<Vec<usize>> {
    const UNREACHED: u32 = u32::MAX;
    let last = points.len() - 1;
    // Number of points on the shortest path to each, and the point before on it.
    let mut reached = vec![(UNREACHED, 0_usize); points.len()];
    reached[0].0 = 1;
    for i in 0..last {
        let length = reached[i].0;
        if length as usize >= points_max {
            continue;
        }
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for j in i + 1..=last {
            let inverse_span_s = 1.0 / (points[j].t_s - points[i].t_s);
            let slope = (points[j].celsius - points[i].celsius) * inverse_span_s;
            if low <= slope && slope <= high && length + 1 < reached[j].0 {
                reached[j] = (length + 1, i);
            }
            let half_cone = tolerance_k * inverse_span_s;
            low = low.max(slope - half_cone);
            high = high.min(slope + half_cone);
            if low > high {
                break;
            }
        }
    }
    if reached[last].0 as usize > points_max {
        return None;
    }
    let mut path = vec![last];
    let mut at = last;
    while at != 0 {
        at = reached[at].1;
        path.push(at);
    }
    path.reverse();
    Some(path)
}
