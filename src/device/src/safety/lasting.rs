//! Something that counts when it has lasted.

/// For how many more ticks something has been so than not: what comes and goes still counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lasting(i32);

impl Lasting {
    /// Takes one tick; whether it has been so for `ticks` more than not.
    pub fn has(&mut self, so: bool, ticks: u8) -> bool {
        let ticks = i32::from(ticks);
        self.0 = if so {
            (self.0 + 1).min(ticks)
        } else {
            (self.0 - 1).max(0)
        };
        self.0 == ticks
    }
}
