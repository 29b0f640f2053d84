//! Outputs of a control tick to the board: current, duty cycle and state of the bridge, and the comparator's test.

use fixed::types::{I1F15, I8F24};

/// Current through the Peltier module, A, -128 to 128 in steps of 60 nA; positive cools the display.
pub type Current = I8F24;

/// A current that every Peltier module of the supported class tolerates, -6 to 6 A; positive cools the display. The
/// type can hold no other value, and the bridge voltage can be computed from no other type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SafeCurrent(Current);

impl SafeCurrent {
    /// Largest magnitude of a [`SafeCurrent`], A: the limit of the smallest Peltier module of the supported class.
    pub const CURRENT_LIMIT: Current = Current::lit("6");
    /// No current, 0 A.
    pub const ZERO: Self = Self(Current::ZERO);

    /// The current, A, clamped to -6 to 6 A; positive cools the display.
    pub fn saturating(current: Current) -> Self {
        Self(current.clamp(-Self::CURRENT_LIMIT, Self::CURRENT_LIMIT))
    }

    /// The current as a plain number of A, -6 to 6; positive cools the display.
    pub const fn ampere(self) -> Current {
        self.0
    }
}

/// Duty cycle of the bridge: its mean output voltage as a fraction of the supply voltage, -0.9 to 0.9; positive cools
/// the display. The type can hold no other value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duty(I1F15);

impl Duty {
    /// Largest magnitude of a duty cycle, as a fraction of the supply voltage. On a supply of 12 V, 0.9 is 10.8 V,
    /// which is more than resistance, Seebeck voltage and dead times together need at the largest current of 6 A.
    pub const DUTY_LIMIT: I1F15 = I1F15::lit("0.9");
    /// No mean voltage: both half-bridges stay low, so that current can circulate, unlike with [`Drive::Off`].
    pub const ZERO: Self = Self(I1F15::ZERO);

    /// Duty cycle of this `fraction` of the supply voltage, clamped to -0.9 to 0.9; positive cools the display.
    pub fn saturating(fraction: I1F15) -> Self {
        Self(fraction.clamp(-Self::DUTY_LIMIT, Self::DUTY_LIMIT))
    }

    /// Mean output voltage as a fraction of the supply voltage, -0.9 to 0.9; positive cools the display.
    pub const fn fraction(self) -> I1F15 {
        self.0
    }

    /// High times of the bridge's two logic inputs, IN1 and IN2, in each PWM period, in steps of the PWM timer;
    /// `period` is the length of the PWM period in these steps. IN1 stays high while cooling, IN2 while warming.
    ///
    /// Slow decay: while one input stays high, the other one is low for the duty cycle's fraction of the period, rounded
    /// to the nearest step, and in that time one half-bridge is high and the other one low. While both inputs are high,
    /// both half-bridges are low and the current circulates, so that the mean voltage is this fraction of the supply
    /// voltage. With fast decay (both high-impedance between the pulses) the mean voltage would also depend on the
    /// current.
    pub fn input_high_times(self, period: u16) -> (u16, u16) {
        // The fraction has 15 binary places; half a step is added to round.
        let fraction = self.0.to_bits();
        let low = (u32::from(period) * u32::from(fraction.unsigned_abs()) + (1 << 14)) >> 15;
        // No overflow, because the fraction is below one.
        let high = period.saturating_sub(low as u16);
        if fraction >= 0 { (period, high) } else { (high, period) }
    }
}

/// What the bridge of one finger must do until the next control tick: be off, or apply a duty cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Both half-bridges are high-impedance, so no current flows, whatever voltage the Peltier module generates.
    Off,
    /// The bridge applies this duty cycle to the Peltier module.
    On(Duty),
}

/// Test of the comparator that cuts the bridge's supply: what its input is connected to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ComparatorTest {
    /// No test: the input is the display's second thermistor. The change from a test to none clears the comparator's
    /// latch if that thermistor is between 10 and 45 °C.
    #[default]
    None,
    /// A level above the window, as of 48 °C: the comparator must cut the supply.
    Hot,
    /// A level below the window, as of 5 °C: the comparator must cut the supply.
    Cold,
}

/// What a control tick of one finger demands of the board until the next tick, 1 ms later: of the bridge, and of the
/// comparator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardOutputs {
    /// Whether the finger's bridge is off (high-impedance) or driven, and with which duty cycle.
    pub drive: Drive,
    /// Test of the comparator. All fingers share the line that selects the side, hot or cold; never do two fingers
    /// demand different sides at the same time.
    pub comparator_test: ComparatorTest,
    /// Whether the trigger output is high. The output of several fingers is high if that of any of them is.
    pub trigger_output: bool,
}
