//! Something that counts when it has lasted.

/// For how many more ticks something has been so than not: what comes and goes still counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lasting(u8);

impl Lasting {
    /// Takes one tick; whether it has been so for `ticks` more than not.
    pub const fn has(&mut self, so: bool, ticks: u8) -> bool {
        self.0 = if so {
            self.0.saturating_add(1)
        } else {
            self.0.saturating_sub(1)
        };
        if self.0 > ticks {
            self.0 = ticks;
        }
        self.0 >= ticks
    }
}
