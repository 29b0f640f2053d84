//! Something that counts when it has lasted.

/// For how many ticks something has been so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lasting(u8);

impl Lasting {
    /// Takes one tick; whether it has been so for `ticks`.
    pub const fn has(&mut self, so: bool, ticks: u8) -> bool {
        self.0 = if so { self.0.saturating_add(1) } else { 0 };
        self.0 >= ticks
    }
}
