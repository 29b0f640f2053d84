//! A debounce counter.

/// Counts up by one in each tick in which a condition holds, and down by one, to zero at least, in each tick in which
/// it does not. A condition that holds in more than half of the ticks thus reaches the limit given to
/// [`Self::count_tick`] in time, even if it comes and goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DebounceCounter(i32);

impl DebounceCounter {
    /// Counts one tick of 1 ms: up by one if `condition` holds, else down by one. Returns whether the count has reached
    /// `ticks`, at which the count is limited.
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
