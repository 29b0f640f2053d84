//! A debounce counter.

/// Counts up by one in each tick in which a condition holds, and down by one, to zero at least, in each in which it
/// does not. So a condition that comes and goes is detected too, if it holds in more than half of the ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DebounceCounter(i32);

impl DebounceCounter {
    /// Counts one tick of 1 ms, up if `condition` holds in it and down if not. Returns whether the count has reached
    /// `ticks`, where it stops.
    pub fn count_tick(&mut self, condition: bool, ticks: u8) -> bool {
        let ticks = i32::from(ticks);
        self.0 = if condition {
            (self.0 + 1).min(ticks)
        } else {
            (self.0 - 1).max(0)
        };
        self.0 == ticks
    }
}
