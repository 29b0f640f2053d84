//! Display temperatures that may be commanded.

use contact_model::fixed_point::Celsius;

use super::limits::{SETPOINT_MAX, SETPOINT_MIN};

/// A display temperature that may be commanded, 15 to 42 °C. No other value can be constructed
/// ([`Setpoint::clamp_celsius_with_flag`] clamps), so the controller need not check the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Setpoint(Celsius);

impl Setpoint {
    /// Coldest set-point that can be commanded, 15 °C.
    pub const MIN: Self = Self(SETPOINT_MIN);
    /// Hottest set-point that can be commanded, 42 °C.
    pub const MAX: Self = Self(SETPOINT_MAX);

    /// A set-point from `demanded`, °C, clamped to 15 to 42 °C; the second value is true if the clamping has changed
    /// it.
    #[must_use]
    pub fn clamp_celsius_with_flag(demanded: Celsius) -> (Self, bool) {
        let allowed = demanded.clamp(Self::MIN.0, Self::MAX.0);
        (Self(allowed), allowed != demanded)
    }

    /// The set-point as a plain temperature, 15 to 42 °C.
    pub const fn celsius(self) -> Celsius {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn setpoint_cannot_leave_its_range() {
        for (demanded, allowed, limited) in
            [(14.9, 15.0, true), (15.0, 15.0, false), (42.5, 42.0, true)]
        {
            let (setpoint, was_limited) =
                Setpoint::clamp_celsius_with_flag(Celsius::from_num(demanded));
            assert_eq!((setpoint.celsius().to_num::<f64>(), was_limited), (allowed, limited));
        }
        assert_eq!(Setpoint::clamp_celsius_with_flag(Celsius::MAX).0, Setpoint::MAX);
        assert_eq!(Setpoint::clamp_celsius_with_flag(Celsius::MIN).0, Setpoint::MIN);
    }
}
