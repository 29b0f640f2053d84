//! Outputs of a control tick: current, duty cycle and state of the bridge.

use fixed::types::{I1F15, I8F24};

/// Current through the module in A, ±128 at a resolution of 60 nA; positive cools the display.
pub type Current = I8F24;

/// A current within the limit of every module; nothing else can be constructed. Positive cools the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SafeCurrent(Current);

impl SafeCurrent {
    /// Largest magnitude, A: that of the smallest module of the class.
    pub const LIMIT: Current = Current::lit("6");
    /// A current of 0 A.
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

/// Mean voltage of the bridge as a fraction of its supply, -0.9 to 0.9; positive cools the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duty(I1F15);

impl Duty {
    /// Largest magnitude: 10.8 V of 12 V, more than 6 A need through a cold module.
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

    /// On-times of the half-bridges that cool and warm, in steps of a PWM period of `period` steps.
    ///
    /// Slow decay: one half-bridge stays high and the other is low for the duty's part of the period, so that the
    /// current circulates between the pulses and the mean voltage is the fraction of the supply, rounded to the
    /// nearest step. With fast decay (both low between the pulses) the voltage would also depend on the current.
    #[must_use]
    pub fn half_bridge_on_times(self, period: u16) -> (u16, u16) {
        // The fraction has 15 binary places; half a step is added to round.
        let fraction = self.0.to_bits();
        let low = (u32::from(period) * u32::from(fraction.unsigned_abs()) + (1 << 14)) >> 15;
        // No overflow, because the fraction is below one.
        let high = period.saturating_sub(low as u16);
        if fraction >= 0 {
            (period, high)
        } else {
            (high, period)
        }
    }
}

/// Command to the bridge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Both half-bridges high-impedance.
    Off,
    /// Drive with this duty.
    On(Duty),
}

/// Outputs of one control tick to the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// The bridge.
    pub drive: Drive,
    /// Level of the comparator's test line: high makes the comparator cut the supply, and the falling edge restores it.
    pub comparator_test: bool,
}
