//! What heat does to skin.
//!
//! Cumulative equivalent minutes at 43 °C (Sapareto and Dewey 1984): each minute at `T` counts as `R^(43 - T)` minutes,
//! with `R` 0.5 above 43 °C and 0.25 below it; below 39 °C none. The display's surface is taken for the skin, which is
//! never warmer than it, and whether a finger touches is left out: the force sensor may be what failed.

use contact_model::fixed_point::{Celsius, exp2};

use super::Fault;

/// Ticks that one look stands for.
const TICKS: u16 = 256;
/// Below this nothing counts, and what has been is forgotten.
const COUNTS_FROM: Celsius = Celsius::lit("39");
const REFERENCE: Celsius = Celsius::lit("43");
/// Half a minute at 43 °C, in ticks there. Burns of skin take hundreds of minutes, pain some.
const MOST_TICKS: u32 = 30_000;
/// Twice that is the most that counts: whatever becomes of the sum, it is forgotten in an hour.
const COUNTED: u32 = (2 * MOST_TICKS) << 8;
/// What is forgotten below 39 °C: about a minute of dose in an hour.
const FORGOTTEN_SHIFT: u32 = 6;

/// The dose so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dose {
    /// In 2^-8 ticks at 43 °C.
    sum: u32,
    ticks: u16,
}

impl Dose {
    /// To be kept: the sum.
    #[must_use]
    pub const fn to_word(&self) -> u32 {
        self.sum
    }

    /// From what was kept.
    #[must_use]
    pub const fn from_word(sum: u32) -> Self {
        Self { sum, ticks: 0 }
    }

    /// Takes one tick; `warmest` is what the warmer of the display's thermistors reads, if any does.
    ///
    /// # Errors
    /// The skin may have had half a minute's worth.
    pub fn check(&mut self, warmest: impl FnOnce() -> Option<Celsius>) -> Result<(), Fault> {
        self.ticks += 1;
        if self.ticks >= TICKS {
            self.ticks = 0;
            self.sum = match warmest() {
                None => self.sum,
                Some(warmest) if warmest < COUNTS_FROM => self
                    .sum
                    .saturating_sub(u32::from(TICKS) << 8 >> FORGOTTEN_SHIFT),
                Some(warmest) => self
                    .sum
                    .saturating_add(rate(warmest).saturating_mul(TICKS.into())),
            }
            .min(COUNTED);
        }
        if self.sum >> 8 >= MOST_TICKS {
            Err(Fault::Dose)
        } else {
            Ok(())
        }
    }
}

/// Minutes at 43 °C that a minute is worth, 2^-8; 256 at most.
fn rate(t: Celsius) -> u32 {
    let above = t.saturating_sub(REFERENCE);
    // The exponent of two, 32 binary places.
    let exponent = i64::from(above.to_bits()) << (33 - Celsius::FRAC_NBITS - u32::from(above > 0));
    let whole = (exponent >> 32).clamp(-8, 8);
    let mantissa = (1u64 << 32) + u64::from(exp2(exponent as u32));
    (mantissa >> (24 - whole)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_those_of_the_definition() {
        for (t_c, worth) in [
            (43.0, 1.0),
            (44.0, 2.0),
            (45.5, 5.656_85),
            (42.0, 0.25),
            (41.5, 0.125),
            (40.0, 0.015_625),
        ] {
            let rate = f64::from(rate(Celsius::from_num(t_c))) / 256.0;
            assert!((rate - worth).abs() < 1.0 / 256.0, "{t_c} C: {rate}");
        }
    }

    /// Half a minute at 43 °C, two at 42, eight at 41; none below 39.
    #[test]
    fn dose_trips_when_the_definition_says_half_a_minute() {
        for (t_c, seconds) in [(43.0, 30.0), (42.0, 120.0), (41.0, 480.0)] {
            let mut dose = Dose::default();
            let display = Celsius::from_num(t_c);
            let ticks = (1..)
                .find(|_| dose.check(|| Some(display)).is_err())
                .expect("a tick");
            assert!(
                (f64::from(ticks) - 1e3 * seconds).abs() < 300.0,
                "{t_c}: {ticks}"
            );
        }
        let mut dose = Dose::default();
        let cool = Celsius::lit("38.9");
        assert!((0..1_000_000).all(|_| dose.check(|| Some(cool)).is_ok()));
    }

    /// As would a bit of the sum that flips.
    #[test]
    fn an_hour_forgets_ten_minutes_of_60_c() {
        let mut dose = Dose::default();
        let hot = Celsius::lit("60");
        assert!(
            (0..600_000)
                .filter(|_| dose.check(|| Some(hot)).is_err())
                .count()
                > 0
        );
        for mut dose in [dose, Dose::from_word(u32::MAX)] {
            let cool = Celsius::lit("38.9");
            let forgotten = (0..3_600_000).position(|_| dose.check(|| Some(cool)).is_ok());
            assert!(forgotten.is_some());
        }
    }
}
