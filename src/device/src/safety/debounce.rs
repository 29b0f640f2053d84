//! A debounce counter.

/// Counter that rises by one in each evaluated tick in which a condition holds, and falls by one in each other one. It
/// stays between zero and the limit given to [`Self::count`]. Unlike a counter that restarts at zero, it also
/// reaches the limit if the condition comes and goes but holds in more than half of the ticks. At the limit, one tick
/// without the condition ends the detection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UpDownDebounceCounter(i32);

impl UpDownDebounceCounter {
    /// Counts one evaluation: up by one, to `limit` at most, if `condition` holds; else down by one, to zero at
    /// least. Returns whether the count is now `limit`.
    pub fn count(&mut self, condition: bool, limit: u8) -> bool {
        let limit = i32::from(limit);
        self.0 = if condition { (self.0 + 1).min(limit) } else { (self.0 - 1).max(0) };
        self.0 == limit
    }
}
