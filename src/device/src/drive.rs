//! BoardOutputs of a control tick: current, duty cycle and state of the bridge.

use fixed::types::{I1F15, I8F24};

/// Current through the module in A, ±128 at a resolution of 60 nA; positive cools the display.
pub type Current = I8F24;

/// A module current that every module of the class tolerates, -6 to 6 A; positive cools the display. The type can hold
/// no other, and the bridge's voltage can be computed from no other type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SafeCurrent(Current);

impl SafeCurrent {
    /// Largest magnitude of a [`SafeCurrent`], A: what the smallest module of the class tolerates.
    pub const CURRENT_LIMIT: Current = Current::lit("6");
    /// No current, 0 A.
    pub const ZERO: Self = Self(Current::ZERO);

    /// Clamps `current`, A, to -6 to 6 A.
    #[must_use]
    pub fn saturating(current: Current) -> Self {
        Self(current.clamp(-Self::CURRENT_LIMIT, Self::CURRENT_LIMIT))
    }

    /// The current as a plain number of A, -6 to 6; positive cools the display.
    #[must_use]
    pub const fn ampere(self) -> Current {
        self.0
    }
}

/// Duty cycle of the bridge: its mean output voltage as a fraction of the supply voltage, -0.9 to 0.9; positive cools
/// the display. The type can hold no other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duty(I1F15);

impl Duty {
    /// Largest magnitude of a duty cycle, 0.9. On a supply of 12 V these are 10.8 V, which is more than the resistance, the
    /// Seebeck voltage and the dead times together need at the largest current of 6 A.
    pub const DUTY_LIMIT: I1F15 = I1F15::lit("0.9");
    /// No voltage: both half-bridges are driven to the same level, which lets current circulate, unlike [`Drive::Off`].
    pub const ZERO: Self = Self(I1F15::ZERO);

    /// Clamps `fraction` of the supply voltage to -0.9 to 0.9.
    #[must_use]
    pub fn saturating(fraction: I1F15) -> Self {
        Self(fraction.clamp(-Self::DUTY_LIMIT, Self::DUTY_LIMIT))
    }

    /// Mean output voltage as a fraction of the supply voltage, -0.9 to 0.9; positive cools the display.
    #[must_use]
    pub const fn fraction(self) -> I1F15 {
        self.0
    }

    /// High times of the bridge's two half-bridges in each PWM period, in steps of the PWM timer, of which a period has
    /// `period`: first that of the half-bridge that is high while cooling, second that of the one that is high while
    /// warming.
    ///
    /// Slow decay: one half-bridge stays high and the other is low for the duty's part of the period, so that the
    /// current circulates between the pulses and the mean voltage is the fraction of the supply, rounded to the nearest
    /// step. With fast decay (both low between the pulses) the voltage would also depend on the current.
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

/// What the bridge must do until the next tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Both half-bridges are high-impedance, so no current flows, whatever voltage the module generates.
    Off,
    /// The bridge applies this duty cycle to the module.
    On(Duty),
}

/// What a control tick of one finger demands of the board until the next tick, 1 ms later.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardOutputs {
    /// Whether the finger's bridge is off or drives, and with which duty cycle.
    pub drive: Drive,
    /// Level of the comparator's test line: high makes the comparator cut the supply, and the falling edge restores it.
    pub comparator_test: bool,
}
