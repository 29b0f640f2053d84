//! A temperature that the display may be told to take.

use contact_model::fixed_point::Celsius;

/// A set-point within 15 to 42 °C; nothing else can be constructed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Setpoint(Celsius);

impl Setpoint {
    /// Coldest set-point: contact colder than this is painful in the long run.
    pub const MIN: Self = Self(Celsius::lit("15"));
    /// Hottest set-point.
    pub const MAX: Self = Self(Celsius::lit("42"));

    /// The nearest allowed set-point, and whether that is another one than was asked for.
    #[must_use]
    pub fn limited(wanted: Celsius) -> (Self, bool) {
        let allowed = wanted.clamp(Self::MIN.0, Self::MAX.0);
        (Self(allowed), allowed != wanted)
    }

    /// The temperature.
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
        for (wanted, allowed, limited) in
            [(14.9, 15.0, true), (15.0, 15.0, false), (42.5, 42.0, true)]
        {
            let (setpoint, was_limited) = Setpoint::limited(Celsius::from_num(wanted));
            assert_eq!(
                (setpoint.celsius().to_num::<f64>(), was_limited),
                (allowed, limited)
            );
        }
        assert_eq!(Setpoint::limited(Celsius::MAX).0, Setpoint::MAX);
        assert_eq!(Setpoint::limited(Celsius::MIN).0, Setpoint::MIN);
    }
}
