//! What the bridge is told.

use fixed::types::{I1F15, I8F24};

/// Current through the module in A, ±128; positive cools the display.
pub type Current = I8F24;

/// A current that a module may be driven with; positive cools the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SafeCurrent(Current);

impl SafeCurrent {
    /// Largest magnitude, A: that of the smallest module of the class.
    pub const LIMIT: Current = Current::lit("6");
    /// None.
    pub const ZERO: Self = Self(Current::ZERO);

    /// Clamps to plus or minus [`Self::LIMIT`].
    #[must_use]
    pub fn saturating(current: Current) -> Self {
        Self(current.clamp(-Self::LIMIT, Self::LIMIT))
    }

    /// The current, within plus or minus [`Self::LIMIT`].
    #[must_use]
    pub const fn ampere(self) -> Current {
        self.0
    }
}

/// Signed fraction of the bridge supply; positive cools the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duty(I1F15);

impl Duty {
    /// Largest magnitude: 10.8 V of 12 V, more than 6 A through a cold module ever need.
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

    /// Time at the supply of the legs that cool and warm, in steps of a PWM period of `full` steps.
    ///
    /// Slow decay: one leg stays high while the other takes away its share of the period, so the current
    /// circulates between the pulses and the mean voltage is the fraction of the supply, rounded to the
    /// nearest step. With fast decay (the other leg low) it would also depend on the current.
    #[must_use]
    pub fn legs(self, full: u16) -> (u16, u16) {
        let fraction = self.0.to_bits();
        let taken = (u32::from(full) * u32::from(fraction.unsigned_abs()) + (1 << 14)) >> 15;
        // `taken` is at most `full`, because the fraction is below one.
        let rest = full.saturating_sub(taken as u16);
        if fraction >= 0 {
            (full, rest)
        } else {
            (rest, full)
        }
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

/// What one tick tells the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// The bridge.
    pub drive: Drive,
    /// Level of the line that lets the comparator cut the supply, and with its falling edge give it back.
    pub comparator_test: bool,
}
