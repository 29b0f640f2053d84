//! Root of a rising function.

/// Where `rising` passes `target` between `low` and `high`, to the last bit; the nearer end if it does not.
pub(super) fn bisect(rising: impl Fn(f64) -> f64, target: f64, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            return high;
        }
        if rising(middle) < target {
            low = middle;
        } else {
            high = middle;
        }
    }
}
