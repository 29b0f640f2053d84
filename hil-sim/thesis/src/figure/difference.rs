//! Differences of figures computed by two solvers.

use serde::Serialize;

use super::Figure;

/// Time after the start of contact from which the steps resolve it, s.
const SETTLED_S: f64 = 0.02;
/// Figures that are always computed by Eq. 3-1 and 3-3.
const PERFECT: &str = "3-2";

/// Differences between the curves of a figure from two solvers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureDifference {
    /// Number in the thesis.
    pub number: &'static str,
    /// Quantity and unit of y.
    pub y: &'static str,
    /// Largest difference of any point of any curve.
    pub largest: f64,
    /// Largest difference from x = 0.02 on (20 ms where x is time).
    pub settled: f64,
    /// Largest magnitude of y in the figure.
    pub range: f64,
}

impl FigureDifference {
    /// The differences as a sentence.
    pub fn text(&self) -> String {
        format!(
            "Figure {:<6} {}: off by at most {:.1e}, {:.1e} from 20 ms on, of values up to {:.1}",
            self.number, self.y, self.largest, self.settled, self.range
        )
    }
}

/// Compares figures that were drawn alike; those that no source draws are left out.
pub fn differences(figures: &[Figure], others: &[Figure]) -> Vec<FigureDifference> {
    let points = |figure: &Figure| -> Vec<(f64, f64)> {
        let points = figure.curves.iter().flat_map(|curve| &curve.points);
        points.copied().collect()
    };
    let pairs = figures.iter().zip(others);
    pairs
        .filter(|(figure, _)| !figure.number.starts_with(PERFECT))
        .map(|(figure, other)| {
            let (these, those) = (points(figure), points(other));
            let most = |values: &mut dyn Iterator<Item = f64>| {
                values.fold(0.0f64, |most, v| most.max(v.abs()))
            };
            let off = || these.iter().zip(&those).map(|((x, a), (_, b))| (*x, a - b));
            FigureDifference {
                number: figure.number,
                y: figure.y,
                largest: most(&mut off().map(|(_, off)| off)),
                settled: most(&mut off().filter(|(x, _)| *x >= SETTLED_S).map(|(_, off)| off)),
                range: most(&mut these.iter().map(|(_, y)| *y)),
            }
        })
        .collect()
}
