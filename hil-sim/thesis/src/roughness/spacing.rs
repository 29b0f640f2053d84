//! Profile elements and their mean spacing.

/// Least height of a peak or depth of a valley, as a fraction of `Rz` (ISO 4287).
const LEAST_HEIGHT: f64 = 0.1;
/// Number of lengths over which `Rz` is averaged (ISO 4288: five sampling lengths).
const LENGTHS: usize = 5;
/// Least width of a peak or valley, as a fraction of the mean spacing: 1 % of a sampling length (ISO 4287) of five
/// spacings.
const LEAST_WIDTH: f64 = 0.05;

/// Mean spacing of the elements of a levelled profile, m, if it has any.
pub(super) fn mean_m(x_m: &[f64], y_m: &[f64]) -> Option<f64> {
    let mut crossings = crossings(x_m, y_m, LEAST_HEIGHT * mean_height_m(x_m, y_m));
    let least_m = LEAST_WIDTH * spacing_m(&crossings)?;
    while let Some(narrow) = narrowest(&crossings, least_m) {
        // Removing it merges the portions beside it, which are on the same side of the mean line.
        crossings.drain(narrow..narrow + 2);
    }
    spacing_m(&crossings)
}

/// `Rz`, m.
fn mean_height_m(x_m: &[f64], y_m: &[f64]) -> f64 {
    let (start, length) = (x_m[0], x_m[x_m.len() - 1] - x_m[0]);
    let mut extremes = [(f64::INFINITY, f64::NEG_INFINITY); LENGTHS];
    for (x, &y) in x_m.iter().zip(y_m) {
        let part = ((x - start) / length * LENGTHS as f64) as usize;
        let (lowest, highest) = &mut extremes[part.min(LENGTHS - 1)];
        (*lowest, *highest) = (lowest.min(y), highest.max(y));
    }
    let heights = extremes.iter().map(|(lowest, highest)| (highest - lowest).max(0.0));
    heights.sum::<f64>() / LENGTHS as f64
}

/// Crossings of the mean line, m, alternately upward and downward: the last one between two points of opposite sign that
/// exceed `least_m`.
fn crossings(x_m: &[f64], y_m: &[f64], least_m: f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut last = x_m[0];
    let mut is_peak = None;
    for (x, y) in x_m.windows(2).zip(y_m.windows(2)) {
        if (y[0] <= 0.0 && y[1] > 0.0) || (y[0] >= 0.0 && y[1] < 0.0) {
            last = x[0] + (x[1] - x[0]) * y[0] / (y[0] - y[1]);
        }
        if y[1].abs() > least_m {
            let now_peak = y[1] > 0.0;
            if is_peak.is_some_and(|is_peak| is_peak != now_peak) {
                found.push(last);
            }
            is_peak = Some(now_peak);
        }
    }
    found
}

/// Mean distance of successive crossings in the same direction, m.
fn spacing_m(crossings: &[f64]) -> Option<f64> {
    let elements = crossings.windows(3).map(|element| element[2] - element[0]);
    let count = elements.len();
    (count > 0).then(|| elements.sum::<f64>() / count as f64)
}

/// The narrowest peak or valley, if it is narrower than `least_m`: index of the crossing at its start.
fn narrowest(crossings: &[f64], least_m: f64) -> Option<usize> {
    let widths = crossings.windows(2).map(|portion| portion[1] - portion[0]);
    let (index, width_m) = widths.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    (width_m < least_m).then_some(index)
}
