//! Bisection.

/// Argument between `low` and `high` at which an increasing function reaches `target`, to the last bit; an end if it does not.
pub(super) fn bisect(
    function: impl Fn(f64) -> f64,
    target: f64,
    mut low: f64,
    mut high: f64,
) -> f64 {
    loop {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            return high;
        }
        if function(middle) < target {
            low = middle;
        } else {
            high = middle;
        }
    }
}
