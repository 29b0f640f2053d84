//! A straight line between two temperatures, in integers.

use contact_model::fixed_point::Celsius;

/// Makes a two's complement number an unsigned one that is larger by 2^31.
const OFFSET: u32 = 1 << 31;

/// The temperature, °C, after `passed` of `whole` ticks on the way from one temperature, °C, to another, rounded down to a
/// step of 2^-22 K; at the end from `whole` ticks on. Computed anew for each tick, so that a place on the line costs the same
/// wherever it is, and no error accumulates.
#[inline(never)]
pub fn temperature_on_line(from: Celsius, to: Celsius, passed: u32, whole: u32) -> Celsius {
    if passed >= whole {
        return to;
    }
    let unsigned = |celsius: Celsius| u64::from(celsius.to_bits().cast_unsigned() ^ OFFSET);
    // Both products together are below 2^32 times `whole`, so they fit; the quotient is rounded down.
    let sum = unsigned(from) * u64::from(whole - passed) + unsigned(to) * u64::from(passed);
    let bits = (sum / u64::from(whole)) as u32;
    Celsius::from_bits((bits ^ OFFSET).cast_signed())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against the exact rational interpolation in 128 bits.
        #[test]
        fn each_place_is_the_exact_interpolation_rounded_down(
            from: i32, to: i32, whole in 1u32.., part in 0.0..=1.0,
        ) {
            let passed = (part * f64::from(whole)) as u32;
            let way = i128::from(to) - i128::from(from);
            let exact = i128::from(from) + (way * i128::from(passed)).div_euclid(whole.into());
            let (from, to) = (Celsius::from_bits(from), Celsius::from_bits(to));
            let at = |passed| i128::from(temperature_on_line(from, to, passed, whole).to_bits());
            prop_assert_eq!(at(passed), exact);
            prop_assert_eq!(at(0), i128::from(from.to_bits()));
            prop_assert_eq!(at(whole), i128::from(to.to_bits()));
            prop_assert_eq!(at(whole.saturating_add(1)), i128::from(to.to_bits()));
        }
    }

    #[test]
    fn a_line_without_ticks_is_at_its_end() {
        let end = Celsius::lit("31");
        assert_eq!(temperature_on_line(Celsius::ZERO, end, 0, 0), end);
    }
}
