//! Root of a rising function.

/// Halvings after which an `f64` interval has no inner point.
const HALVINGS: u32 = 200;

/// Where `rising` passes `target` between `low` and `high`, to the last bit; the nearer end if it does not.
pub(super) fn bisect(rising: impl Fn(f64) -> f64, target: f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = low + (high - low) / 2.0;
        if rising(middle) < target {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
