//! Search in one dimension.

/// Argument between `low` and `high` at which an increasing function reaches `target`, to the last bit; an end if it does not.
pub fn bisect(function: impl Fn(f64) -> f64, target: f64, mut low: f64, mut high: f64) -> f64 {
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

/// Argument between `low` and `high` at which a function with one minimum is smallest, by golden section. The interval that
/// contains it shrinks to 1e-9 of `high - low`; below about 1e-8 of the argument rounding of the function decides.
pub fn golden_section(function: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    /// 0.618^44 < 1e-9.
    const STEPS: u32 = 44;
    let golden = (5f64.sqrt() - 1.0) / 2.0;
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (function(left), function(right));
    for _ in 0..STEPS {
        if at_left <= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = function(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = function(right);
        }
    }
    low + (high - low) / 2.0
}
