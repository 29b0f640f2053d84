//! Display temperatures that may be commanded.

use contact_model::fixed_point::Celsius;

use super::limits::{SETPOINT_MAX, SETPOINT_MIN};

/// A set-point within [`SETPOINT_MIN`] to [`SETPOINT_MAX`]; no other can be constructed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Setpoint(Celsius);

impl Setpoint {
    /// Coldest set-point that can be commanded.
    pub const MIN: Self = Self(SETPOINT_MIN);
    /// Hottest set-point that can be commanded.
    pub const MAX: Self = Self(SETPOINT_MAX);

    /// The nearest allowed set-point, and whether the demanded one had to be limited.
    #[must_use]
    pub fn limited(demanded: Celsius) -> (Self, bool) {
        let allowed = demanded.clamp(Self::MIN.0, Self::MAX.0);
        (Self(allowed), allowed != demanded)
    }

    /// The set-point in °C, within the safe range by construction.
    #[must_use]
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
            let (setpoint, was_limited) = Setpoint::limited(Celsius::from_num(demanded));
            assert_eq!(
                (setpoint.celsius().to_num::<f64>(), was_limited),
                (allowed, limited)
            );
        }
        assert_eq!(Setpoint::limited(Celsius::MAX).0, Setpoint::MAX);
        assert_eq!(Setpoint::limited(Celsius::MIN).0, Setpoint::MIN);
    }
}
