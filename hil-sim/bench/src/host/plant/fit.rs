//! Straight lines through points.

/// A line by least squares.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Value at zero.
    pub start: f64,
    /// Slope.
    pub slope: f64,
    /// Largest deviation of a point from the line, relative to the line.
    pub worst_off: f64,
}

/// Fits at least two points that differ in the first coordinate.
pub fn line(points: &[(f64, f64)]) -> Line {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let along: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let across: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let slope = along / across;
    let start = y - slope * x;
    let off = points.iter().map(|p| (p.1 / (start + slope * p.0) - 1.0).abs());
    Line { start, slope, worst_off: off.fold(0.0, f64::max) }
}

/// Exponent of the power law through positive points.
pub fn power(points: &[(f64, f64)]) -> f64 {
    let logarithms: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    line(&logarithms).slope
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_powers_are_recovered() {
        let found = line(&[(1.0, 5.0), (2.0, 7.0), (4.0, 11.0)]);
        assert!((found.start - 3.0).abs() < 1e-12 && (found.slope - 2.0).abs() < 1e-12);
        assert!(found.worst_off < 1e-12);
        // Least squares through 0, 0 and 3 at 0, 1 and 2: -0.5 + 1.5 x.
        let bent = line(&[(0.0, 0.0), (1.0, 0.0), (2.0, 3.0)]);
        assert!((bent.start + 0.5).abs() < 1e-12 && (bent.slope - 1.5).abs() < 1e-12);
        assert!((bent.worst_off - 1.0).abs() < 1e-12);
        let cube: Vec<_> = [1.0f64, 2.0, 5.0].iter().map(|x| (*x, 7.0 * x.powi(3))).collect();
        assert!((power(&cube) - 3.0).abs() < 1e-12);
    }
}
