//! What the bridge is told.

use fixed::types::{I1F15, I8F24};

/// Current through the module in A, ±128; positive cools the display.
pub type Current = I8F24;

/// Signed fraction of the bridge supply; positive cools the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duty(I1F15);

impl Duty {
    /// Largest magnitude: leaves the driver's charge pump and current mirror time to work.
    pub const LIMIT: I1F15 = I1F15::lit("0.9");
    /// No voltage; both legs are driven to the same level.
    pub const ZERO: Self = Self(I1F15::ZERO);

    /// Clamps to plus or minus [`Self::LIMIT`].
    #[must_use]
    pub fn saturating(fraction: I1F15) -> Self {
        Self(fraction.clamp(-Self::LIMIT, Self::LIMIT))
    }

    /// The fraction, within plus or minus [`Self::LIMIT`].
    #[must_use]
    pub const fn fraction(self) -> I1F15 {
        self.0
    }
}

/// Command to the bridge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Both legs high-impedance.
    Off,
    /// Drive with this mean voltage.
    On(Duty),
}
