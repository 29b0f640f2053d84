//! A debounce counter.

/// Counts the ticks in which a condition has held, less those in which it has not, so that an intermittent condition counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DebounceCounter(i32);

impl DebounceCounter {
    /// Takes the condition of one tick; returns whether it has held for `ticks` more ticks than not.
    pub fn update(&mut self, condition: bool, ticks: u8) -> bool {
        let ticks = i32::from(ticks);
        self.0 = if condition {
            (self.0 + 1).min(ticks)
        } else {
            (self.0 - 1).max(0)
        };
        self.0 == ticks
    }
}
