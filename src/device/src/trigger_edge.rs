//! A rising edge at the trigger input.

/// When a rising edge at the trigger input was, as a timer of the board has recorded it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriggerEdge {
    /// Time since the start of the first of the 16 scans of its millisecond, µs, 0 to 999.
    pub us: u16,
    /// Number of ticks since that of its millisecond: 0, or 1 if it came shortly before that tick or after it.
    pub ticks_ago: u8,
}
