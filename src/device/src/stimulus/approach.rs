//! How the display comes to a constant temperature without passing it.

use contact_model::fixed_point::Celsius;

/// Divisor, as a power of two, of the distance that the target is ahead of a display on its way: 2^5 = 32. The display then
/// approaches the end with a time constant of 32 times the law's 12 ms, so that the observer has time to unlearn the error
/// of the plate model at the current limit, which else carries the display beyond its set-point.
const APPROACH_SHIFT: u32 = 5;
/// Distance, K, of the display's surface from the end at which it has arrived.
const ARRIVED_WITHIN: Celsius = Celsius::lit("0.02");

/// Whether the display has been at a temperature that it is held at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Approach {
    /// It is on its way there.
    Underway,
    /// It has been there. From then on it is held with the whole gain of the control law; with the small one of the
    /// approach, a tile that differs from its model would oscillate.
    Over,
}

impl Approach {
    /// Target of the control law, °C, for a display whose surface, °C, is to be at `end`, °C.
    pub fn target(&mut self, surface: Celsius, end: Celsius) -> Celsius {
        let distance = end.saturating_sub(surface);
        if distance.abs() <= ARRIVED_WITHIN {
            *self = Self::Over;
        }
        match self {
            Self::Underway => surface.saturating_add(distance >> APPROACH_SHIFT),
            Self::Over => end,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gain_is_small_until_the_display_has_been_at_the_end() {
        let mut approach = Approach::Underway;
        let end = Celsius::lit("30");
        let mut target_at = |surface: &str| approach.target(surface.parse().expect("°C"), end);
        assert_eq!(target_at("26"), Celsius::lit("26.125"));
        assert_eq!(target_at("34"), Celsius::lit("33.875"));
        assert_eq!(target_at("29.99"), end);
        assert_eq!(target_at("26"), end);
    }
}
