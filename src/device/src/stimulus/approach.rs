//! How the display comes to a constant temperature without passing it.

use contact_model::fixed_point::Celsius;

/// Time constant, ticks of 1 ms, with which the target comes to the end. The observer needs this time to unlearn the error of
/// the plate model at the current limit, which else carries the display beyond the end.
const APPROACH_TICKS: i32 = 384;
/// Largest distance, K, of the target from the display's surface: what the law, which reaches its target after 12 ms, drives
/// with about the largest current.
const AHEAD_MAX: Celsius = Celsius::lit("0.5");
/// Distance, K, of the target from the end at which the approach is over.
const NEAR: Celsius = Celsius::lit("0.01");

/// A target of the control law on its way to a constant temperature. It waits for a display that cannot follow, and slows
/// down before the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Approach {
    /// The target was at this temperature, °C.
    Underway(Celsius),
    /// The target has been at the end, and stays there whatever the display does.
    Over,
}

impl Approach {
    /// To `end`, °C.
    pub const fn to(end: Celsius) -> Self {
        Self::Underway(end)
    }

    /// Moves on by one tick. Returns the target, °C, for a display whose surface, °C, is to be at `end`, °C.
    pub fn next_target(&mut self, surface: Celsius, end: Celsius) -> Celsius {
        let Self::Underway(last) = *self else {
            return end;
        };
        let moved = last.saturating_add(end.saturating_sub(last) / APPROACH_TICKS);
        // Not `clamp`, which panics if its limits are in the wrong order.
        let target =
            moved.max(surface.saturating_sub(AHEAD_MAX)).min(surface.saturating_add(AHEAD_MAX));
        *self = if target.abs_diff(end) <= NEAR { Self::Over } else { Self::Underway(target) };
        target
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_target_waits_for_the_display_and_then_slows_down_once() {
        let (end, start) = (Celsius::lit("30"), Celsius::lit("26"));
        let mut approach = Approach::to(end);
        for _ in 0..100 {
            assert_eq!(approach.next_target(start, end), start + AHEAD_MAX);
        }
        let mut surface = start;
        let mut previous = start;
        let mut slow_ticks = 0;
        while approach != Approach::Over {
            // A display that moves by at most 20 mK a tick.
            let target = approach.next_target(surface, end);
            assert!(previous <= target && target <= end, "{target}");
            slow_ticks += u32::from(target.saturating_sub(surface) < AHEAD_MAX);
            previous = target;
            surface = target.min(surface.saturating_add(Celsius::lit("0.02")));
        }
        assert!((384..3840).contains(&slow_ticks), "{slow_ticks}");
        assert_eq!(approach.next_target(start, end), end);
    }
}
