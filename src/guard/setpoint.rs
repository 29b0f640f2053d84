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
