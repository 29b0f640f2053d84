//! A straight line from one temperature to another, in integers.

use contact_model::fixed_point::Celsius;

/// A temperature that moves linearly from a start to an end, tick by tick. The temperature after `k` of `n` ticks is
/// `start + floor((end - start) k / n)` in steps of 2^-22 K: no error accumulates, and it ends exactly on its end. One
/// division at the start; each tick adds quotient and remainder (Bresenham's line algorithm).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ramp {
    value: i32,
    /// Whole steps of each tick, rounded down.
    step: i32,
    /// What the rounding has left of each tick, in parts of a step divided by `ticks`.
    remainder: u32,
    /// Sum of the remainders that do not make a step yet; below `ticks`.
    sum: u32,
    ticks: u32,
    ticks_left: u32,
}

impl Ramp {
    /// A ramp that stays at a temperature.
    #[must_use]
    pub const fn constant(celsius: Celsius) -> Self {
        Self {
            value: celsius.to_bits(),
            step: 0,
            remainder: 0,
            sum: 0,
            ticks: 1,
            ticks_left: 0,
        }
    }

    /// A ramp from `start` to `end`, °C, in this number of ticks of 1 ms, at most 2^24; at `end` from the start if that is
    /// zero.
    #[must_use]
    #[inline(never)]
    pub const fn new(start: Celsius, end: Celsius, ticks: u32) -> Self {
        if ticks == 0 {
            return Self::constant(end);
        }
        let way = end.to_bits().saturating_sub(start.to_bits());
        // Unsigned, because a signed division may overflow, which the compiler would answer with a panic.
        let (quotient, rest) = (way.unsigned_abs() / ticks, way.unsigned_abs() % ticks);
        let (step, remainder) = match (way < 0, rest) {
            (false, _) => (quotient as i32, rest),
            (true, 0) => ((quotient as i32).wrapping_neg(), 0),
            // Rounded down, away from zero.
            (true, _) => (!(quotient as i32), ticks - rest),
        };
        Self {
            value: start.to_bits(),
            step,
            remainder,
            sum: 0,
            ticks,
            ticks_left: ticks,
        }
    }

    /// The present temperature, °C.
    #[must_use]
    pub const fn celsius(&self) -> Celsius {
        Celsius::from_bits(self.value)
    }

    /// Ticks until the end.
    #[must_use]
    pub const fn ticks_left(&self) -> u32 {
        self.ticks_left
    }

    /// Moves on by one tick; at its end the ramp stays.
    #[inline(never)]
    pub const fn advance(&mut self) {
        if self.ticks_left == 0 {
            return;
        }
        self.ticks_left -= 1;
        self.value = self.value.wrapping_add(self.step);
        self.sum += self.remainder;
        if self.sum >= self.ticks {
            self.sum -= self.ticks;
            self.value = self.value.wrapping_add(1);
        }
    }

    /// Moves on by `ticks`, or to the end if that is nearer, and returns by how many.
    pub fn skip(&mut self, ticks: u32) -> u32 {
        let ticks = ticks.min(self.ticks_left);
        for _ in 0..ticks {
            self.advance();
        }
        ticks
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against the exact rational interpolation in 128 bits.
        #[test]
        fn each_tick_is_the_exact_interpolation_rounded_down(
            start in -40i32 << 22..60 << 22, end in -40i32 << 22..60 << 22, ticks in 1u32..3000,
        ) {
            let mut ramp = Ramp::new(Celsius::from_bits(start), Celsius::from_bits(end), ticks);
            for tick in 0..=ticks {
                let way = i128::from(end) - i128::from(start);
                let exact = i128::from(start) + (way * i128::from(tick)).div_euclid(ticks.into());
                prop_assert_eq!(i128::from(ramp.celsius().to_bits()), exact);
                prop_assert_eq!(ramp.ticks_left(), ticks - tick);
                ramp.advance();
            }
            prop_assert_eq!(ramp.celsius().to_bits(), end);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4))]
        #[test]
        fn the_slowest_ramps_end_on_their_ends(end in -27i32 << 22..27 << 22, ticks in 3_500_000u32..3_600_000) {
            let mut ramp = Ramp::new(Celsius::ZERO, Celsius::from_bits(end), ticks);
            prop_assert_eq!(ramp.skip(u32::MAX), ticks);
            prop_assert_eq!(ramp.celsius().to_bits(), end);
        }
    }
}
