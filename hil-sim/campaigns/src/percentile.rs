//! Percentiles.

/// A percentile (0 to 100) of values in any order, by linear interpolation between the two nearest of them; `None`
/// without values.
pub fn percentile(values: &[f64], percent: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    let position = percent.clamp(0.0, 100.0) / 100.0 * last as f64;
    let below = position as usize;
    let (low, high) = (*sorted.get(below)?, *sorted.get((below + 1).min(last))?);
    Some(low + (high - low) * (position - below as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Calculated by hand: position = p/100 (n - 1).
    #[test]
    fn percentiles_are_those_of_known_samples() {
        let ten: Vec<f64> = [7.0, 1.0, 10.0, 4.0, 2.0, 8.0, 3.0, 9.0, 5.0, 6.0].into();
        for (percent, expected) in
            [(0.0, 1.0), (50.0, 5.5), (95.0, 9.55), (99.0, 9.91), (100.0, 10.0)]
        {
            let value = percentile(&ten, percent).expect("values");
            assert!((value - expected).abs() < 1e-12, "{percent}: {value}");
        }
        assert_eq!(percentile(&[3.0], 95.0), Some(3.0));
        assert_eq!(percentile(&[], 95.0), None);
    }
}
